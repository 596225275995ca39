#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// The smooth pieces on which the elements are: docs/theory/events.md, rule 12.
namespace clutchwork {

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
    ws.piece[d] = settled_piece(ws, b, PresentRates<T>(ws, b).at);
  }
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
