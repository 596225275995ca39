#pragma once
#include <clutchwork/contacts/dependent.hpp>
#include <clutchwork/contacts/loaded_set.hpp>
#include <clutchwork/contacts/locked.hpp>
#include <clutchwork/workspace.hpp>

/// What a set of locked contacts has left, or misses, beside an instant at which its limit jumps.
/// docs/theory/events.md
namespace clutchwork {

/// What a set has left that holds any multiple of its load or none, whatever its limit: the least of what the bounds of
/// its members have left that are not reached, of the size of the load; below zero where it does not hold, infinite
/// where all are reached: others hold all of any load.
template <class T>
[[gnu::noinline]] T set_slack(Workspace<T>& ws, int k, const T* carried, const T* load) {
  const DependentSet<T> set = dependent_set(ws, k, carried, T(0));
  outer_loads(ws, k, load, carried);
  LoadedLimit<T> limit = loaded_limit(ws, set, ws.held.set_member + ws.held.set_first[k], T(0));
  const T factor = solve_loaded(limit);
  if (!(value(factor) >= 1)) return T(-1);
  // what is left of one that is reached is round-off
  const double reached = 1e-12 * value(factor * limit.size);
  T least = T(infinity);
  for (int j = set.n; j < set.n + 2 * limit.n_loads; ++j) {
    if (limit.place[j] >= 0 && value(limit.x[j]) > reached && value(limit.x[j]) < value(least)) least = limit.x[j];
  }
  return value(least) < infinity ? least / (factor * limit.size) : least;
}

/// What a set misses of its load along the way in which it gives way, at most zero [N m], by what its limit has left
/// and the price of each of its members.
template <class T, class Price>
T deficit_of(const DependentSet<T>& set, const T& room, const T& size, Price&& price) {
  T most = T(0);
  for (int i = 0; i < set.n; ++i) {
    if (abs(value(price(i))) > value(most)) most = abs(price(i));
  }
  return value(most) > 0 ? room * size / most : T(0);
}

/// The same of set k. It falls evenly where the factor jumps: of a freewheel and a contact without capacity beside it,
/// or a stop and a screw, whose load passes zero.
template <class T>
[[gnu::noinline]] T set_deficit(Workspace<T>& ws, int k, const T* carried, const T* load) {
  const DependentSet<T> set = dependent_set(ws, k, carried, T(0));
  if (ws.sys.loads == 0 || !holds_loads(ws)) {
    LimitLoad<T> limit = limit_of(ws, set);
    const T room = limit.solve() - T(1);
    return deficit_of(set, room, limit.size, [&](int i) { return limit.price[i]; });
  }
  outer_loads(ws, k, load, carried);
  LoadedLimit<T> limit = loaded_limit(ws, set, ws.held.set_member + ws.held.set_first[k], T(0));
  const T room = solve_loaded(limit) - T(1);
  return deficit_of(set, room, limit.size, [&](int i) { return limit.price_of(i); });
}

}  // namespace clutchwork
