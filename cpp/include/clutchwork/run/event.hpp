#pragma once
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// Events: their record, and those that crowd.
namespace clutchwork {

/// One event: what changed in a contact, and the slip acceleration, torques and energies around it.
struct Event {
  int contact, from, to;
  Cause cause;
  double acceleration, torque_before, torque_after, energy_before, energy_after;
};

/// Append one event to the buffer.
template <class T>
void record(Workspace<T>& ws, const Event& e) {
  const double values[event_size] = {
      ws.time,        double(e.contact), double(e.from), double(e.to),    double(int(e.cause)),
      e.acceleration, e.torque_before,   e.torque_after, e.energy_before, e.energy_after};
  double* to = ws.events.at + event_size * ws.events.n++;
  for (int i = 0; i < event_size; ++i) to[i] = values[i];
  if constexpr (has_tangents<T>) ws.moved.event[ws.events.n - 1] = ws.moved.shift;
  ++ws.statistics.events;
}

/// Whether something happens more than 50 times within a microsecond; `count` is its own of ws.events.crowd.
/// docs/theory/events.md, rule 15
template <class T>
bool crowds(Workspace<T>& ws, std::int64_t count) {
  constexpr int most = 50;
  if (ws.time - ws.events.crowd_time > 1e-6) {
    ws.events.crowd_time = ws.time;
    const std::int64_t parts = ws.sys.processes + ws.sys.flows;
    for (std::int64_t i = 0; i < ws.n_directions + ws.sys.inputs + parts; ++i) ws.events.crowd[i] = 0;
  }
  return ++ws.events.crowd[count] > most;
}

/// Whether a direction has events that crowd; they are told by its number.
template <class T>
bool events_crowd(Workspace<T>& ws, int direction) {
  if (!crowds(ws, direction)) return false;
  ws.detail.component = direction;
  return true;
}

/// How a run ends whose events crowd: one that jams again and again is not stopped by its impulses.
template <class T>
Status crowded(const Workspace<T>& ws) {
  return ws.event_context.cause == Cause::jam ? Status::unbalanced : Status::zeno;
}

/// Whether the knots of a signal crowd; told by the number of the signal, without a component.
template <class T>
bool knots_crowd(Workspace<T>& ws) {
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) {
    if (ws.in.signal[i].knot > ws.time || !crowds(ws, ws.n_directions + i)) continue;
    ws.detail.component = -1;
    ws.detail.value = double(i);
    return true;
  }
  return false;
}

/// Whether the pieces of a process crowd; told by its number behind those of the signals, without a component.
template <class T>
bool process_crowds(Workspace<T>& ws, int i) {
  if (!crowds(ws, ws.n_directions + ws.sys.inputs + i)) return false;
  ws.detail.component = -1;
  ws.detail.value = double(ws.sys.inputs + i);
  return true;
}

/// Forced break-aways last while time stands. docs/theory/contacts.md, rule 5
template <class T>
void forget_forced(Workspace<T>& ws) {
  if (stands_since(ws, ws.contact.forced_time)) return;
  for (int c = 0; c < ws.sys.contacts; ++c) ws.contact.forced[c] = 0;
  ws.contact.forced_time = ws.time;
}

}  // namespace clutchwork
