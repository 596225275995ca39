#include "lanes.hpp"

#include "instances.hpp"

#ifdef CLUTCHWORK_ALONE
/// A program that runs one model at a time.
namespace clutchwork {

std::int64_t group_size(const System&) { return 0; }

void advance_group(Workspace<double>* const* runs, Sink* sinks, Status* statuses, int n, double t_end, void*) {
  for (int i = 0; i < n; ++i) statuses[i] = advance(*runs[i], t_end, sinks[i]);
}

}  // namespace clutchwork
#else
#include <array>
#include <clutchwork/lanes/group.hpp>

#include "lanes_wide.hpp"
#include "system_checks.hpp"

namespace clutchwork {
namespace {

static_assert(most_together == n_lanes);

/// Models with more seldom have phases that are small.
constexpr std::int64_t most_contacts = 24;

#ifdef CLUTCHWORK_WIDEST
constexpr LaneKernel widest{clutchwork_widest_advance, clutchwork_widest_look, clutchwork_widest_doubt,
                            clutchwork_widest_observe, clutchwork_widest_fit};
#endif
#ifdef CLUTCHWORK_WIDE
constexpr LaneKernel wide{clutchwork_wide_advance, clutchwork_wide_look, clutchwork_wide_doubt, clutchwork_wide_observe,
                          clutchwork_wide_fit};
#endif
#if !defined(CLUTCHWORK_WIDE) && !defined(CLUTCHWORK_WIDEST)
constexpr LaneKernel narrow{LaneStep<2>::advance, LaneStep<2>::linearize_at, LaneStep<2>::doubt, LaneStep<2>::observe,
                            LaneStep<2>::fit};
#endif

/// The widest registers that this processor has; null: none of those that are compiled.
const LaneKernel* lane_kernel() {
#ifdef CLUTCHWORK_WIDEST
  // not the first generation of AVX-512, which lowers its clock for it
  if (__builtin_cpu_supports("avx512vbmi2") && __builtin_cpu_supports("avx512vl")) return &widest;
#endif
#ifdef CLUTCHWORK_WIDE
  if (__builtin_cpu_supports("avx2")) return &wide;
#endif
#if defined(CLUTCHWORK_WIDE) || defined(CLUTCHWORK_WIDEST)
  return nullptr;
#else
  return &narrow;
#endif
}

bool has_small_phases(const System& s) {
  return s.shared == 0 && s.states <= lane_states && is_few(s) && s.contacts <= most_contacts;
}

bool same_words(const std::int32_t* a, const std::int32_t* b, std::int64_t n) {
  return std::memcmp(a, b, std::size_t(n) * sizeof *a) == 0;
}

bool same_counts(const System& a, const System& b) {
  const auto counts = [](const System& s) {
    return std::array{s.speeds, s.prescribed, s.elements, s.contacts, s.states,
                      s.shared, s.inputs,     s.n_params, s.n_points, s.n_input_refs};
  };
  return counts(a) == counts(b);
}

/// Whether the laws of contact c compute the same formula, where they have one.
bool same_formula(const System& a, const System& b, std::int64_t c) {
  bool same = true;
  visit_law(a.contact_law[c], [&](auto tag) {
    if constexpr (ProgrammedLaw<typename decltype(tag)::type>) {
      visit_law_curves(a.contact_law[c], [&](int at) {
        const double* range = a.params + a.contact_law_param[c] + at;
        const std::int64_t first = 3 * std::int64_t(range[0]), n = 3 * std::int64_t(range[1]);
        same = same && std::memcmp(a.points + first, b.points + first, std::size_t(n) * sizeof(double)) == 0;
      });
    }
  });
  return same;
}

/// Whether a step reads the same places in two models.
bool same_structure(const System& a, const System& b) {
  if (!same_counts(a, b)) return false;
  bool same = same_words(a.massless, b.massless, a.speeds) && same_words(a.element_kind, b.element_kind, a.elements) &&
              same_words(a.element_param, b.element_param, a.elements) &&
              same_words(a.element_state, b.element_state, a.elements) &&
              same_words(a.element_input, b.element_input, a.elements) &&
              same_words(a.contact_kind, b.contact_kind, a.contacts) &&
              same_words(a.contact_param, b.contact_param, a.contacts) &&
              same_words(a.contact_input, b.contact_input, a.contacts) &&
              same_words(a.contact_law, b.contact_law, a.contacts) &&
              same_words(a.contact_law_param, b.contact_law_param, a.contacts) &&
              same_words(a.contact_law_input, b.contact_law_input, a.contacts) &&
              same_words(a.contact_state, b.contact_state, a.contacts) &&
              same_words(a.prescribed_input, b.prescribed_input, a.prescribed) &&
              same_words(a.prescribed_sums, b.prescribed_sums, a.prescribed) &&
              same_words(a.input_refs, b.input_refs, a.n_input_refs);
  // places of curves and choices of words
  auto check = [&](std::int64_t at) { same = same && a.params[at] == b.params[at]; };
  if (same)
    visit_fixed(a, [&](std::int64_t at) { check(at), check(at + 1); }, [&](std::int64_t at, int) { check(at); });
  for (std::int64_t c = 0; same && c < a.contacts; ++c) same = same_formula(a, b, c);
  return same;
}

/// Memory of a group; the arrays of the lanes follow it.
struct Ground {
  Member member[n_lanes];
  Workspace<Lanes<2>> lanes;
};
constexpr std::int64_t alignment = 64;

std::int64_t ground_size(const System& sys) {
  Workspace<Lanes<2>> lanes;
  return alignment + std::int64_t(sizeof(Ground)) + carve(lanes, sys, nullptr);
}

void advance_lanes(Workspace<double>* const* runs, Sink* sinks, Status* statuses, int n, double t_end, void* memory) {
  auto at = (reinterpret_cast<std::uintptr_t>(memory) + alignment - 1) / alignment * alignment;
  auto* ground = new (reinterpret_cast<void*>(at)) Ground;
  auto* arrays = reinterpret_cast<unsigned char*>(at + sizeof(Ground));
  const System& sys = runs[0]->sys;
  const std::int64_t size = ground_size(sys) - alignment - std::int64_t(sizeof(Ground));
  std::memset(arrays, 0, std::size_t(size));
  carve(ground->lanes, sys, arrays);
  for (int i = 0; i < n; ++i) ground->member[i].run = runs[i], ground->member[i].sink = sinks + i;
  Group(ground->lanes, *lane_kernel(), ground->member, n, t_end).advance();
  for (int i = 0; i < n; ++i) statuses[i] = ground->member[i].status;
  drop_fences(arrays, size);
}

}  // namespace

std::int64_t group_size(const System& sys) { return has_small_phases(sys) ? ground_size(sys) : 0; }

void advance_group(Workspace<double>* const* runs, Sink* sinks, Status* statuses, int n, double t_end, void* memory) {
  bool together = n > 1 && lane_kernel() != nullptr && has_small_phases(runs[0]->sys);
  for (int i = 1; together && i < n; ++i) together = same_structure(runs[0]->sys, runs[i]->sys);
  for (int i = 0; i < n; ++i) together = together && runs[i]->options.method != Method::fixed;
  if (together) return advance_lanes(runs, sinks, statuses, n, t_end, memory);
  for (int i = 0; i < n; ++i) statuses[i] = advance(*runs[i], t_end, sinks[i]);
}

}  // namespace clutchwork
#endif
