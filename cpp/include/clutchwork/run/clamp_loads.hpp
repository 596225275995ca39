#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/workspace.hpp>

/// Loads and faults of the contacts: docs/theory/events.md.
namespace clutchwork {

/// Calls f for the load of a contact at every corner of the ranges of its inputs; range(i, low, high) gives them, and
/// false where there is none. The load is monotonic in each of its inputs while the others are held, so its extremes
/// are at the corners. False: a range is missing or infinite.
template <class T, class Range, class F>
bool visit_corners(const Workspace<T>& ws, int c, Range&& range, F&& f) {
  const auto& sys = ws.sys;
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    double low[E::inputs > 0 ? E::inputs : 1], high[E::inputs > 0 ? E::inputs : 1];
    for (int i = 0; i < E::inputs; ++i) {
      if (!range(int(sys.contact_input[c]) + i, low[i], high[i]) || !(high[i] - low[i] < infinity)) return false;
    }
    for (unsigned corner = 0; corner < 1u << E::inputs; ++corner) {
      T at[E::inputs > 0 ? E::inputs : 1];
      for (int i = 0; i < E::inputs; ++i) at[i] = T(corner >> i & 1 ? high[i] : low[i]);
      f(contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], &at[0], points_of(ws)));
    }
    return true;
  });
}

/// Whether the load of a contact can pass zero before the next knot.
template <class T>
bool load_may_turn(Workspace<T>& ws, int c) {
  bool below = false, above = false;
  Real<T> size = 0;
  auto range = [&](int ref, double& low, double& high) {
    signal_range(ws, ws.sys.input_refs[ref], ws.time, low, high);
    return true;
  };
  const bool bounded = visit_corners(ws, c, range, [&](const T& load) {
    (load < T(0) ? below : above) = true;
    size = larger(size, abs(value(load)));
  });
  ws.guard.load_size[c] = double(bounded ? size : 0);
  return !bounded || (below && above);
}

/// Whether the load of a contact stays on its side of zero, and clear of it, over the step of length h at whose end the
/// inputs were taken.
template <class T>
bool load_stays(const Workspace<T>& ws, int c, double h) {
  const double side = ws.contact.pressed[c] ? 1.0 : -1.0;
  bool clear = true;
  auto range = [&](int ref, double& low, double& high) { return reference_range(ws, ref, h, low, high); };
  return visit_corners(ws, c, range, [&](const T& load) { clear = clear && side * value(load) > 0; }) && clear;
}

/// Load that counts as zero at a contact which follows speeds or states: what a slip that counts as zero, or a
/// thousandth of the tolerance of a state, makes of it at the present inputs. docs/theory/events.md, rule 10
template <class T>
double load_at_rest(const Workspace<T>& ws, int c) {
  const auto& sys = ws.sys;
  const double slip = slip_tolerance(ws), state = 1e-3 * ws.options.atol;
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    T at[E::inputs > 0 ? E::inputs : 1];
    bool follows = false;
    for (int i = 0; i < E::inputs; ++i) {
      const std::int64_t ref = sys.contact_input[c] + i, code = sys.input_refs[ref];
      at[i] = ws.in.u[ref];
      if (code < sys.inputs) continue;
      const std::int64_t j = code - sys.inputs;
      at[i] += T(j < sys.shared ? state * sys.shared_scale[j] : slip), follows = true;
    }
    if (!follows) return 0.0;
    const T load = contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], &at[0], points_of(ws));
    return abs(value(load) - value(load_of(ws, c)));
  });
}

/// A contact fails: for good, and told as an event without a change of mode.
template <class T>
void fail(Workspace<T>& ws, int c) {
  int kind, report;
  fault_of(ws, c, kind, report);
  // a freewheel that gave way transmits nothing more
  if (kind == sound) kind = cannot_transmit;
  ws.contact.fault[c] = kind;
  const double e = double(kinetic_energy(ws));
  double torque = double(value(ws.event_context.torque[c]));
  // which the run behind its steps has alone
  if constexpr (NumberOf<T>::single) torque = double(ws.fixed.torque[ws.sys.elements + c]);
  record(ws, {c, ws.contact.mode[c], ws.contact.mode[c], Cause::fault, 0.0, torque, torque, e, e});
  if (report == int(choice::Report::error)) ws.contact.failed = c;
  if (kind == cannot_transmit) ws.contact.loaded[c] = ws.contact.pressed[c] = 0;
}

/// Flags that follow from the signals: which contacts are closed, which loads vary, which fail.
template <class T>
bool refresh_loads(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  bool changed = false;
  ws.guard.n_loads = ws.guard.n_faulty = 0;
  for (int c = 0; c < sys.contacts; ++c) {
    int kind, report;
    fault_of(ws, c, kind, report);
    if (kind != sound && ws.contact.fault[c] == sound) {
      ws.guard.faulty[ws.guard.n_faulty++] = c;
      if (fault_trigger(ws, c) > 0) fail(ws, c), changed = true;
    }
    const int pressed = is_pressed(ws, c), was = ws.contact.pressed[c];
    ws.contact.pressed[c] = pressed;
    const int closed = is_closed(ws, c);
    changed = changed || closed != ws.contact.loaded[c] || pressed != was;
    ws.contact.loaded[c] = closed;
    if (load_may_turn(ws, c)) ws.guard.load[ws.guard.n_loads++] = c;
  }
  return changed;
}

/// The load of a contact passes zero. docs/theory/events.md, rule 8
template <class T>
void turn_load(Workspace<T>& ws, int c) {
  ws.contact.pressed[c] = !ws.contact.pressed[c];
  ws.guard.turned_at[c] = ws.time;
  ws.contact.loaded[c] = is_closed(ws, c);
}

}  // namespace clutchwork
