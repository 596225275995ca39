#pragma once
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/workspace.hpp>

/// Directions of the motion: the rate of each, and the branch that works along it.
namespace clutchwork {

/// One row of a matrix without its zeros.
template <class G>
struct MatrixRow {
  const std::int32_t* column;
  const G* value;
  int n;

  /// Product with x.
  template <class T>
  CLUTCHWORK_INLINE T times(const T* x) const {
    T s = T(0);
    for (int e = 0; e < n; ++e) s += T(value[e]) * x[column[e]];
    return s;
  }
};

/// Row i of a matrix whose rows end there.
template <class G>
MatrixRow<G> matrix_row(const std::int32_t* end, const std::int32_t* column, const G* value, std::int64_t i) {
  const std::int32_t first = i > 0 ? end[i - 1] : 0;
  return {column + first, value + first, int(end[i] - first)};
}
template <class G>
MatrixRow<G> basis_row(const SystemOf<G>& s, int node) {
  return matrix_row(s.basis_end, s.basis_column, s.basis_value, node);
}

/// Speed or acceleration of a node from those of the independent and the prescribed speeds.
template <class T, class G>
T node_value(const SystemOf<G>& s, int node, const T* speeds, const T* prescribed) {
  T sum = basis_row(s, node).times(speeds);
  for (int p = 0; p < s.prescribed; ++p) sum += T(s.basis_prescribed[node * s.prescribed + p]) * prescribed[p];
  return sum;
}

/// Torque of a metered line on its node, of accelerations and torques; or its impulse, of jumps of speed and impulses.
template <class T, class G, class Acceleration, class Torque>
T meter_sum(const SystemOf<G>& s, int m, Acceleration&& acceleration, Torque&& torque) {
  T sum = T(0);
  for (int e = m > 0 ? s.meter_end[m - 1] : 0; e < s.meter_end[m]; ++e) {
    const int k = s.meter_column[e];
    sum += T(s.meter_value[e]) * (k < s.nodes ? acceleration(k) : torque(k - int(s.nodes)));
  }
  return sum;
}
template <class G>
MatrixRow<G> mass_row(const SystemOf<G>& s, int i) {
  return matrix_row(s.mass_end, s.mass_column, s.mass_value, i);
}

/// Shares of the speeds in the rate of a direction.
template <class G>
MatrixRow<G> rate_row(const SystemOf<G>& s, int d) {
  if (d < s.elements) return matrix_row(s.element_rate_end, s.element_rate_column, s.element_rate_value, d);
  return matrix_row(s.contact_rate_end, s.contact_rate_column, s.contact_rate_value, d - s.elements);
}

/// Share of prescribed speed p in the rate of a direction.
template <class T>
T prescribed_share(const Workspace<T>& ws, int d, int p) {
  const auto& sys = ws.sys;
  if (d < sys.elements) return T(sys.element_rate_prescribed[d * sys.prescribed + p]);
  return T(sys.contact_rate_prescribed[(d - sys.elements) * sys.prescribed + p]);
}

/// Rate of a direction at the present speeds.
template <class T>
T rate_of(const Workspace<T>& ws, int d) {
  const auto& sys = ws.sys;
  T r = rate_row(sys, d).times(ws.v);
  for (int p = 0; p < sys.prescribed; ++p) r += prescribed_share(ws, d, p) * ws.in.prescribed[p];
  return r;
}

/// Rates of all ways of a branch at the present speeds.
template <class T>
struct PresentRates {
  T at[most_ways];
  PresentRates(const Workspace<T>& ws, const Branch<T>& b) {
    for (int i = 0; i < b.ways; ++i) at[i] = rate_of(ws, b.direction + i);
  }
};

/// The branch of an element, or of a contact that slips with the given sign.
template <class T>
Branch<T> make_branch(const Workspace<T>& ws, int d, int sign) {
  const auto& sys = ws.sys;
  Branch<T> b{};
  b.direction = d;
  b.sign = sign;
  b.piece = ws.piece[d];
  b.law_params = nullptr;
  if (d < sys.elements) {
    b.inputs = element_inputs(sys.element_kind[d]);
    b.kind = sys.element_kind[d];
    b.law = -1;
    b.ways = sys.element_way[d] == 0 ? ways_of(b.kind) : 0;
    b.params = ws.params + sys.element_param[d];
    b.state = sys.element_state[d];
    b.input = ws.in.u + sys.element_input[d];
    b.input_slope = ws.in.du + sys.element_input[d];
  } else {
    const int c = d - int(sys.elements);
    b.kind = sys.contact_kind[c];
    b.ways = 1;
    b.law = sys.contact_law[c];
    b.params = ws.params + sys.contact_param[c];
    b.law_params = ws.params + sys.contact_law_param[c];
    b.state = sys.contact_state[c];
    b.input = ws.in.u + sys.contact_input[c];
    b.input_slope = ws.in.du + sys.contact_input[c];
    b.inputs = contact_inputs(b.kind);
    b.law_inputs = law_inputs_of(b.law);
    b.law_input = ws.in.u + sys.contact_law_input[c];
    b.law_input_slope = ws.in.du + sys.contact_law_input[c];
    b.shaped = is_shaped(b.kind);
    b.follows = ws.loads.of[c] >= 0;
    b.pressed = ws.contact.pressed[c] != 0;
    b.compliant = ws.contact.compliant[c] != 0;
    if (b.compliant) b.sign = forward;
  }
  // the first way has the states of all
  b.states = b.ways > 0 ? states_of(b.kind, b.law, b.law < 0 ? b.params : b.law_params) : 0;
  return b;
}

}  // namespace clutchwork
