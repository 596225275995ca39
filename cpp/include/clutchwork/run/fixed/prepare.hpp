#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/component.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/motion/branches.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/run/fixed/load_rows.hpp>
#include <clutchwork/run/fixed/products.hpp>
#include <clutchwork/workspace.hpp>

/// What fixed steps take, and their matrices.
namespace clutchwork::fixed {

inline bool has_varying_ratio(int kind) {
  return visit_torque(kind, [](auto tag) { return TransmissionElement<typename decltype(tag)::type>; });
}
/// Whether a component leaves its piece where its own margin says so.
inline bool crosses(int kind, int law) {
  auto of = [](auto tag) { return SwitchingLaw<typename decltype(tag)::type>; };
  return law < 0 ? visit_torque(kind, of) : visit_law(law, of);
}
/// Where the piece of a direction comes from: it has one alone, from where it is, or from the one before.
enum Bend : int { straight, settling, crossing };
inline bool is_limited(int kind) {
  return visit_contact(kind, [](auto tag) { return LimitedContact<typename decltype(tag)::type>; });
}

/// Whether the bristles of a law change too fast for steps of one length: it says so.
inline bool is_too_fast(int law) {
  return visit_law(law, [](auto tag) { return requires { decltype(tag)::type::fixed_steps; }; });
}

/// The same of the teeth of an element.
inline bool has_teeth(int kind) {
  return visit_torque(kind, [](auto tag) { return std::is_same_v<typename decltype(tag)::type, elements::DogClutch>; });
}

/// Why a direction is refused; `taken`: it is not.
inline Refusal refusal_of(const Run& ws, int d) {
  const auto& sys = ws.sys;
  if (d < sys.elements) {
    const int kind = sys.element_kind[d];
    if (has_teeth(kind)) return Refusal::bristles;
    return has_varying_ratio(kind) ? Refusal::varying_ratio : Refusal::taken;
  }
  const int law = sys.contact_law[d - sys.elements];
  if (is_too_fast(law)) return Refusal::bristles;
  return is_chattering_law(law) ? Refusal::chatters : Refusal::taken;
}

/// Whether fixed steps take all of a system; else `detail` tells what they do not, and why.
inline bool takes(Run& ws) {
  const auto& sys = ws.sys;
  auto refuse = [&](int component, Refusal why) {
    ws.detail.component = component, ws.detail.value = double(int(why));
    return false;
  };
  if (with_draws && sys.draws > 0) return refuse(-1, Refusal::flows);
  for (int d = 0; d < ws.n_directions; ++d) {
    const Refusal why = refusal_of(ws, d);
    if (why != Refusal::taken) return refuse(d, why);
  }
  if constexpr (NumberOf<real>::single) {
    // src/clutchwork/codegen/single.py says it by name
    for (int c = 0; c < sys.contacts; ++c) {
      if (is_stop(ws, c)) return refuse(int(sys.elements) + c, Refusal::single_stops);
    }
    if (sys.loads > 0) return refuse(int(sys.elements + sys.load_contact[0]), Refusal::single_loads);
    if (sys.prescribed > 0) return refuse(-1, Refusal::single_prescribed);
    for (std::int64_t k = 0; k < sys.segments; ++k) {
      if (!is_zero(sys.segment_coef[segment_size * k + 4])) return refuse(-1, Refusal::single_waves);
    }
  }
  return has_fixed_steps(sys) || refuse(-1, Refusal::many_speeds);
}

/// Whether a torque is linear in the rate and the state of its element.
inline bool is_linear(int kind) {
  return visit_torque(kind, [](auto tag) { return LinearElement<typename decltype(tag)::type>; });
}
/// Whether a contact blocks one way, at times at least.
inline bool may_block(int kind) {
  return visit_contact(kind, [](auto tag) {
    using E = typename decltype(tag)::type;
    return StopContact<E> || int(E::one_way) != 0;
  });
}

/// Whether neither slip nor inputs change what a contact can hold over its load.
inline bool is_steady(const Run& ws, int c) {
  return visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (LoadedContact<E>)
      return E::steady(
          *reinterpret_cast<const typename E::template Params<real>*>(ws.params + ws.sys.contact_param[c]));
    return true;
  });
}

/// What the contact of load l can hold over it, at a size of slip.
inline void see_bound(Run& ws, int l, real size) {
  const int c = int(ws.sys.load_contact[l]);
  const int piece = ws.branch[ws.sys.elements + c].piece;
  for (int way = 0; way < 2; ++way) ws.fixed.load_bound[2 * l + way] = bound_of(ws, c, 2 * way - 1, size, piece);
}

/// Slopes of a linear torque, and what is left of it without rate and state. Whether it resists: what drives is taken
/// explicitly.
inline bool find_line(Run& ws, int d) {
  Fixed<real>& f = ws.fixed;
  const Branch<real>& b = ws.branch[d];
  Line<real>& line = f.plan.line[d];
  for (int i = 0; i < b.states; ++i) f.state_ahead[b.state + i] = 0;
  const Partial<real> p =
      branch_partial(ws, b, real(0), real(0), f.state_ahead, ws.observed.state_rates, state_partials(ws, d));
  line = {p.torque, p.by_rate, 0, 0};
  if (b.states > 0) line.by_state = ws.jacobian.f_state[b.state], line.state_by_rate = ws.jacobian.g_rate[b.state];
  return line.by_rate <= 0 && line.by_state * line.state_by_rate <= 0;
}

