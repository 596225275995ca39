#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/contacts/stops.hpp>
#include <clutchwork/run/fixed/boxes.hpp>
#include <clutchwork/run/fixed/loads.hpp>
#include <clutchwork/run/fixed/prepare.hpp>

/// Contacts over one step: what each can hold, their impulses and their modes. docs/theory/fixed-steps.md
namespace clutchwork::fixed {

/// How many rounds of boxes there are at most: a contact goes from one box to the other twice, and loads settle.
inline constexpr int most_rounds = 4, most_loaded_rounds = 12;

/// What a contact holds at its present inputs.
[[gnu::noinline]] inline void find_hold(Run& ws, int c) {
  Fixed<real>& f = ws.fixed;
  const Branch<real>& b = ws.branch[ws.sys.elements + c];
  Hold<real>& hold = f.plan.hold[c];
  real* seen = f.plan.seen + ws.sys.contact_input[c];
  for (int i = 0; i < b.inputs; ++i) seen[i] = b.input[i];
  seen = f.plan.seen + ws.sys.contact_law_input[c];
  for (int i = 0; i < b.law_inputs; ++i) seen[i] = b.law_input[i];
  hold.fault = ws.contact.fault[c];
  hold.load = load_of(ws, c);
  if (ws.loads.of[c] >= 0) return;
  hold.torque[1] = static_torque(ws, c, forward);
  hold.torque[0] = f.two_sided[c] ? static_torque(ws, c, backward) : hold.torque[1];
}
CLUTCHWORK_INLINE const Hold<real>& hold_of(Run& ws, int c) {
  const Branch<real>& b = ws.branch[ws.sys.elements + c];
  const Hold<real>& hold = ws.fixed.plan.hold[c];
  const real* seen = ws.fixed.plan.seen + ws.sys.contact_input[c];
  bool same = hold.fault == ws.contact.fault[c];
  for (int i = 0; i < b.inputs; ++i) same = same && seen[i] == b.input[i];
  seen = ws.fixed.plan.seen + ws.sys.contact_law_input[c];
  for (int i = 0; i < b.law_inputs; ++i) same = same && seen[i] == b.law_input[i];
  if (!same) find_hold(ws, c);
  return hold;
}

/// Which contacts are pressed in the middle of the step.
inline void see_loads(Run& ws) {
  for (int c = 0; c < ws.sys.contacts; ++c) {
    Branch<real>& b = ws.branch[ws.sys.elements + c];
    b.pressed = hold_of(ws, c).load > 0;
    ws.contact.pressed[c] = b.pressed;
    ws.contact.loaded[c] = b.pressed || (ws.fixed.plan.blocks[c] != 0 && contact_one_way(ws, c)) ||
                           (ws.contact.fault[c] == cannot_unlock && ws.contact.mode[c] == locked);
  }
}

/// The piece of the law of a contact at a slip; and between which slips it stays there, but where it has others to
/// look at.
[[gnu::noinline]] inline void find_piece(Run& ws, int c, real size) {
  const int d = int(ws.sys.elements) + c, piece = sliding_piece(ws, d, size);
  Hold<real>& hold = ws.fixed.plan.hold[c];
  ws.piece[d] = ws.branch[d].piece = piece;
  if (is_settling_law(ws.sys.contact_law[c])) return;
  hold.low = piece > 0 ? edge_at(ws, d, piece - 1) : -infinity;
  hold.high = piece < edge_count(ws, d) ? edge_at(ws, d, piece) : infinity;
}

/// Kinetic and static torque of a contact in the middle of the step, against slip backward and forward.
/// docs/theory/fixed-steps.md (6)
inline void see_contact(Run& ws, int c) {
  Fixed<real>& f = ws.fixed;
  const int d = int(ws.sys.elements) + c, mode = ws.contact.mode[c];
  real *kinetic = f.kinetic + 2 * c, *limit = f.limit + 2 * c;
  kinetic[0] = kinetic[1] = limit[0] = limit[1] = 0;
  Branch<real>& b = ws.branch[d];
  if (!ws.contact.loaded[c]) return;
  if (ws.contact.fault[c] == cannot_unlock && mode == locked) {
    kinetic[0] = kinetic[1] = limit[0] = limit[1] = infinity;
    return;
  }
  if (!b.pressed || b.compliant) return;
  const real size = mode == locked || mode == open ? 0.0 : larger(mode * f.predicted[d], 0.0);
  const Hold<real>& hold = f.plan.hold[c];
  if (f.bends[d] == settling && !(hold.low <= size && size < hold.high)) find_piece(ws, c, size);
  if (ws.loads.of[c] >= 0) return;
  b.sign = forward;
  kinetic[1] = larger(-contact_torque(ws, b, size, ws.state, ws.observed.state_rates), 0.0);
  kinetic[0] = kinetic[1];
  limit[0] = limit[1] = larger(hold.torque[1], kinetic[1]);
  if (!f.two_sided[c]) return;
  b.sign = backward;
  kinetic[0] = larger(contact_torque(ws, b, -size, ws.state, ws.observed.state_rates), 0.0);
  limit[0] = larger(hold.torque[0], kinetic[0]);
}

/// Bounds of the impulse of a contact.
inline void set_box(Run& ws, int c, real h) {
  Fixed<real>& f = ws.fixed;
  const real *kinetic = f.kinetic + 2 * c, *limit = f.limit + 2 * c;
  auto torque = [&](int way) {
    if (f.box[c] == at_rest) return limit[way];
    // one that breaks away holds its static torque up to there
    return f.box[c] == slips_on ? kinetic[way] + f.share[c] * (limit[way] - kinetic[way]) : kinetic[way];
  };
  f.lower[c] = -h * torque(1), f.upper[c] = h * torque(0);
  const int way = f.plan.blocks[c] != 0 && ws.contact.loaded[c] ? free_way(ws, c) : 0;
  if (way > 0) f.upper[c] = h * freewheel_limit(ws, c);
  if (way < 0) f.lower[c] = -infinity;
  if (joins_prescribed(ws, c)) f.lower[c] = f.upper[c] = 0;
}

/// Where in the step a contact breaks away that was locked in the last one, -1/2 to 1/2: there the torque that would
/// hold it passes what it can hold, both as lines through the middles of the two steps. docs/theory/fixed-steps.md (8)
inline real share_at_limit(const Run& ws, int c, int way, real h) {
  const Fixed<real>& f = ws.fixed;
  if (f.before == 0 || f.time != ws.time) return 0;
  const int sign = way == 0 ? 1 : -1;
  const real needed = sign * (f.impulse[c] - f.end_slip[c] / f.mobility[c * ws.sys.contacts + c]) / h;
  const real before = sign * f.torque[ws.sys.elements + c];
  const real over = needed - f.limit[2 * c + way], rise = over - (before - f.held[2 * c + way]);
  if (!(rise > 0)) return 0;
  return larger(-0.5, smaller(0.5, 0.5 - 0.5 * (1 + f.before / h) * over / rise));
}

/// Whether a contact that ends at a bound says otherwise than its box, which may be the only one that it has.
CLUTCHWORK_INLINE bool any_may_change(const Fixed<real>& f, int ne, int nc) {
  if constexpr (!has_few_sizes) return true;
  for (int c = 0; c < nc; ++c) {
    if (f.side[c] == 0) continue;
    if (f.box[c] == sliding ? f.start_rate[ne + c] * f.end_slip[c] < 0 : f.box[c] == at_rest && f.end_slip[c] != 0)
      return true;
  }
  return false;
}

/// Contacts whose torques say otherwise than their boxes: they get the other one. Whether there are any.
/// docs/theory/fixed-steps.md, rule 3
inline bool change_boxes(Run& ws, real h) {
  Fixed<real>& f = ws.fixed;
  bool any = false;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int side = f.side[c], way = side < 0 ? 1 : 0;
    // both boxes are the same
    if (side == 0 || f.box[c] == slips_on || !(f.kinetic[2 * c + way] < f.limit[2 * c + way])) continue;
    const real start = f.start_rate[ws.sys.elements + c], end = f.end_slip[c];
    const bool breaks = f.box[c] == at_rest && end != 0, turns = f.box[c] == sliding && start * end < 0;
    if (!breaks && !turns) continue;
    if (breaks) f.share[c] = f.box[c] == at_rest && ws.contact.mode[c] == locked ? share_at_limit(ws, c, way, h) : 0;
    f.box[c] = breaks ? slips_on : at_rest;
    set_box(ws, c, h);
    any = true;
  }
  return any;
}

