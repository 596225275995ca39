#pragma once
#include <clutchwork/run/advance.hpp>
#include <clutchwork/run/fixed/products.hpp>

#include <limits>
#include <new>

/// A run of single precision beside the one in double that the caller holds: its steps are taken here, everything else
/// there. Between calls both are the same, to the last bit. docs/theory/fixed-steps.md
namespace clutchwork::fixed {

static_assert(sizeof(double) == 8 && std::numeric_limits<float>::is_iec559);

/// The numbers of a model and of its curves as singles; returns the size that they need.
inline std::int64_t lay_numbers(Workspace<Single>& ws, const System& from, unsigned char* memory) {
  Arena arena(memory);
  auto copied = [&](const double* source, std::int64_t n) {
    Single* copy = nullptr;
    arena.take(copy, n);
    for (std::int64_t i = 0; copy != nullptr && i < n; ++i) copy[i] = Single(source[i]);
    return copy;
  };
  static_cast<SystemCounts&>(ws.sys) = from;
  visit_fields(ws.sys, from, [&](auto& field, const auto* source, std::int64_t n) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(*field)>, Single>)
      field = copied(source, n);
    else
      field = source;
  });
  ws.moved.points = copied(from.points, 3 * from.n_points);
  return (arena.size() + 63) / 64 * 64;
}

inline constexpr std::int64_t single_head = (std::int64_t(sizeof(Workspace<Single>)) + 63) / 64 * 64;

/// Memory that such a run needs.
inline std::int64_t single_size(const System& sys) {
  Workspace<Single> ws;
  return single_head + lay_numbers(ws, sys, nullptr) + carve(ws, static_cast<unsigned char*>(nullptr)) + 64;
}

/// Memory by which a run with such a one behind it is larger than one without.
inline std::int64_t extra_size(const System& sys) {
  const Sizes n(sys);
  const std::int64_t lows = n.speeds + n.states + n.nodes + n.directions + n.prescribed + n.supplies + n.meters;
  // 16 bytes each of four arrays, and 64 to where it begins
  return single_size(sys) + 8 * lows + 4 * (16 + fence) + 64;
}

/// Numbers of one precision as those of another.
template <class A, class B>
void carry(const A* from, std::int64_t n, B* to) {
  for (std::int64_t i = 0; i < n; ++i) to[i] = B(from[i]);
}

/// Numbers in double as singles, and what these lose.
inline void split(const double* from, std::int64_t n, Single* high, Single* low) {
  for (std::int64_t i = 0; i < n; ++i) high[i] = Single(from[i]), low[i] = Single(from[i] - double(high[i]));
}

/// Everything that steps change, but for the history.
template <class A, class B>
void carry_state(const Workspace<A>& from, Workspace<B>& to) {
  const Sizes n(to.sys);
  to.time = from.time, to.last_step = from.last_step, to.started = from.started;
  to.statistics = from.statistics, to.detail = from.detail, to.events.n = from.events.n;
  carry(from.v, n.speeds, to.v), carry(from.state, n.states, to.state), carry(from.angle, n.nodes, to.angle);
  carry(from.work, n.directions, to.work), carry(from.prescribed_work, n.prescribed, to.prescribed_work);
  carry(from.supplied, n.supplies, to.supplied), carry(from.metered, n.meters, to.metered);
  carry(from.piece, n.directions, to.piece), carry(from.heading, n.directions, to.heading);
  carry(from.shared.piece, n.processes + n.flows, to.shared.piece), carry(from.loads.now, n.loads, to.loads.now);
  carry(from.contact.mode, n.contacts, to.contact.mode), carry(from.contact.fault, n.contacts, to.contact.fault);
  carry(from.contact.pressed, n.contacts, to.contact.pressed);
  carry(from.contact.loaded, n.contacts, to.contact.loaded);
  to.contact.failed = from.contact.failed;
}

/// What steps know of the last one.
template <class A, class B>
void carry_history(const Fixed<A>& from, Fixed<B>& to, const Sizes& n) {
  to.time = from.time, to.before = Real<B>(from.before), to.origin = from.origin;
  to.count = from.count, to.impacts = from.impacts, to.fresh = from.fresh;
  carry(from.gain, n.speeds, to.gain), carry(from.state_gain, n.states, to.state_gain);
  carry(from.given_gain, n.prescribed, to.given_gain), carry(from.given, n.prescribed, to.given);
  carry(from.kept, n.directions, to.kept), carry(from.torque, n.directions, to.torque);
  carry(from.held, 2 * n.contacts, to.held);
  carry(from.speed_low, n.speeds, to.speed_low), carry(from.state_low, n.states, to.state_low);
  carry(from.angle_low, n.nodes, to.angle_low);
  carry(from.energy_low, n.directions + n.prescribed + n.supplies + n.meters, to.energy_low);
}

/// Where signal i stands: on the same segment.
template <class A, class B>
void carry_cursor(const Workspace<A>& from, Workspace<B>& to, int i) {
  const auto& there = from.in.signal[i];
  auto& here = to.in.signal[i];
  here.segment = there.segment, here.start = there.start, here.knot = there.knot;
  here.varying = there.varying, here.linear = there.linear, here.idle = there.idle, here.fresh = there.fresh;
  here.coef = nullptr;
  if (there.coef != nullptr) here.coef = segments_of(to, i).coef + (there.coef - segments_of(from, i).coef);
}