/// What a step goes through.
inline void make_plan(Run& ws) {
  const auto& sys = ws.sys;
  FixedPlan<real>& p = ws.fixed.plan;
  p.n_linear = p.n_bent = p.n_bounded = p.n_one_way = p.n_rigid = p.n_stops = p.n_crossing = 0;
  for (int d = 0; d < ws.n_directions; ++d) {
    const Branch<real>& b = ws.branch[d];
    p.smooth[d] = d < sys.elements || b.compliant;
    const bool linear = d < sys.elements && b.ways == 1 && is_linear(b.kind) && find_line(ws, d);
    if (linear) p.linear[p.n_linear++] = d;
    if (p.smooth[d] && !linear) p.bent[p.n_bent++] = d;
    if (ws.fixed.bends[d] == crossing) p.crossing[p.n_crossing++] = d;
  }
  for (int c = 0; c < sys.contacts; ++c) {
    const int kind = sys.contact_kind[c];
    p.hold[c].fault = -1, p.hold[c].low = infinity, p.hold[c].high = -infinity;
    p.blocks[c] = may_block(kind);
    if (p.blocks[c] != 0) p.one_way[p.n_one_way++] = c;
    if (is_bounded_law(sys.contact_law[c])) p.bounded[p.n_bounded++] = c;
    if (is_rigid(ws, c)) p.rigid[p.n_rigid++] = c;
    if (sys.contact_place[c] >= 0) p.stops[p.n_stops++] = c;
  }
  p.n_unsteady = 0;
  for (int l = 0; l < sys.loads; ++l) {
    see_bound(ws, l, 0.0);
    if (!is_steady(ws, int(sys.load_contact[l]))) p.unsteady[p.n_unsteady++] = l;
  }
}

/// The branches of all directions, each at the place of its direction, and what they ask for in every step.
inline void pack_all(Run& ws) {
  Fixed<real>& f = ws.fixed;
  const int ne = int(ws.sys.elements);
  int block = 0;
  ws.n_rates = 0;
  f.has_massless = false;
  for (int d = 0; d < ws.n_directions; ++d) {
    pack(ws, d, d < ne ? 0 : forward, block);
    const bool first = d >= ne || ws.sys.element_way[d] == 0;
    const bool settles = d < ne ? is_settling(ws.sys.element_kind[d]) : is_settling_law(ws.sys.contact_law[d - ne]);
    const bool switches = d < ne ? crosses(ws.sys.element_kind[d], -1) : crosses(0, ws.sys.contact_law[d - ne]);
    // where it is without a past, in the middle of the step
    const bool follows =
        settles && d < ne && edge_count(ws, d) == 0 && ws.branch[d].states == 0 && ws.branch[d].ways == 1;
    const bool crossed = switches && !follows;
    f.massless[d] = 0;
    const auto row = rate_row(ws.sys, d);
    for (int k = 0; k < row.n; ++k) f.massless[d] = f.massless[d] != 0 || ws.sys.massless[row.column[k]] != 0;
    f.has_massless = f.has_massless || f.massless[d] != 0;
    f.bends[d] = !first ? straight : crossed ? crossing : settles || edge_count(ws, d) > 0 ? settling : straight;
  }
  ws.n_branches = ws.n_rates;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int kind = ws.sys.contact_kind[c];
    f.two_sided[c] = is_shaped(kind) || is_limited(kind);
  }
  make_plan(ws);
  fill_rows(ws);
  weigh_loads(ws);
  f.ready = true;
}

/// Where the matrices are made: they are used for many steps, whose errors would add up.
inline double* wide_of(double* own, const void*) { return own; }
inline Twofold* wide_of(const Single*, Twofold* own) { return own; }
/// What is kept of them.
inline void keep_rounded(const double*, int, const double*) {}
inline void keep_rounded(const Twofold* from, int n, Single* to) {
  for (int i = 0; i < n; ++i) to[i] = from[i].high;
}

/// Factor of M - h/2 sum(slope d'd), the answers to the impulses of the contacts and their mobility.
/// docs/theory/fixed-steps.md (5)
inline bool factor_step(Run& ws, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  const int nv = int(sys.speeds), ne = int(sys.elements), nc = int(sys.contacts);
  wide *factor = wide_of(f.factor, f.wide_factor), *answer = wide_of(f.answer, f.wide_answer);
  wide* mobility = wide_of(f.mobility, f.wide_mobility);
  for (int i = 0; i < nv * nv; ++i) factor[i] = 0;
  for (int i = 0; i < nv; ++i) {
    const auto row = mass_row(sys, i);
    for (int k = 0; k < row.n && row.column[k] <= i; ++k) factor[i * nv + row.column[k]] = row.value[k];
  }
  for (int d = 0; d < ws.n_directions; ++d) {
    if (f.kept[d] == 0) continue;
    const auto row = rate_row(sys, d);
    for (int a = 0; a < row.n; ++a) {
      for (int b = 0; b <= a; ++b)
        factor[row.column[a] * nv + row.column[b]] -= wide(0.5 * h * f.kept[d]) * row.value[a] * row.value[b];
    }
  }
  if (!cholesky(nv, factor, nv)) return false;
  for (int c = 0; c < nc; ++c) {
    wide* x = answer + c * nv;
    const auto row = rate_row(sys, ne + c);
    for (int i = 0; i < nv; ++i) x[i] = 0;
    for (int k = 0; k < row.n; ++k) x[row.column[k]] = row.value[k];
    solve_step(nv, factor, x);
  }
  for (int c = 0; c < nc; ++c) {
    for (int o = 0; o < nc; ++o) mobility[c * nc + o] = rate_row(sys, ne + c).times(answer + o * nv);
  }
  keep_rounded(factor, nv * nv, f.factor), keep_rounded(answer, nc * nv, f.answer);
  keep_rounded(mobility, nc * nc, f.mobility);
  reach_loads(ws, h);
  f.length = h;
  ++ws.statistics.jacobians;
  return true;
}

}  // namespace clutchwork::fixed