/// Whether all contacts slip on as they did, each far enough from rest that the little mobility of rule 1 does not
/// count: then this is the solution, which the first set that is tried would find. Loads have their bounds already.
inline bool slides_on(Run& ws) {
  Fixed<real>& f = ws.fixed;
  const int ne = int(ws.sys.elements), nc = int(ws.sys.contacts);
  for (int c = 0; c < nc; ++c) {
    const int mode = ws.contact.mode[c];
    if (mode == locked || mode == open) return false;
    const bool has_room = f.lower[c] < f.upper[c];
    f.side[c] = has_room ? -mode : 1;
    f.impulse[c] = f.side[c] < 0 ? f.lower[c] : f.upper[c];
  }
  for (int c = 0; c < nc; ++c) {
    const wide* row = wide_of(f.mobility, f.wide_mobility) + c * nc;
    wide sum = f.gradient[c];
    for (int o = 0; o < nc; ++o) sum += row[o] * f.impulse[o];
    const real slip = f.end_slip[c] = real(sum);
    if (!(f.lower[c] < f.upper[c])) continue;
    const int mode = ws.contact.mode[c];
    if (!(mode * slip > 1e-3 * real(row[c]) * abs(f.impulse[c])) || mode * f.start_rate[ne + c] < 0) return false;
  }
  ++ws.statistics.evaluations;
  return true;
}

