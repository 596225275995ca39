#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// The smooth pieces on which the elements are: docs/theory/events.md, rule 12.
namespace clutchwork {

/// Rate of element d as its pieces see it: what is at a kink to what counts as zero is exactly there.
/// docs/theory/events.md, rule 17
template <class T>
T rate_at_kinks(const Workspace<T>& ws, int d, double zero) {
  const T rate = rate_of(ws, d);
  const int below = piece_of(ws, d, value(rate) + zero) - 1;
  if (below < 0) return rate;
  const T kink = edge_at(ws, d, below);
  return abs(value(rate) - value(kink)) <= zero ? kink : rate;
}

/// The elements are on the pieces that hold their rates, states and inputs: at a kink, to what counts as zero, on the
/// one above, for what jumps there must not follow round-off. docs/theory/events.md, rule 17
template <class T>
void find_pieces(Workspace<T>& ws) {
  const double zero = slip_tolerance(ws);
  for (int d = 0; d < ws.sys.elements; ++d) {
    if (ws.sys.element_way[d] != 0) continue;
    const int edges = edge_count(ws, d);
    if (edges > 0) ws.piece[d] += piece_of(ws, d, value(rate_of(ws, d)) + zero) - ws.piece[d] % (edges + 1);
    if (!is_settling(ws.sys.element_kind[d])) continue;
    const Branch<T> b = make_branch(ws, d, 0);
    PresentRates<T> rate(ws, b);
    if (edges > 0 && b.ways == 1) rate.at[0] = rate_at_kinks(ws, d, zero);
    ws.piece[d] = settled_piece(ws, b, rate.at);
  }
}

/// Whether element d has one way, and kinks at which its torque may jump.
template <class T>
bool may_jump(const Workspace<T>& ws, int d) {
  return d < ws.sys.elements && ws.sys.element_way[d] == 0 && ways_of(ws.sys.element_kind[d]) == 1 &&
         edge_count(ws, d) > 0;
}

/// Whether the torque of an element jumps between two of its pieces at the present rate, or right beside it: at rest
/// both may have that of rest.
template <class T>
bool jumps_between(Workspace<T>& ws, int d, int piece, int side) {
  Branch<T> b = make_branch(ws, d, 0);
  auto jumps = [&](const T& rate, double least) {
    auto torque = [&](int at) {
      b.piece = at;
      // what else of its piece follows the torque there
      if (at != piece && is_settling(b.kind)) b.piece = law_cross(ws, b, &rate, turned, ws.state);
      return value(branch_torque_once(ws, b, rate, ws.state, ws.observed.state_rates));
    };
    const double here = torque(piece), there = torque(piece + side);
    return abs(there - here) > least * larger(abs(here), abs(there));
  };
  const T rate = rate_of(ws, d);
  return jumps(rate, 1e-9) || jumps(rate + T(side * slip_tolerance(ws)), 1e-6);
}

/// Whether an element stays at a kink, to what counts as zero, on the piece below it, where the one above has another
/// torque: nothing but round-off says on which side it is. docs/theory/events.md, rule 17
template <class T>
bool stays_below_jump(Workspace<T>& ws) {
  // what does not leave within a second stays
  const double zero = slip_tolerance(ws);
  for (int d = 0; d < ws.sys.elements; ++d) {
    const int k = ws.branch_of[d];
    if (!may_jump(ws, d) || k < 0 || k >= ws.n_branches || abs(value(ws.step_start.slope[k])) > zero) continue;
    const int edges = edge_count(ws, d), above = ws.piece[d] % (edges + 1);
    if (above == edges || abs(value(rate_of(ws, d)) - value(edge_at(ws, d, above))) > zero) continue;
    if (jumps_between(ws, d, ws.piece[d], 1)) return true;
  }
  return false;
}

/// Locked contacts whose laws have pieces are on those that hold what they see now.
template <class T>
void settle_locked(Workspace<T>& ws) {
  const T still[most_ways] = {};
  for (int i = 0; i < ws.guard.n_bending; ++i) {
    const int d = int(ws.sys.elements) + ws.guard.bending[i];
    ws.piece[d] = settled_piece(ws, make_branch(ws, d, forward), still);
  }
}

/// The same inside a phase, where inputs have jumped and rates have not. Whether an element goes to another piece.
template <class T>
bool settle_pieces(Workspace<T>& ws) {
  bool any = false;
  for (int i = 0; i < ws.guard.n_switching; ++i) {
    Branch<T>& b = ws.branch[ws.guard.switching[i]];
    const int piece = settled_piece(ws, b, PresentRates<T>(ws, b).at);
    any = any || piece != b.piece;
    ws.piece[b.direction] = b.piece = piece;
  }
  settle_locked(ws);
  return any;
}

}  // namespace clutchwork