/// Signals as they were set, where they stand, with the values that they had before.
inline void take_signals(const Workspace<double>& outer, Workspace<Single>& ws) {
  for (int i = 0; i < ws.sys.inputs; ++i) {
    const Signal& from = outer.in.signal[i];
    SignalOf<Single>& to = ws.in.signal[i];
    to = SignalOf<Single>{};
    to.segment = from.segment, to.idle = from.idle, to.held = Single(from.held), to.given = from.given;
    to.set = from.set, to.fresh = from.fresh;
    const std::int64_t first = segment_size * ws.sys.input_first[i];
    carry(outer.in.set_coef + first, segment_size * from.set, ws.in.set_coef + first);
  }
  ws.in.next_knot = outer.in.next_knot, ws.in.alone = -1, ws.in.time = -infinity;
  if (!ws.started) return;
  load_inputs(ws, ws.time);
  for (int i = 0; i < ws.sys.inputs; ++i) carry_cursor(outer, ws, i);
  ws.in.n_varying = outer.in.n_varying, carry(outer.in.varying, outer.in.n_varying, ws.in.varying);
  carry(outer.in.u, ws.in.n_refs, ws.in.u), carry(outer.in.du, ws.in.n_refs, ws.in.du);
  ws.in.next_knot = outer.in.next_knot, ws.in.time = -infinity;
}

/// Signals of the run in double stand where steps have left them.
inline void move_signals(const Workspace<Single>& ws, Workspace<double>& outer) {
  load_inputs(outer, outer.time);
  for (int i = 0; i < ws.sys.inputs; ++i) carry_cursor(ws, outer, i);
  outer.in.n_varying = 0;
  for (int ref = 0; ref < outer.in.n_refs; ++ref) {
    const int i = outer.in.ref_signal[ref];
    if (i >= ws.sys.inputs) continue;
    outer.in.u[ref] = signal_value(outer, i, outer.time), outer.in.du[ref] = signal_slope(outer, i, outer.time);
    if (outer.in.signal[i].varying) outer.in.varying[outer.in.n_varying++] = ref;
  }
}

/// What stays over the steps.
inline void take_whole(const Workspace<double>& outer, Workspace<Single>& ws) {
  const Sizes n(ws.sys);
  carry(outer.params, ws.sys.n_params, ws.params);
  carry(outer.contact.compliant, n.contacts, ws.contact.compliant), carry(outer.loads.of, n.contacts, ws.loads.of);
  carry(outer.geometry.own, n.directions, ws.geometry.own);
  ws.guard.n_processes = outer.guard.n_processes;
  carry(outer.guard.process, n.processes + n.flows, ws.guard.process);
  ws.guard.n_faulty = outer.guard.n_faulty, carry(outer.guard.faulty, n.contacts, ws.guard.faulty);
  take_signals(outer, ws);
}

/// A run of single precision in the memory behind the one in double.
inline void place(Workspace<double>& outer) {
  auto* memory = static_cast<unsigned char*>(outer.fixed.image);
  const std::int64_t size = single_size(outer.sys);
  drop_fences(memory, size);
  std::memset(memory, 0, std::size_t(size));
  auto& ws = *new (memory) Workspace<Single>;
  ws.moved.outer = &outer;
  ws.row = RowLayout(outer.sys);
  carve(ws, memory + single_head + lay_numbers(ws, outer.sys, memory + single_head));
  ws.in.set_time = outer.in.set_time, ws.events.at = outer.events.at;
  carry(outer.in.ref_signal, ws.in.n_refs, ws.in.ref_signal);
}

/// The run in whose place steps are taken, as the other one stands.
inline Workspace<Single>& take_down(Workspace<double>& outer) {
  const bool anew = !outer.fixed.ready;
  if (anew) place(outer);
  auto& ws = *static_cast<Workspace<Single>*>(outer.fixed.image);
  carry_state(outer, ws), carry_history(outer.fixed, ws.fixed, Sizes(ws.sys));
  ws.options = outer.options, ws.poll = outer.poll;
  if (anew) take_whole(outer, ws);
  if (outer.params_changed) carry(outer.params, ws.sys.n_params, ws.params);
  ws.params_changed = ws.params_changed || outer.params_changed, outer.params_changed = false;
  if (!anew && outer.in.next_knot == -infinity) take_signals(outer, ws);
  return ws;
}

/// And back; its signals go where they have gone on, or were set and read.
inline void take_up(const Workspace<Single>& ws, Workspace<double>& outer) {
  carry_state(ws, outer), carry_history(ws.fixed, outer.fixed, Sizes(ws.sys));
  outer.params_changed = ws.params_changed;
  bool moved = outer.in.next_knot == -infinity && ws.in.next_knot > -infinity;
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) {
    const Signal& from = outer.in.signal[i];
    const SignalOf<Single>& to = ws.in.signal[i];
    moved = moved || from.segment != to.segment || from.idle != to.idle;
  }
  if (moved && outer.started) move_signals(ws, outer);
  outer.in.time = -infinity, outer.in.next_knot = ws.in.next_knot, outer.in.alone = -1;
  outer.fixed.ready = ws.started;
}

}  // namespace clutchwork::fixed
