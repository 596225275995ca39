#pragma once
#include <clutchwork/components/input.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/workspace.hpp>

/// What each contact can hold now, and which may stick: docs/theory/contacts.md.
namespace clutchwork {

/// Whether time stands since an instant. docs/theory/contacts.md, rule 5
template <class T>
bool stands_since(const Workspace<T>& ws, double instant) {
  return ws.time - instant <= 1e-9 + 1e-12 * abs(ws.time);
}

/// Load of a contact now, negative included.
template <class T>
T load_of(const Workspace<T>& ws, int c) {
  const auto& sys = ws.sys;
  if (ws.contact.fault[c] == cannot_transmit) return T(-1);
  return contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], ws.in.u + sys.contact_input[c],
                      points_of(ws));
}

/// What holds a contact that follows a load against slip in a direction, at a size of slip.
template <class T>
Bound<T> bound_of(const Workspace<T>& ws, int c, int direction, T slip, int piece) {
  const auto& sys = ws.sys;
  return contact_bound<T, T>(sys.contact_kind[c], ws.params + sys.contact_param[c], slip,
                             ws.in.u + sys.contact_input[c], piece, points_of(ws), direction);
}

/// Static torque of a contact now that resists slip in a direction [N m].
template <class T>
T static_torque(const Workspace<T>& ws, int c, int direction) {
  if constexpr (!has_lanes<T>) {
    if (ws.loads.of[c] >= 0) [[unlikely]]
      return bound_of(ws, c, direction, T(0), 0).at(ws.loads.now[ws.loads.of[c]]);
  }
  return ws.contact.fault[c] == cannot_transmit
             ? T(0)
             : contact_limit(ws.sys, points_of(ws), c, ws.params, ws.in.u + ws.sys.contact_input[c],
                             ws.in.u + ws.sys.contact_law_input[c], direction);
}

/// What a contact can hold now against slip in a direction [N m]: nothing where its law never sticks.
template <class T>
T capacity_of(const Workspace<T>& ws, int c, int direction) {
  if (ws.contact.fault[c] == cannot_unlock) return T(infinity);
  return ws.contact.compliant[c] ? T(0) : static_torque(ws, c, direction);
}

/// The capacity that counts while a contact holds a torque: a positive one resists backward slip.
template <class T>
T capacity_at(const Workspace<T>& ws, int c, T torque) {
  if (contact_one_way(ws, c)) return capacity_of(ws, c, forward);
  return choose(
      value(torque) > 0, [&] { return capacity_of(ws, c, backward); }, [&] { return capacity_of(ws, c, forward); });
}

/// The same of one that may hold less the other way: what leaves it no more than its torque is from either limit, for
/// it may turn and come back within a step. docs/theory/events.md (7)
template <class T>
T capacity_left(const Workspace<T>& ws, int c, T torque) {
  if (!is_directed(ws.sys.contact_kind[c]) || contact_one_way(ws, c)) return capacity_at(ws, c, torque);
  return smaller(capacity_of(ws, c, forward) + torque, capacity_of(ws, c, backward) - torque) + abs(torque);
}

/// The larger capacity of both ways.
template <class T>
T most_capacity(const Workspace<T>& ws, int c) {
  const T ahead = capacity_of(ws, c, forward);
  return is_directed(ws.sys.contact_kind[c]) ? larger(ahead, capacity_of(ws, c, backward)) : ahead;
}

/// Above zero when a contact fails; below for one that cannot.
template <class T>
T fault_margin(const Workspace<T>& ws, int c) {
  return visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (FaultyContact<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.contact_param[c]);
      return E::fault(p, At<T>{T(0), nullptr, ws.in.u + ws.sys.contact_input[c], 0, points_of(ws)});
    }
    return T(-1);
  });
}
template <class T>
Real<T> fault_trigger(const Workspace<T>& ws, int c) {
  return value(fault_margin(ws, c));
}

/// What a failure does to a contact, and how it is reported.
template <class T>
void fault_of(const Workspace<T>& ws, int c, int& kind, int& report) {
  kind = sound, report = int(choice::Report::warning);
  visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (FaultyContact<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.contact_param[c]);
      kind = int(E::fault_kind(p)), report = int(E::fault_report(p));
    }
  });
}