/// At which bound each contact may be, and its little mobility of rule 1; how many are at none.
CLUTCHWORK_INLINE int guess_sides(Run& ws) {
  Fixed<real>& f = ws.fixed;
  const int nc = int(ws.sys.contacts);
  real largest = 0;
  int free = 0;
  for (int c = 0; c < nc; ++c) {
    const int mode = ws.contact.mode[c];
    // no guess is at a bound that is not there
    f.side[c] = mode == forward && f.lower[c] > -infinity ? -1 : mode == backward && f.upper[c] < infinity ? 1 : 0;
    free += f.side[c] == 0;
    const real most = larger(-f.lower[c], f.upper[c]);
    if (most < infinity) largest = larger(largest, most);
  }
  for (int c = 0; c < nc; ++c) {
    const real own = larger(-f.lower[c], f.upper[c]);
    const real ratio = own > 0 && own < largest ? smaller(largest / own, 1e6) : 1;
    f.weight[c] = 1e-10 * f.mobility[c * nc + c] * ratio;
  }
  return free;
}

/// Impulses of contacts that are all at a bound.
CLUTCHWORK_INLINE void take_sides(Fixed<real>& f, int nc) {
  for (int c = 0; c < nc; ++c) f.impulse[c] = f.side[c] < 0 ? f.lower[c] : f.upper[c];
}

/// The problem of all contacts.
CLUTCHWORK_INLINE Boxes boxes_of(Run& ws) {
  Fixed<real>& f = ws.fixed;
  return {int(ws.sys.contacts),
          wide_of(f.mobility, f.wide_mobility),
          f.gradient,
          f.lower,
          f.upper,
          f.weight,
          wide_of(f.impulse, f.wide_impulse),
          wide_of(f.end_slip, f.wide_slip),
          f.side,
          wide_of(f.solved, f.wide_solved),
          wide_of(f.free_factor, f.wide_free),
          f.list};
}

