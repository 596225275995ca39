#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/impulses.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/branches.hpp>
#include <clutchwork/motion/reduce.hpp>
#include <clutchwork/motion/sparse.hpp>
#include <clutchwork/run/guards/list.hpp>
#include <clutchwork/run/methods.hpp>
#include <clutchwork/run/processes.hpp>
#include <clutchwork/run/settle.hpp>
#include <clutchwork/run/stiffness.hpp>
#include <clutchwork/run/watch.hpp>
#include <clutchwork/workspace.hpp>

/// The motion of the present modes, made ready for a phase.
namespace clutchwork {

/// Whether some speed has no inertia and is algebraic.
template <class T>
bool has_massless(const Workspace<T>& ws) {
  for (int i = 0; i < ws.sys.speeds; ++i) {
    if (ws.sys.massless[i] != 0) return true;
  }
  return false;
}

/// Whether the coefficient of a sliding contact depends on its slip where that is about to vanish.
template <class T>
bool bends_near_zero(const Workspace<T>& ws, const Branch<T>& b, const StatePartials<T>& out) {
  const T slip = T(1e-6 * b.sign);
  return value(branch_partial(ws, b, slip, T(0), ws.state, ws.observed.state_rates, out).by_rate) != 0;
}

/// Whether the present phase changes by itself so slowly that steps follow what acts on it. Where it swings within
/// them, the implicit method takes less than half of the explicit steps and is ahead of them.
/// docs/theory/integrators.md
template <class T>
bool is_soft(Workspace<T>& ws) {
  constexpr double slow = 0.1;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    // its reversals are found within a few implicit steps
    if (b.law >= 0 && is_chattering_law(b.law)) return false;
    // a step may run over the rise of a coefficient before the slip vanishes, unseen by the estimate of an explicit
    // pair
    if (b.law >= 0 && b.states == 0 && bends_near_zero(ws, b, state_partials(ws, k))) return false;
    ws.jacobian.partial[k] =
        branch_partial(ws, b, rate_of(ws, b.direction), T(0), ws.state, ws.observed.state_rates, state_partials(ws, k));
  }
  return fastest_rate(ws) * (ws.last_step > 0 ? ws.last_step : 1e-3) < slow;
}

/// The method of the present phase: the one that is wanted, else the first of those that are made for such a motion.
template <class T>
Method choose_method(Workspace<T>& ws) {
  if constexpr (has_tangents<T>) return first_method(true);
  const Method wanted = ws.options.method == Method::fixed ? Method::auto_ : ws.options.method;
  // speeds without inertia are algebraic: only a method for stiff motion carries them
  if (has_massless(ws)) return is_for_stiff(wanted) ? wanted : first_method(true);
  if (wanted != Method::auto_) return wanted;
  // shared states may be stiff, and so may what several ways couple
  return first_method(ws.sys.full[0] != 0 || ws.sys.shared > 0 || !is_soft(ws));
}

/// Contacts without load forget: the bristles of their laws are straight when they close again.
template <class T>
void relax_open(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  for (int c = 0; c < sys.contacts; ++c) {
    if (!ws.contact.compliant[c] || ws.contact.pressed[c]) continue;
    const int n = states_of(sys.contact_kind[c], sys.contact_law[c], ws.params + sys.contact_law_param[c]);
    for (int i = 0; i < n; ++i) ws.state[sys.contact_state[c] + i] = T(0);
    ws.piece[sys.elements + c] = 0;
  }
}

/// Laws whose slip has jumped to the other sign notice it.
template <class T>
void turn_jumped(Workspace<T>& ws) {
  for (int i = 0; i < ws.guard.n_switching; ++i) {
    Branch<T>& b = ws.branch[ws.guard.switching[i]];
    const T rate = rate_of(ws, b.direction);
    const int heading = value(rate) > 0 ? forward : backward;
    if (abs(value(rate)) <= slip_tolerance(ws) || heading == ws.heading[b.direction] || !law_turns(b)) continue;
    leave_piece(ws, b, PresentRates<T>(ws, b).at, turned);
    ws.piece[b.direction] = b.piece;
    ws.heading[b.direction] = heading;
  }
}

/// Reduced coordinates: dense up to a handful of speeds and states, else sparse. False: they cannot be made.
template <class T>
bool reduce_motion(Workspace<T>& ws) {
  const bool few = is_few(ws.sys);
  map_prescribed(ws);
  if (ws.sys.loads > 0) map_loads(ws);
  ws.held.mapped = few && !ws.reduced.is_sparse;
  if (ws.held.mapped) map_multipliers(ws);
  if (few && ws.reduced.is_sparse && !eliminate_locked(ws)) return false;
  if (!ws.reduced.is_sparse && few) reduce_dense(ws);
  if (!ws.reduced.is_sparse && !few && !reduce_to_few(ws)) return false;
  reduce_rates(ws);
  if (ws.reduced.is_sparse && !reduce_sparse(ws)) return false;
  for (int i = 0; i < ws.sys.states; ++i) ws.reduced.y[ws.reduced.nz + i] = ws.state[i];
  return true;
}

/// Which reduced speeds there are: for many from sparse elimination, for few from a split of the directions.
template <class T>
bool count_reduced(Workspace<T>& ws) {
  if (!is_few(ws.sys)) return eliminate_locked(ws);
  ws.reduced.rank = split_locked(ws);
  ws.reduced.nz = int(ws.sys.speeds) - ws.reduced.rank;
  return true;
}

/// The locked contacts, sorted by what transmissions leave of their directions.
template <class T>
void list_locked_now(Workspace<T>& ws, bool again) {
  const BesideRatios<T> beside(ws, again ? Written::last : Written::now);
  list_locked(ws, again);
  for (int a = 0; a < ws.ratios.n; ++a) ws.ratios.turned[a] = ws.ratios.present[a] = ws.ratios.value[a];
}

/// Reduced motion of the present modes; the state goes to ws.reduced.y. False: the inertias differ too much to tell
/// them apart. `again`: the phase has begun before, and its locked contacts are sorted by the ratios of that instant.
template <class T>
bool enter_mode(Workspace<T>& ws, bool again = false) {
  const auto& sys = ws.sys;
  // the pieces and headings of a phase that goes on are its own
  if (!again) relax_open(ws);
  list_locked_now(ws, again);
  pack_branches(ws);
  list_laws(ws);
  watch_guards(ws);
  if (!again) turn_jumped(ws), settle_locked(ws);
  if (ws.held.too_many || !count_reduced(ws)) return false;
  ws.reduced.method = choose_method(ws);
  ws.reduced.is_sparse = !has_small_forms || has_tangents<T> || sys.full[0] != 0 ||
                         sys.states > most_small_states(ws.reduced.method) || sys.shared > 0 || ws.reduced.nz < 1 ||
                         ws.reduced.nz > small_speeds || has_massless(ws);
  if (!factor_mobility(ws) || !reduce_motion(ws)) return false;
  list_lines(ws);
  ++ws.statistics.phases;
  return true;
}

}  // namespace clutchwork