/// Whether a contact may stick: its law can, or it is a freewheel.
template <class T>
bool may_stick(const Workspace<T>& ws, int c) {
  return !ws.contact.compliant[c] || contact_one_way(ws, c) || ws.contact.fault[c] == cannot_unlock;
}

/// Time derivative of what a reference reads, of signals some time later.
template <class T>
[[gnu::noinline]] T slope_of_input(const Workspace<T>& ws, int ref, double later) {
  if constexpr (!has_lanes<T>) {
    const std::int64_t i = ws.sys.input_refs[ref];
    if (later > 0 && i < ws.sys.inputs && ws.in.signal[i].varying) return signal_slope(ws, int(i), ws.time + later);
  }
  return ws.in.du[ref] + ws.in.shared_slope[ref];
}

/// Time derivative of the load of a contact, with the slopes of signals some time later.
template <class T>
T load_slope(const Workspace<T>& ws, int c, double later = 0) {
  const auto& sys = ws.sys;
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    Dual<T, 1> input[E::inputs > 0 ? E::inputs : 1];
    for (int i = 0; i < E::inputs; ++i) {
      const int ref = sys.contact_input[c] + i;
      input[i] = Dual<T, 1>(ws.in.u[ref]);
      input[i].d[0] = slope_of_input(ws, ref, later);
    }
    return contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], &input[0], points_of(ws)).d[0];
  });
}

/// What a load that is zero now is a nanosecond later, by its slope there: now that of a load which touches zero is
/// round-off. docs/theory/events.md, rule 9
template <class T>
T load_soon(const Workspace<T>& ws, int c) {
  constexpr double soon = 1e-9;
  return T(soon) * load_slope(ws, c, soon);
}

/// Whether the load of a contact bends over time, so that it may dip between two instants.
template <class T>
bool load_bends(const Workspace<T>& ws, int c) {
  const auto& sys = ws.sys;
  const int first = sys.contact_input[c];
  for (int i = first; i < first + contact_inputs(sys.contact_kind[c]); ++i) {
    const std::int64_t ref = sys.input_refs[i];
    if (ref >= sys.inputs || !ws.in.signal[ref].linear) return true;
  }
  return false;
}

/// Whether a contact is pressed: a load now, or one that is about to rise from zero.
template <class T>
bool is_pressed(const Workspace<T>& ws, int c) {
  const auto load = value(load_of(ws, c));
  return load != 0 ? load > 0 : value(load_soon(ws, c)) > 0;
}

/// Whether a contact can transmit: it is pressed, blocks one way, or cannot let go.
template <class T>
bool is_closed(const Workspace<T>& ws, int c) {
  return ws.contact.pressed[c] || contact_one_way(ws, c) ||
         (ws.contact.fault[c] == cannot_unlock && ws.contact.mode[c] == locked);
}

/// Static torque that a contact can use in a decision: one that rises from zero counts as it is a nanosecond later.
/// docs/theory/events.md, rule 9
template <class T>
T usable_capacity(const Workspace<T>& ws, int c, int direction) {
  const auto& sys = ws.sys;
  if (ws.contact.compliant[c] || ws.contact.fault[c] == cannot_unlock || value(load_of(ws, c)) > 0)
    return capacity_of(ws, c, direction);
  return larger(load_soon(ws, c), T(0)) * law_hold(sys.contact_law[c], ws.params + sys.contact_law_param[c],
                                                   ws.in.u + sys.contact_law_input[c], points_of(ws));
}

/// Tolerance under which a slip counts as zero. docs/theory/contacts.md (14)
template <class T>
Real<T> slip_tolerance(const Workspace<T>& ws) {
  Real<T> largest = 0;
  for (int i = 0; i < ws.sys.speeds; ++i) {
    if (abs(value(ws.v[i])) > largest) largest = abs(value(ws.v[i]));
  }
  return roundoff<T>(1e-10, 4e-6) * (1 + largest);
}

/// A contact without inertia on either side of its slip: prescribed speeds alone decide it.
template <class T>
bool is_rigid(const Workspace<T>& ws, int c) {
  return value(ws.geometry.own[ws.sys.elements + c]) == 0;
}

}  // namespace clutchwork
