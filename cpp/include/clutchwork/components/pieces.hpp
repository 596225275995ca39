#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/workspace.hpp>

/// The smooth pieces of elements and laws: kinks over the rate, and those that change by their own states.
namespace clutchwork {

/// Call f with the component that rules the pieces of a branch: its element, or its law.
template <class T, class F>
decltype(auto) visit_branch(const Branch<T>& b, F&& f) {
  if (b.law < 0)
    return visit_torque(b.kind, [&](auto tag) { return f(tag, b.params, b.input, b.input_slope, b.inputs); });
  return visit_law(b.law, [&](auto tag) { return f(tag, b.law_params, b.law_input, b.law_input_slope, b.law_inputs); });
}

/// How far the law of a switching branch is from leaving its piece, and its time derivative; `who` would leave. Rates
/// and their slopes are those of all its ways.
template <class T>
Dual<T, 1> law_margin(const Workspace<T>& ws, const Branch<T>& b, const T* rate, const T* slope, const T* state,
                      const T* rates, int& who) {
  using S = Dual<T, 1>;
  return visit_branch(b, [&](auto tag, const T* params, const T* inputs, const T* input_slopes, int n) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
      S x[most_ways], own[L::states > 0 ? L::states : 1], input[most_inputs];
      for (int i = 0; i < b.ways; ++i) x[i] = S(rate[i]), x[i].d[0] = slope[i];
      for (int i = 0; i < b.states; ++i) own[i] = S(state[b.state + i]), own[i].d[0] = rates[b.state + i];
      dual_inputs<1>(n, inputs, input_slopes, input);
      return L::margin(p, At<S>{x[0], own, input, b.piece, points_of(ws), x}, who);
    }
    return S(1);
  });
}

/// Take the law of a switching branch to its next piece; returns it and moves the states where the law says so.
template <class T>
int law_cross(const Workspace<T>& ws, const Branch<T>& b, const T* rate, int who, T* state) {
  return visit_branch(b, [&](auto tag, const T* params, const T* inputs, const T*, int) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
      const At<T> at{rate[0], state + b.state, inputs, b.piece, points_of(ws), rate};
      return L::cross(p, at, who, state + b.state);
    }
    return b.piece;
  });
}

/// Energy that a switching branch lets go where it leaves its piece [J].
template <class T>
T law_freed(const Workspace<T>& ws, const Branch<T>& b, const T* rate, int who, const T* state) {
  return visit_branch(b, [&](auto tag, const T* params, const T* inputs, const T*, int) {
    using E = typename decltype(tag)::type;
    if constexpr (Freeing<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
      return E::freed(p, At<T>{rate[0], state + b.state, inputs, b.piece, points_of(ws), rate}, who);
    }
    return T(0);
  });
}

/// The piece in which a switching element or law is where it is now.
template <class T>
int settled_piece(const Workspace<T>& ws, const Branch<T>& b, const T* rate) {
  return visit_branch(b, [&](auto tag, const T* params, const T* inputs, const T*, int) {
    using E = typename decltype(tag)::type;
    if constexpr (Settling<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
      return E::settle(p, At<T>{rate[0], ws.state + b.state, inputs, b.piece, points_of(ws), rate});
    }
    return b.piece;
  });
}

/// Rate at which a switching element oscillates by itself [1/s].
template <class T>
Real<T> own_pace(const Workspace<T>& ws, const Branch<T>& b, T rate) {
  return visit_torque(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (Paced<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
      return value(E::pace(p, At<T>{rate, ws.state + b.state, b.input, b.piece, points_of(ws)}));
    }
    return Real<T>(0);
  });
}
inline bool is_settling(int kind) {
  return visit_torque(kind, [](auto tag) { return Settling<typename decltype(tag)::type>; });
}

/// Whether a change of sign of the slip matters to the law of a branch now.
template <class T>
bool law_turns(const Branch<T>& b) {
  if (b.ways == 0) return false;
  return visit_branch(b, [&](auto tag, const T* params, const T*, const T*, int) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      return L::turns(*reinterpret_cast<const typename L::template Params<T>*>(params), b.piece);
    }
    return false;
  });
}

/// Whether a state that has just crossed goes on the way it points; one that is on its way back does not.
template <class T>
bool law_runs_on(const Branch<T>& b, int who) {
  return visit_branch(b, [&](auto tag, const T*, const T*, const T*, int) {
    using L = typename decltype(tag)::type;
    if constexpr (RunningOn<L>) return L::runs_on(b.piece, who);
    return true;
  });
}

