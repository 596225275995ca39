#pragma once
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/run/fixed/prepare.hpp>
#include <clutchwork/run/processes.hpp>

/// Pieces that elements, laws and processes leave by their own states: at the ends of steps.
/// docs/theory/fixed-steps.md, rule 4
namespace clutchwork::fixed {

/// How many pieces one component may pass in a step.
inline constexpr int most_passed = 4;

/// The piece of a switching branch at the present state; what round-off makes of a shaft at rest is no rate.
inline void cross_branch(Run& ws, Branch<real>& b) {
  PresentRates<real> rate(ws, b);
  const real tolerance = slip_tolerance(ws);
  for (int i = 0; i < b.ways; ++i) {
    if (abs(rate.at[i]) <= tolerance) rate.at[i] = 0;
  }
  const real still[most_ways] = {};
  int& heading = ws.heading[b.direction];
  b.piece = ws.piece[b.direction];
  const int now = rate.at[0] < 0 ? backward : forward;
  if (now != heading && rate.at[0] != 0) {
    if (law_turns(b)) leave_piece(ws, b, rate.at, turned);
    heading = now;
  }
  const int d = b.direction, edges = edge_count(ws, d);
  if (edges > 0) b.piece += piece_of(ws, d, rate.at[0]) - b.piece % (edges + 1);
  b.piece = settled_piece(ws, b, rate.at);
  for (int round = 0; round < most_passed; ++round) {
    int who = 0;
    if (law_margin(ws, b, rate.at, still, ws.state, ws.observed.state_rates, who).v >= 0) break;
    leave_piece(ws, b, rate.at, who);
  }
  ws.piece[b.direction] = b.piece;
}

/// All of them behind a step.
inline void cross_pieces(Run& ws) {
  const auto& sys = ws.sys;
  for (int k = 0; k < ws.fixed.plan.n_crossing; ++k) cross_branch(ws, ws.branch[ws.fixed.plan.crossing[k]]);
  if (sys.shared == 0) return;
  shared_inputs(ws, ws.state);
  if (ws.guard.n_processes > 0) find_process_pieces(ws);
}

}  // namespace clutchwork::fixed
