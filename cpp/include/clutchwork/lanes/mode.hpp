#pragma once
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/lanes/workspace.hpp>
#include <clutchwork/motion/reduce.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>

/// Which runs can step together: docs/theory/lanes.md.
namespace clutchwork {

inline constexpr int lane_speeds = small_speeds, lane_states = small_states;  ///< most, of what steps together

/// Whether the torque of a branch computes with lanes.
inline bool computes_with_lanes(const Branch<double>& b) {
  if (b.compliant || b.shaped) return false;
  if (b.law < 0)
    return visit_torque(b.kind, [](auto tag) { return computes_with<typename decltype(tag)::type, Lanes<2>>; });
  return visit_contact(b.kind, [](auto tag) { return computes_with<typename decltype(tag)::type, Lanes<2>>; }) &&
         visit_law(b.law, [](auto tag) { return computes_with<typename decltype(tag)::type, Lanes<2>>; });
}

/// Whether the capacity of a locked contact does.
inline bool holds_with_lanes(const Workspace<double>& ws, int c) {
  return !is_rigid(ws, c) && !ws.contact.compliant[c] && visit_contact(ws.sys.contact_kind[c], [](auto tag) {
    using E = typename decltype(tag)::type;
    return computes_with<E, Lanes<2>> && !ShapedContact<E> && !LimitedContact<E>;
  }) && visit_law(ws.sys.contact_law[c], [](auto tag) {
    return computes_with<typename decltype(tag)::type, Lanes<2>>;
  });
}

/// Whether the present phase of a run can step in a lane.
inline bool may_share(const Workspace<double>& ws) {
  const Guards& g = ws.guard;
  if (ws.reduced.is_sparse || ws.reduced.method != Rodas5P::method || ws.reduced.nz < 1 ||
      ws.reduced.nz > lane_speeds || ws.sys.states > lane_states)
    return false;
  if (g.n_switching + g.n_chattering + g.n_bounded + g.n_faulty + g.n_loads + g.n_gaps + g.n_processes + g.n_bending >
      0)
    return false;
  if (ws.held.n_sets + ws.held.n_driven > 0) return false;
  // the work of prescribed speeds asks for shorter steps
  if (ws.sys.prescribed > 0 && ws.options.work) return false;
  for (int k = 0; k < ws.n_branches; ++k)
    if (!computes_with_lanes(ws.branch[k])) return false;
  for (int a = 0; a < ws.held.n; ++a)
    if (!holds_with_lanes(ws, ws.held.contact[a])) return false;
  return true;
}

/// Whether a run is in the mode of another one, or of lanes, with the same structure: what a step reads of one is at
/// the same place in the other.
template <class W>
bool same_mode(const W& a, const Workspace<double>& b) {
  if (a.reduced.nz != b.reduced.nz || a.n_branches != b.n_branches || a.n_rates != b.n_rates || a.held.n != b.held.n ||
      a.guard.n_lines != b.guard.n_lines || a.guard.n_undirected != b.guard.n_undirected)
    return false;
  for (int k = 0; k < a.n_rates; ++k) {
    const auto& x = a.branch[k];
    const auto& y = b.branch[k];
    if (x.direction != y.direction || x.sign != y.sign || x.piece != y.piece || x.pressed != y.pressed) return false;
  }
  for (int i = 0; i < a.held.n; ++i)
    if (a.held.contact[i] != b.held.contact[i]) return false;
  for (int i = 0; i < a.guard.n_lines; ++i)
    if (a.guard.line[i].branch != b.guard.line[i].branch) return false;
  for (int c = 0; c < a.sys.contacts; ++c)
    if (a.contact.fault[c] != b.contact.fault[c]) return false;
  return true;
}

}  // namespace clutchwork
