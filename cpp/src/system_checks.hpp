#pragma once
#include "instances.hpp"

/// Whether bytes that claim to be a System are one: offsets and numbers that the core follows without looking.
namespace clutchwork {

/// Numbers in the pool that a kind reads as its parameters.
template <class E>
constexpr std::int64_t param_count = std::int64_t(sizeof(typename E::template Params<double>) / sizeof(double));

/// Whether the curve that stands at params[at] lies among the points.
inline bool curve_fits(const System& s, std::int64_t at) {
  const double first = s.params[at], count = s.params[at + 1];
  return first >= 0 && count >= 1 && first + count <= double(s.n_points);
}

/// Whether n segments stand in order and repeat no faster than a run could follow.
template <class Times>
bool in_order(std::int64_t n, double period, const Times& times) {
  for (std::int64_t k = 0; k + 1 < n; ++k) {
    if (!(times[k] <= times[k + 1])) return false;
  }
  if (n == 0 || period <= 0) return true;
  const double start = times[0], end = times[n - 1];
  return end - start <= period && start > -1e8 * period && abs(end) < 1e12 * period;
}

/// Whether the segments of a signal stand behind those of the signals before it, in order.
inline bool signal_fits(const System& s, std::int64_t i, std::int64_t& next) {
  const std::int64_t first = s.input_first[i], count = s.input_count[i];
  if (count < 0 || first != next || first + count > s.segments) return false;
  next += count;
  return in_order(count, s.input_period[i], s.segment_time + first);
}

/// Calls curve(place) and choice(place, words) for every parameter that says where numbers stand, which of a few words
/// is meant, or how many states there are (words = 0: any number): they never change.
template <class Curve, class Choice>
void visit_fixed(const System& s, Curve&& curve, Choice&& choice) {
  std::int64_t first = 0;
  auto curves = [&](int at) { curve(first + at); };
  auto choices = [&](int at, int n) { choice(first + at, n); };
  for (std::int64_t i = 0; i < s.elements; ++i) {
    first = s.element_param[i];
    visit_torque_fixed(s.element_kind[i], curves, choices);
  }
  for (std::int64_t i = 0; i < s.contacts; ++i) {
    first = s.contact_param[i];
    visit_contact_fixed(s.contact_kind[i], curves, choices);
    first = s.contact_law_param[i];
    visit_law_fixed(s.contact_law[i], curves, choices);
  }
  for (std::int64_t i = 0; i < s.flows; ++i) {
    first = s.flow_param[i];
    visit_flow_fixed(s.flow_kind[i], curves, choices);
  }
  for (std::int64_t i = 0; i < s.processes; ++i) {
    first = s.process_param[i];
    visit_process_fixed(s.process_kind[i], curves, choices);
  }
}

/// Whether a parameter must stay as it was loaded.
inline bool is_fixed(const System& s, std::int64_t offset) {
  bool found = false;
  visit_fixed(
      s, [&](std::int64_t at) { found = found || offset == at || offset == at + 1; },
      [&](std::int64_t at, int) { found = found || offset == at; });
  return found;
}

/// Whether the parameters that mean one of a few words do.
inline bool choices_fit(const System& s) {
  bool good = true;
  visit_fixed(
      s, [](std::int64_t) {},
      [&](std::int64_t at, int n) {
        const double x = s.params[at];
        good = good && (n == 0 || (x >= 0 && x < n && x == double(int(x))));
      });
  return good;
}

/// Whether the tables of the law of a contact fit each other, and the words of its formula read what is there.
inline bool tables_fit(const System& s, std::int64_t contact) {
  return visit_law(s.contact_law[contact], [&](auto tag) {
    using L = typename decltype(tag)::type;
    const auto& p =
        *reinterpret_cast<const typename L::template Params<double>*>(s.params + s.contact_law_param[contact]);
    if constexpr (FittedLaw<L>) return L::fits(p);
    if constexpr (ProgrammedLaw<L>)
      return L::is_sound(p, s.points, s.n_params - s.contact_law_param[contact] - param_count<L>);
    return true;
  });
}

/// Whether n references from `first` on are to signals and shared states: torques know the rates of others, and those
/// of elements alone, in the full form.
inline bool plain_inputs(const System& s, std::int64_t first, int n) {
  const std::int64_t most = s.inputs + s.shared + (s.full[0] != 0 ? s.elements : 0);
  for (int i = 0; i < n && first + n <= s.n_input_refs; ++i) {
    if (s.input_refs[first + i] >= most) return false;
  }
  return true;
}

/// Whether a flow lies inside the pools, between two shared states.
inline bool flow_fits(const System& s, std::int64_t i) {
  bool good = has_flow(s.flow_kind[i]) && s.flow_from[i] >= -1 && s.flow_from[i] < s.shared && s.flow_to[i] >= -1 &&
              s.flow_to[i] < s.shared && s.flow_param[i] >= 0 && s.flow_input[i] >= 0;
  if (!good) return false;
  visit_flow(s.flow_kind[i], [&](auto tag) {
    using E = typename decltype(tag)::type;
    good = s.flow_param[i] + param_count<E> <= s.n_params && s.flow_input[i] + E::inputs <= s.n_input_refs;
  });
  visit_flow_curves(s.flow_kind[i], [&](int at) { good = good && curve_fits(s, s.flow_param[i] + at); });
  return good;
}

/// Whether a process lies inside the pools, its states among the shared ones.
inline bool process_fits(const System& s, std::int64_t i) {
  bool good = has_process(s.process_kind[i]) && s.process_state[i] >= s.states - s.shared && s.process_param[i] >= 0 &&
              s.process_input[i] >= 0;
  if (!good) return false;
  visit_process(s.process_kind[i], [&](auto tag) {
    using E = typename decltype(tag)::type;
    good = s.process_param[i] + param_count<E> <= s.n_params && s.process_input[i] + E::inputs <= s.n_input_refs &&
           s.process_state[i] + E::states <= s.states && s.process_begins[i] < E::inputs;
  });
  visit_process_curves(s.process_kind[i], [&](int at) { good = good && curve_fits(s, s.process_param[i] + at); });
  return good;
}

/// Whether an input of a process draws from one that gathers, and those of one process stand together.
inline bool draw_fits(const System& s, std::int64_t j) {
  const auto inside = [&](std::int64_t c) { return c >= 0 && c < s.processes; };
  const std::int64_t c = s.draw_process[j], from = s.draw_from[j];
  if (!inside(c) || !inside(from) || (j > 0 && s.draw_process[j - 1] > c)) return false;
  const bool gathers = visit_process(s.process_kind[from], [](auto tag) { return bool(decltype(tag)::type::gathers); });
  return gathers && visit_process(s.process_kind[c], [&](auto tag) {
           using E = typename decltype(tag)::type;
           return DrawingProcess<E> && s.draw_input[j] >= 0 && s.draw_input[j] < E::inputs;
         });
}

/// Whether sums of flows are read by their own process alone, as its first input.
inline bool sums_fit(const System& s) {
  const std::int64_t first = s.inputs + s.shared + 3 * (s.elements + s.contacts);
  std::int64_t found = 0, own = 0;
  for (std::int64_t i = 0; i < s.n_input_refs; ++i) found += s.input_refs[i] >= first;
  for (std::int64_t c = 0; c < s.processes; ++c) {
    const bool gathers = visit_process(s.process_kind[c], [](auto tag) { return bool(decltype(tag)::type::gathers); });
    if (gathers && s.input_refs[s.process_input[c]] != first + c) return false;
    own += gathers;
  }
  return found == own;
}

/// As in_range, for what concerns the shared states.
inline bool shared_in_range(const System& s) {
  bool good = s.shared <= s.states;
  for (std::int64_t i = 0; good && i < s.flows; ++i) good = flow_fits(s, i);
  for (std::int64_t i = 0; good && i < s.processes; ++i) good = process_fits(s, i);
  if (with_draws) {
    for (std::int64_t j = 0; good && j < s.draws; ++j) good = draw_fits(s, j);
    good = good && sums_fit(s);
  } else {
    good = good && s.draws == 0;
  }
  for (std::int64_t i = 0; good && i < s.supplies; ++i) {
    good = s.supply_element[i] >= 0 && s.supply_element[i] < s.elements;
  }
  for (std::int64_t h = 0; good && h < s.heats; ++h) {
    good = s.heat_direction[h] >= 0 && s.heat_direction[h] < s.elements + s.contacts && s.heat_to[h] >= 0 &&
           s.heat_to[h] < s.shared;
  }
  return good;
}

/// Whether n numbers lie between two bounds.
inline bool within(const std::int32_t* x, std::int64_t n, std::int64_t low, std::int64_t high) {
  for (std::int64_t i = 0; i < n; ++i) {
    if (x[i] < low || x[i] > high) return false;
  }
  return true;
}

/// Whether the metered lines read nodes and directions that are there.
inline bool meters_in_range(const System& s) {
  bool good = within(s.meter_node, s.meters, 0, s.nodes - 1) &&
              within(s.meter_column, s.meter_entries, 0, s.nodes + s.elements + s.contacts - 1);
  for (std::int64_t m = 0; good && m < s.meters; ++m) {
    good = s.meter_end[m] >= (m > 0 ? s.meter_end[m - 1] : 0) && s.meter_end[m] <= s.meter_entries;
  }
  return good;
}

/// Kinds and the form of the motion are compiled.
inline bool is_compiled(const System& s) {
  bool good = s.full[0] != 0 ? has_full_form : has_sparse_form;
  for (std::int64_t i = 0; i < s.elements; ++i) good = good && has_torque(s.element_kind[i]);
  for (std::int64_t i = 0; i < s.contacts; ++i)
    good = good && has_contact(s.contact_kind[i]) && has_law(s.contact_law[i]);
  return good;
}

/// Offsets point into their pools.
inline bool offsets_in_range(const System& s) {
  const std::int64_t ne = s.elements, nc = s.contacts;
  const bool params = within(s.element_param, ne, 0, s.n_params) && within(s.contact_param, nc, 0, s.n_params) &&
                      within(s.contact_law_param, nc, 0, s.n_params);
  const bool states = within(s.element_state, ne, 0, s.states) && within(s.contact_state, nc, 0, s.states);
  const bool inputs = within(s.element_input, ne, 0, s.n_input_refs) &&
                      within(s.contact_input, nc, 0, s.n_input_refs) &&
                      within(s.contact_law_input, nc, 0, s.n_input_refs);
  return params && states && inputs && within(s.prescribed_input, s.prescribed, 0, s.inputs - 1) &&
         within(s.input_refs, s.n_input_refs, 0, s.inputs + s.shared + 3 * (ne + nc) + s.processes - 1);
}

/// Whether the ways of the elements follow each other, those of one with the same offsets.
inline bool ways_fit(const System& s) {
  const auto same = [&](std::int64_t i) {
    return s.element_kind[i] == s.element_kind[i - 1] && s.element_param[i] == s.element_param[i - 1] &&
           s.element_state[i] == s.element_state[i - 1] && s.element_input[i] == s.element_input[i - 1];
  };
  for (std::int64_t i = 0; i < s.elements;) {
    const std::int64_t n = ways_of(s.element_kind[i]);
    if (i + n > s.elements || (n > 1 && s.full[0] == 0)) return false;
    for (std::int64_t w = 0; w < n; ++w) {
      if (s.element_way[i + w] != w || (w > 0 && !same(i + w))) return false;
    }
    i += n;
  }
  return true;
}

/// Whether transmissions are elements of two ways with a ratio, and what follows from them are speeds.
inline bool transmissions_fit(const System& s) {
  if (s.transmissions > 0 && s.full[0] == 0) return false;
  for (std::int64_t a = 0; a < s.transmissions; ++a) {
    const std::int64_t d = s.transmission_element[a], i = s.transmission_speed[a];
    if (d < 0 || d >= s.elements || s.element_way[d] != 0 || i < -1 || i >= s.speeds) return false;
    const bool ties =
        visit_torque(s.element_kind[d], [](auto tag) { return TransmissionElement<typename decltype(tag)::type>; });
    if (!ties) return false;
  }
  return true;
}

/// Whether an element lies inside the pools; its states.
inline bool element_fits(const System& s, std::int64_t i, std::int64_t& states) {
  bool good = true;
  visit_torque(s.element_kind[i], [&](auto tag) {
    using E = typename decltype(tag)::type;
    good = s.element_param[i] + param_count<E> <= s.n_params && s.element_input[i] + E::inputs <= s.n_input_refs &&
           plain_inputs(s, s.element_input[i], E::inputs);
    states = E::states;
    if constexpr (Sized<E>) {
      if (good) states = states_of(s.element_kind[i], -1, s.params + s.element_param[i]);
    }
    good = good && s.element_state[i] + states <= s.states - s.shared;
    if (s.element_way[i] != 0) states = 0;
    if constexpr (FittedLaw<E>) {
      good =
          good && E::fits(*reinterpret_cast<const typename E::template Params<double>*>(s.params + s.element_param[i]));
    }
  });
  visit_torque_curves(s.element_kind[i], [&](int at) { good = good && curve_fits(s, s.element_param[i] + at); });
  return good;
}

/// Whether a torque element has the position of a stop.
inline bool is_place(const System& s, std::int64_t i) {
  return i >= 0 && i < s.elements &&
         visit_torque(s.element_kind[i], [](auto tag) { return decltype(tag)::type::states > 0; });
}

/// Whether a contact and its law lie inside the pools; their states.
inline bool contact_fits(const System& s, std::int64_t i, std::int64_t& states) {
  bool good = true;
  visit_contact(s.contact_kind[i], [&](auto tag) {
    using E = typename decltype(tag)::type;
    good = s.contact_param[i] + param_count<E> <= s.n_params && s.contact_input[i] + E::inputs <= s.n_input_refs &&
           plain_inputs(s, s.contact_input[i], E::inputs);
  });
  visit_contact_curves(s.contact_kind[i], [&](int at) { good = good && curve_fits(s, s.contact_param[i] + at); });
  visit_contact(s.contact_kind[i], [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<double>*>(s.params + s.contact_param[i]);
    if constexpr (FittedLaw<E>) good = good && E::fits(p);
  });
  visit_law(s.contact_law[i], [&](auto tag) {
    using L = typename decltype(tag)::type;
    good = good && s.contact_law_param[i] + param_count<L> <= s.n_params &&
           s.contact_law_input[i] + L::inputs <= s.n_input_refs && plain_inputs(s, s.contact_law_input[i], L::inputs);
  });
  visit_law_curves(s.contact_law[i], [&](int at) { good = good && curve_fits(s, s.contact_law_param[i] + at); });
  if (!good || !tables_fit(s, i)) return false;
  const bool stops =
      visit_contact(s.contact_kind[i], [](auto tag) { return StopContact<typename decltype(tag)::type>; });
  good = good && (stops ? is_place(s, s.contact_place[i]) : s.contact_place[i] == -1);
  if (!good) return false;
  states = states_of(s.contact_kind[i], s.contact_law[i], s.params + s.contact_law_param[i]);
  return s.contact_state[i] + states <= s.states - s.shared;
}

/// Whether the contacts that follow loads are those that must, in order, in the full form.
inline bool loads_fit(const System& s) {
  std::int64_t found = 0;
  for (std::int64_t c = 0; c < s.contacts; ++c) {
    if (!is_loaded(s.contact_kind[c])) continue;
    if (found >= s.loads || s.load_contact[found] != c) return false;
    ++found;
  }
  return found == s.loads && (found == 0 || s.full[0] != 0);
}

/// Whether the rows of a matrix end in order, each with speeds in ascending order.
inline bool rows_fit(const System& s, const std::int32_t* end, const std::int32_t* column, std::int64_t rows,
                     std::int64_t entries) {
  std::int64_t at = 0;
  for (std::int64_t i = 0; i < rows; ++i) {
    if (end[i] < at || end[i] > entries) return false;
    for (const std::int64_t first = at; at < end[i]; ++at) {
      if (column[at] < 0 || column[at] >= s.speeds || (at > first && column[at] <= column[at - 1])) return false;
    }
  }
  return at == entries;
}

/// Whether the matrices are ones, and no room is larger than the whole matrix.
inline bool matrices_fit(const System& s) {
  const std::int64_t nv = s.speeds, nc = s.contacts, nd = s.elements + nc, half = nv * (nv + 1) / 2;
  return rows_fit(s, s.basis_end, s.basis_column, s.nodes, s.basis_entries) &&
         rows_fit(s, s.mass_end, s.mass_column, nv, s.mass_entries) &&
         rows_fit(s, s.element_rate_end, s.element_rate_column, s.elements, s.element_rate_entries) &&
         rows_fit(s, s.contact_rate_end, s.contact_rate_column, nc, s.contact_rate_entries) && s.factor_room <= half &&
         s.direction_room <= nd * nv && s.mobility_room <= nc * (nc + 1) / 2 && s.expansion_room <= nv * (nv + 1) &&
         s.rate_room <= nd * nv && s.mass_room <= half && s.envelope_room <= half && s.spares <= nc && s.set_size <= nc;
}

/// Offsets and numbers inside the system that the core follows without looking.
inline bool in_range(const System& s) {
  bool good = is_compiled(s) && offsets_in_range(s) && ways_fit(s) && loads_fit(s) && transmissions_fit(s) &&
              shared_in_range(s) && meters_in_range(s) && matrices_fit(s);
  std::int64_t all = 0, own = 0, segments = 0;
  for (std::int64_t i = 0; good && i < s.inputs; ++i) good = signal_fits(s, i, segments);
  for (std::int64_t i = 0; good && i < s.elements; ++i, all += own) good = element_fits(s, i, own);
  for (std::int64_t i = 0; good && i < s.contacts; ++i, all += own) good = contact_fits(s, i, own);
  // states are nobody's twice
  return good && all <= s.states - s.shared && choices_fit(s);
}

}  // namespace clutchwork
