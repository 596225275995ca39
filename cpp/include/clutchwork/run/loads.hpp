#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/run/event.hpp>
#include <clutchwork/run/snapshot.hpp>
#include <clutchwork/workspace.hpp>

/// Loads and faults of the contacts: docs/theory/events.md.
namespace clutchwork {

/// Whether the load of a contact can pass zero before the next knot. A load is monotonic in each of its inputs while
/// the others are held, so its extremes are at the corners of their ranges.
template <class T>
bool load_may_turn(Workspace<T>& ws, int c) {
  const System& sys = ws.sys;
  ws.guard.load_size[c] = 0;
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    double low[E::inputs > 0 ? E::inputs : 1], high[E::inputs > 0 ? E::inputs : 1];
    for (int i = 0; i < E::inputs; ++i) {
      signal_range(ws, sys.input_refs[sys.contact_input[c] + i], ws.time, low[i], high[i]);
      if (high[i] - low[i] == infinity || high[i] - low[i] != high[i] - low[i]) return true;
    }
    bool below = false, above = false;
    double size = 0;
    for (unsigned corner = 0; corner < 1u << E::inputs; ++corner) {
      T at[E::inputs > 0 ? E::inputs : 1];
      for (int i = 0; i < E::inputs; ++i) at[i] = T(corner >> i & 1 ? high[i] : low[i]);
      const T load = contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], &at[0], sys.points);
      (load < T(0) ? below : above) = true;
      size = larger(size, abs(value(load)));
    }
    ws.guard.load_size[c] = size;
    return below && above;
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
  const double e = kinetic_energy(ws), torque = value(ws.happened.torque[c]);
  record(ws, {c, ws.contact.mode[c], ws.contact.mode[c], Cause::fault, 0.0, torque, torque, e, e});
  if (report == int(choice::Report::error)) ws.contact.failed = c;
  if (kind == cannot_transmit) ws.contact.loaded[c] = ws.contact.pressed[c] = 0;
}

/// Flags that follow from the signals: which contacts are closed, which loads vary, which fail.
template <class T>
bool refresh_loads(Workspace<T>& ws) {
  const System& sys = ws.sys;
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