/// Impulses of all contacts, for slips at the end without them in `gradient`. False: they were not found.
inline bool find_impulses(Run& ws, real h, real tolerance) {
  Fixed<real>& f = ws.fixed;
  const int nc = int(ws.sys.contacts), rounds = ws.sys.loads > 0 ? most_loaded_rounds : most_rounds;
  for (int c = 0; c < nc; ++c) {
    f.box[c] = ws.contact.mode[c] == locked || ws.contact.mode[c] == open ? at_rest : sliding;
    set_box(ws, c, h);
  }
  const bool found = ws.sys.loads > 0 && slip_with_load(ws, h);
  if ((found || ws.sys.loads == 0) && f.plan.n_rigid == 0 && slides_on(ws)) return true;
  if (ws.sys.loads > 0 && !found) begin_loads(ws, h);
  const int free = guess_sides(ws);
  const Boxes boxes = boxes_of(ws);
  // where all contacts slip, bounds follow their loads before the first solution
  if (ws.sys.loads > 1 && free == 0 && f.plan.n_rigid == 0) {
    take_sides(f, nc);
    follow_loads(ws, boxes, h, tolerance);
  }
  for (int round = 0; round < rounds; ++round) {
    for (int c = 0; c < nc; ++c) {
      if (!(f.lower[c] < f.upper[c])) f.side[c] = 1;
    }
    const int tried = solve(boxes);
    if (tried < 0) return false;
    keep_rounded(boxes.x, nc, f.impulse), keep_rounded(boxes.slope, nc, f.end_slip);
    ws.statistics.evaluations += tried;
    const bool changed = any_may_change(f, int(ws.sys.elements), nc) && change_boxes(ws, h);
    if (!(ws.sys.loads > 0 && follow_loads(ws, boxes, h, tolerance)) && !changed) return true;
  }
  // boxes that go on changing have one answer or the other; loads must have found theirs
  return ws.sys.loads == 0 || f.load_miss < 1e-3;
}

/// Whether the slip of a contact that ends at a bound is none: what a load of round-off holds, or, in single precision,
/// round-off of the sum that the slip is.
CLUTCHWORK_INLINE bool is_slip_of_noise(const Run& ws, int c, real tolerance) {
  const Fixed<real>& f = ws.fixed;
  if constexpr (!NumberOf<real>::single) return ws.sys.loads > 0 && abs(f.end_slip[c]) <= tolerance;
  const int nc = int(ws.sys.contacts);
  real size = abs(f.gradient[c]);
  for (int o = 0; o < nc; ++o) size += abs(f.mobility[c * nc + o] * f.impulse[o]);
  // some units of its last place
  return abs(f.end_slip[c]) <= real(0x1p-21) * size;
}

/// Mode of a contact behind the step.
inline int mode_behind(const Run& ws, int c, real tolerance) {
  const Fixed<real>& f = ws.fixed;
  const int mode = ws.contact.mode[c];
  // one that has no load stays closed until it is left
  if (is_stop(ws, c)) return ws.contact.loaded[c] && free_way(ws, c) * f.end_slip[c] <= tolerance ? locked : open;
  if (ws.contact.compliant[c] && !contact_one_way(ws, c)) return mode;
  const real slip = f.end_slip[c];
  if (joins_prescribed(ws, c) || !ws.contact.loaded[c]) {
    if (abs(slip) > tolerance) return slip > 0 ? forward : backward;
    return ws.contact.loaded[c] ? locked : mode == locked ? open : mode;
  }
  if (f.side[c] == 0 || is_slip_of_noise(ws, c, tolerance)) return locked;
  return f.lower[c] < f.upper[c] ? -f.side[c] : slip > 0 ? forward : backward;
}

/// Where in the step a contact comes to rest or turns: by its slip with the kinetic torque alone.
/// docs/theory/fixed-steps.md (7)
inline real share_at_zero(const Run& ws, int c, real h) {
  const Fixed<real>& f = ws.fixed;
  const int nc = int(ws.sys.contacts), way = f.start_rate[ws.sys.elements + c] > 0 ? 1 : 0;
  const real start = f.start_rate[ws.sys.elements + c];
  const real alone = (way ? -1 : 1) * h * f.kinetic[2 * c + way];
  const real end = f.end_slip[c] + f.mobility[c * nc + c] * (alone - f.impulse[c]);
  if (start == 0 || !(start * end < 0)) return 1;
  return start / (start - end);
}

}  // namespace clutchwork::fixed