/// Whether an element or a law switches between pieces.
template <class T>
bool is_switching(const Branch<T>& b) {
  if (b.ways == 0) return false;
  return visit_branch(
      b, [&](auto tag, const T*, const T*, const T*, int) { return SwitchingLaw<typename decltype(tag)::type>; });
}

/// Room that the law of a contact has inside its tables at a slip; below zero it has left one, and `seen` is what did.
template <class T>
T table_room(const Workspace<T>& ws, int c, T slip, T& seen) {
  const auto& sys = ws.sys;
  return visit_law(sys.contact_law[c], [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (BoundedLaw<L>) {
      const T* params = ws.params + sys.contact_law_param[c];
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
      return L::outside(p, At<T>{abs(slip), nullptr, ws.in.u + sys.contact_law_input[c], 0, points_of(ws)}, seen);
    }
    return T(1);
  });
}
inline bool is_bounded_law(int law) {
  return visit_law(law, [](auto tag) { return BoundedLaw<typename decltype(tag)::type>; });
}

/// Whether a law jumps with the sign of the slip.
inline bool is_chattering_law(int law) {
  return visit_law(law, [](auto tag) { return ChatteringLaw<typename decltype(tag)::type>; });
}

/// Number of kinks of the function behind a direction, over its rate or its slip.
template <class T>
int edge_count(const Workspace<T>& ws, int direction) {
  const auto& sys = ws.sys;
  auto count = [&](auto tag, const T* params) {
    using E = typename decltype(tag)::type;
    if constexpr (Kinked<E>) {
      return E::edges(*reinterpret_cast<const typename E::template Params<T>*>(params));
    } else {
      return 0;
    }
  };
  if (direction < sys.elements) {
    if (sys.element_way[direction] != 0) return 0;
    return visit_torque(sys.element_kind[direction],
                        [&](auto tag) { return count(tag, ws.params + sys.element_param[direction]); });
  }
  const int c = direction - int(sys.elements);
  if (is_loaded(sys.contact_kind[c]))
    return visit_contact(sys.contact_kind[c], [&](auto tag) { return count(tag, ws.params + sys.contact_param[c]); });
  return visit_law(sys.contact_law[c], [&](auto tag) { return count(tag, ws.params + sys.contact_law_param[c]); });
}

/// A kink of a component, with its derivatives where it says them.
template <class E, class P, class T>
T edge_of(const P& p, const Workspace<T>& ws, int i) {
  if constexpr (requires {
                  { E::edge(p, points_of(ws), i) } -> std::same_as<T>;
                }) {
    return E::edge(p, points_of(ws), i);
  } else {
    return T(E::edge(p, ws.sys.points, i));
  }
}

/// Kink number i of the function behind a direction.
template <class T>
T edge_at(const Workspace<T>& ws, int direction, int i) {
  const auto& sys = ws.sys;
  auto at = [&](auto tag, const T* params) {
    using E = typename decltype(tag)::type;
    if constexpr (Kinked<E>) {
      return edge_of<E>(*reinterpret_cast<const typename E::template Params<T>*>(params), ws, i);
    } else {
      return T(0);
    }
  };
  if (direction < sys.elements) {
    return visit_torque(sys.element_kind[direction],
                        [&](auto tag) { return at(tag, ws.params + sys.element_param[direction]); });
  }
  const int c = direction - int(sys.elements);
  if (is_loaded(sys.contact_kind[c]))
    return visit_contact(sys.contact_kind[c], [&](auto tag) { return at(tag, ws.params + sys.contact_param[c]); });
  return visit_law(sys.contact_law[c], [&](auto tag) { return at(tag, ws.params + sys.contact_law_param[c]); });
}

inline bool is_settling_law(int law) {
  return visit_law(law, [](auto tag) { return Settling<typename decltype(tag)::type>; });
}

/// The piece that holds x; at a kink the one above.
template <class T>
int piece_of(const Workspace<T>& ws, int direction, Real<T> x) {
  int low = 0, high = edge_count(ws, direction);
  while (low < high) {
    const int middle = (low + high) / 2;
    if (value(edge_at(ws, direction, middle)) <= x) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// The piece of a contact whose law sticks, at a slip.
template <class T>
int sliding_piece(const Workspace<T>& ws, int direction, Real<T> slip) {
  const int interval = piece_of(ws, direction, slip);
  if (!is_settling_law(ws.sys.contact_law[direction - ws.sys.elements])) return interval;
  Branch<T> b = make_branch(ws, direction, forward);
  const T rate[] = {T(slip)};
  b.piece = interval;
  return settled_piece(ws, b, rate);
}

}  // namespace clutchwork
