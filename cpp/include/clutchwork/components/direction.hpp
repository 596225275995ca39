#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/workspace.hpp>

/// Directions of the motion: the rate of each, and the branch that works along it.
namespace clutchwork {

/// Rate of a direction at the present speeds.
template <class T>
T rate_of(const Workspace<T>& ws, int d) {
  const System& sys = ws.sys;
  const bool element = d < sys.elements;
  const std::int64_t k = element ? d : d - sys.elements;
  const double* row = (element ? sys.element_rate : sys.contact_rate) + k * sys.speeds;
  const double* given = (element ? sys.element_rate_prescribed : sys.contact_rate_prescribed) + k * sys.prescribed;
  T r = T(0);
  for (int i = 0; i < sys.speeds; ++i) r += T(row[i]) * ws.v[i];
  for (int p = 0; p < sys.prescribed; ++p) r += T(given[p]) * ws.prescribed[p];
  return r;
}

/// Share of prescribed speed p in the rate of a direction.
template <class T>
T prescribed_share(const Workspace<T>& ws, int d, int p) {
  const System& sys = ws.sys;
  if (d < sys.elements) return T(sys.element_rate_prescribed[d * sys.prescribed + p]);
  return T(sys.contact_rate_prescribed[(d - sys.elements) * sys.prescribed + p]);
}

/// The branch of an element, or of a contact that slips with the given sign.
template <class T>
Branch<T> make_branch(const Workspace<T>& ws, int d, int sign) {
  const System& sys = ws.sys;
  Branch<T> b{};
  b.direction = d;
  b.sign = sign;
  b.piece = ws.piece[d];
  b.law_params = nullptr;
  if (d < sys.elements) {
    b.inputs = element_inputs(sys.element_kind[d]);
    b.kind = sys.element_kind[d];
    b.law = -1;
    b.params = ws.params + sys.element_param[d];
    b.state = sys.element_state[d];
    b.input = ws.u + sys.element_input[d];
    b.input_slope = ws.du + sys.element_input[d];
  } else {
    const int c = d - int(sys.elements);
    b.kind = sys.contact_kind[c];
    b.law = sys.contact_law[c];
    b.params = ws.params + sys.contact_param[c];
    b.law_params = ws.params + sys.contact_law_param[c];
    b.state = sys.contact_state[c];
    b.input = ws.u + sys.contact_input[c];
    b.input_slope = ws.du + sys.contact_input[c];
    b.inputs = contact_inputs(b.kind);
    b.law_inputs = law_inputs_of(b.law);
    b.law_input = ws.u + sys.contact_law_input[c];
    b.law_input_slope = ws.du + sys.contact_law_input[c];
    b.shaped = is_shaped(b.kind);
    b.pressed = ws.pressed[c] != 0;
    b.compliant = ws.compliant[c] != 0;
    if (b.compliant) b.sign = forward;
  }
  b.states = states_of(b.kind, b.law, b.law_params);
  return b;
}

}  // namespace clutchwork
