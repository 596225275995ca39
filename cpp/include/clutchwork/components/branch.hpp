#pragma once
#include <clutchwork/workspace.hpp>

/// Torque of one branch and its derivatives; the only place where components are called.
namespace clutchwork {

/// Number of own states of a torque element (law < 0) or of a contact, which are those of its law.
template <class T>
int states_of(int kind, int law, const T* law_params) {
  if (law < 0) return visit_torque(kind, [](auto tag) { return decltype(tag)::type::states; });
  return visit_law(law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (SizedLaw<L>) return L::count(*reinterpret_cast<const typename L::template Params<T>*>(law_params));
    return int(L::states);
  });
}

/// Most states of a law.
inline int most_law_states(int law) {
  return visit_law(law, [](auto tag) { return int(decltype(tag)::type::states); });
}

/// Inputs of a torque element, a contact or a law.
inline int element_inputs(int kind) {
  return visit_torque(kind, [](auto tag) { return int(decltype(tag)::type::inputs); });
}
inline int contact_inputs(int kind) {
  return visit_contact(kind, [](auto tag) { return int(decltype(tag)::type::inputs); });
}
inline int law_inputs_of(int law) {
  return visit_law(law, [](auto tag) { return law_inputs<typename decltype(tag)::type>(); });
}
inline bool is_shaped(int kind) {
  return visit_contact(kind, [](auto tag) { return ShapedContact<typename decltype(tag)::type>; });
}

/// Whether a law never sticks.
inline bool is_compliant_law(int law) {
  return visit_law(law, [](auto tag) { return CompliantLaw<typename decltype(tag)::type>; });
}

/// Load of a contact at the given inputs, negative where the clamp is relieved.
template <class T, class S>
CLUTCHWORK_INLINE S contact_load(int kind, const T* params, const S* input, const double* points) {
  return visit_contact(kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
    return E::load(p, At<S>{S(0), nullptr, input, 0, points});
  });
}

/// Torque per load of a contact whose law gives the coefficient mu, slipping in a direction.
template <class T, class S>
CLUTCHWORK_INLINE S contact_gain(int kind, const T* params, const S& mu, int direction) {
  return visit_contact(kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (ShapedContact<E>)
      return E::gain(*reinterpret_cast<const typename E::template Params<T>*>(params), mu, direction);
    return mu;
  });
}

/// Static coefficient of a law.
template <class T>
CLUTCHWORK_INLINE T law_hold(int law, const T* params, const T* input, const double* points) {
  return visit_law(law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
    return L::hold(p, At<T>{T(0), nullptr, input, 0, points});
  });
}

/// Static torque of a contact that resists slip in a direction, not negative.
template <class T>
T contact_limit(const System& sys, int c, const T* params, const T* input, const T* law_input, int direction) {
  const T* own = params + sys.contact_param[c];
  const T hold = law_hold(sys.contact_law[c], params + sys.contact_law_param[c], law_input, sys.points);
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(own);
    const At<T> at{T(0), nullptr, input, 0, sys.points};
    if constexpr (LimitedContact<E>) {
      return larger(E::limit(p, at, hold, direction), T(0));
    } else {
      const T load = larger(E::load(p, at), T(0));
      if constexpr (ShapedContact<E>) return load * E::gain(p, hold, direction);
      return load * hold;
    }
  });
}

template <class T>
CLUTCHWORK_INLINE bool contact_one_way(const Workspace<T>& ws, int c) {
  if (ws.contact.fault[c] == cannot_transmit) return false;
  return visit_contact(ws.sys.contact_kind[c], [](auto tag) { return decltype(tag)::type::one_way; });
}

/// What a freewheel holds before it gives way [N m].
template <class T>
T freewheel_limit(const Workspace<T>& ws, int c) {
  return visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (YieldingContact<E>)
      return E::holding(*reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.contact_param[c]));
    return T(infinity);
  });
}

/// Room for numbers that are set before they are read.
template <class S, int N>
union Slots {
  S at[N];
  Slots() {}
};

/// Inputs as dual numbers over time, the last of N directions.
template <int N, class S, class T>
CLUTCHWORK_INLINE void dual_inputs(int count, const T* input, const T* slope, S* out) {
  for (int i = 0; i < count; ++i) {
    out[i] = S(input[i]);
    out[i].d[N - 1] = slope[i];
  }
}

/// Torque of a sliding contact with a law that sticks, on its follower.
template <class T, class S>
CLUTCHWORK_INLINE S sliding_torque(const Workspace<T>& ws, const Branch<T>& b, const S& rate, const S* input,
                                   const S* law_input) {
  // beyond its zero, at which the step will end, the load goes on as it falls
  const S load = b.pressed ? contact_load<T, S>(b.kind, b.params, input, ws.sys.points) : S(0);
  S coefficient = visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (StickingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      return L::slide(p, At<S>{T(b.sign) * rate, nullptr, law_input, b.piece, ws.sys.points});
    }
    return S(0);
  });
  if (b.shaped) [[unlikely]]
    coefficient = contact_gain<T, S>(b.kind, b.params, coefficient, b.sign);
  return T(-b.sign) * load * coefficient;
}

/// Torque of a contact whose law never sticks; the rates of its states, at most Room, go to `rates`.
template <int Room, class T, class S>
CLUTCHWORK_INLINE S bending_torque(const Workspace<T>& ws, const Branch<T>& b, const S& rate, const S* own,
                                   const S* input, const S* law_input, S* rates) {
  // beyond its zero, at which the step will end, the load goes on as it falls
  const S load = b.pressed ? contact_load<T, S>(b.kind, b.params, input, ws.sys.points) : S(0);
  S coefficient = visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (CompliantLaw<L> && L::states <= Room) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      const At<S> at{rate, own, law_input, b.piece, ws.sys.points};
      if constexpr (L::states > 0) L::state_rates(p, at, rates);
      return L::coefficient(p, at);
    }
    return S(0);
  });
  if (b.shaped) {
    const int side = value(coefficient) < 0 ? -1 : 1;
    coefficient = contact_gain<T, S>(b.kind, b.params, coefficient * T(side), side) * T(side);
  }
  return -load * coefficient;
}

template <class T>
[[gnu::noinline]] T compliant_torque(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  return bending_torque<most_own_states, T, T>(ws, b, rate, state + b.state, b.input, b.law_input, rates + b.state);
}

/// Torque of a contact on its follower; the rates of its states go to `rates`.
template <class T>
CLUTCHWORK_INLINE T contact_torque(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  if (b.compliant) [[unlikely]]
    return compliant_torque(ws, b, rate, state, rates);
  return sliding_torque<T, T>(ws, b, rate, b.input, b.law_input);
}

/// Torque of a branch on its follower; the rates of its states go to `rates`.
template <class T>
CLUTCHWORK_INLINE T branch_torque(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  if (b.law >= 0) return contact_torque(ws, b, rate, state, rates);
  return visit_torque(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
    const At<T> at{rate, state + b.state, b.input, b.piece, ws.sys.points};
    if constexpr (E::states > 0) E::state_rates(p, at, rates + b.state);
    return E::torque(p, at);
  });
}

/// Where the partial derivatives of the states of a branch go.
template <class T>
struct StatePartials {
  T *f_state, *g_rate, *g_time, *g_state;
};

/// Where those of branch k go.
template <class T>
CLUTCHWORK_INLINE StatePartials<T> state_partials(const Workspace<T>& ws, int k) {
  const Jacobian<T>& j = ws.jacobian;
  const int at = ws.branch[k].state;
  return {j.f_state + at, j.g_rate + at, j.g_time + at, j.g_state + j.block[k]};
}

/// Derivatives from duals over (rate, own states, time) to where they are wanted.
template <class S, class T>
CLUTCHWORK_INLINE Partial<T> take_partials(const Branch<T>& b, const S& f, const S* own_rates, int n, T* rates,
                                           const StatePartials<T>& out) {
  constexpr int last = int(sizeof(f.d) / sizeof(T)) - 1;
  for (int i = 0; i < n; ++i) {
    rates[b.state + i] = own_rates[i].v;
    out.f_state[i] = f.d[1 + i];
    out.g_rate[i] = own_rates[i].d[0];
    out.g_time[i] = own_rates[i].d[last];
    for (int j = 0; j < n; ++j) out.g_state[i * n + j] = own_rates[i].d[1 + j];
  }
  return Partial<T>{f.v, f.d[0], f.d[last]};
}

/// As branch_partial, for a contact whose law never sticks.
template <class T>
[[gnu::noinline]] Partial<T> compliant_partial(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                               const T* state, T* rates, const StatePartials<T>& out) {
  auto with = [&](auto most) {
    constexpr int n = decltype(most)::value, N = n + 2;
    using S = Dual<T, N>;
    Slots<S, n> own, own_rates;
    Slots<S, most_inputs> input, law_input;
    for (int i = 0; i < b.states; ++i) own.at[i] = S::variable(state[b.state + i], 1 + i);
    dual_inputs<N>(b.inputs, b.input, b.input_slope, input.at);
    dual_inputs<N>(b.law_inputs, b.law_input, b.law_input_slope, law_input.at);
    S x = S::variable(rate, 0);
    x.d[N - 1] = rate_slope;
    const S f = bending_torque<n, T, S>(ws, b, x, own.at, input.at, law_input.at, own_rates.at);
    return take_partials(b, f, own_rates.at, b.states, rates, out);
  };
  if (most_law_states(b.law) <= 1) return with(std::integral_constant<int, 1>{});
  return with(std::integral_constant<int, most_own_states>{});
}

/// Torque and partial derivatives by (rate, own states, time), from dual numbers.
template <class T>
CLUTCHWORK_INLINE Partial<T> branch_partial(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                            const T* state, T* rates, const StatePartials<T>& out) {
  if (b.compliant) [[unlikely]]
    return compliant_partial(ws, b, rate, rate_slope, state, rates, out);
  if (b.law >= 0) {
    using S = Dual<T, 2>;
    Slots<S, most_inputs> input, law_input;
    dual_inputs<2>(b.inputs, b.input, b.input_slope, input.at);
    dual_inputs<2>(b.law_inputs, b.law_input, b.law_input_slope, law_input.at);
    S x = S::variable(rate, 0);
    x.d[1] = rate_slope;
    const S f = sliding_torque<T, S>(ws, b, x, input.at, law_input.at);
    return {f.v, f.d[0], f.d[1]};
  }
  return visit_torque(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    constexpr int n = E::states, N = n + 2;
    using S = Dual<T, N>;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
    S input[E::inputs > 0 ? E::inputs : 1];
    dual_inputs<N>(E::inputs, b.input, b.input_slope, input);
    S own[n > 0 ? n : 1], own_rates[n > 0 ? n : 1];
    for (int i = 0; i < n; ++i) own[i] = S::variable(state[b.state + i], 1 + i);
    S x = S::variable(rate, 0);
    x.d[N - 1] = rate_slope;
    const At<S> at{x, own, input, b.piece, ws.sys.points};
    const S f = E::torque(p, at);
    if constexpr (n > 0) E::state_rates(p, at, own_rates);
    return take_partials(b, f, own_rates, n, rates, out);
  });
}

/// Derivatives of the torque by the inputs of a branch, then by those of its law.
template <class T>
[[gnu::noinline]] void branch_by_input(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* out) {
  constexpr int N = 2 * most_inputs;
  using S = Dual<T, N>;
  S input[most_inputs], law_input[most_inputs], own[most_own_states], rates[most_own_states];
  for (int i = 0; i < b.inputs; ++i) input[i] = S::variable(b.input[i], i);
  for (int i = 0; i < b.law_inputs; ++i) law_input[i] = S::variable(b.law_input[i], b.inputs + i);
  for (int i = 0; i < b.states; ++i) own[i] = S(state[b.state + i]);
  S f{};
  if (b.law < 0) {
    f = visit_torque(b.kind, [&](auto tag) {
      using E = typename decltype(tag)::type;
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
      return E::torque(p, At<S>{S(rate), own, input, b.piece, ws.sys.points});
    });
  } else if (b.compliant) {
    f = bending_torque<most_own_states, T, S>(ws, b, S(rate), own, input, law_input, rates);
  } else {
    f = sliding_torque<T, S>(ws, b, S(rate), input, law_input);
  }
  for (int i = 0; i < b.inputs + b.law_inputs; ++i) out[i] = f.d[i];
}

/// Heat of an element or a contact [W] and its derivative by the rate, at a torque and its derivative.
template <class T>
Dual<T, 1> branch_heat(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, const Dual<T, 1>& torque) {
  using S = Dual<T, 1>;
  const S x = S::variable(rate, 0);
  if (b.law >= 0) return -torque * x;
  return visit_torque(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (HeatingElement<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
      S own[E::states > 0 ? E::states : 1], input[E::inputs > 0 ? E::inputs : 1];
      for (int i = 0; i < E::states; ++i) own[i] = S(state[b.state + i]);
      for (int i = 0; i < E::inputs; ++i) input[i] = S(b.input[i]);
      return E::heat(p, At<S>{x, own, input, b.piece, ws.sys.points});
    }
    return -torque * x;
  });
}

/// Call f with the component that rules the pieces of a branch: its element, or its law.
template <class T, class F>
decltype(auto) visit_branch(const Branch<T>& b, F&& f) {
  if (b.law < 0)
    return visit_torque(b.kind, [&](auto tag) { return f(tag, b.params, b.input, b.input_slope, b.inputs); });
  return visit_law(b.law, [&](auto tag) { return f(tag, b.law_params, b.law_input, b.law_input_slope, b.law_inputs); });
}

/// How far the law of a switching branch is from leaving its piece, and its time derivative; `who` would leave.
template <class T>
Dual<T, 1> law_margin(const Workspace<T>& ws, const Branch<T>& b, T rate, T slope, const T* state, const T* rates,
                      int& who) {
  using S = Dual<T, 1>;
  return visit_branch(b, [&](auto tag, const T* params, const T* inputs, const T* input_slopes, int n) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
      S x(rate), own[L::states > 0 ? L::states : 1], input[most_inputs];
      x.d[0] = slope;
      for (int i = 0; i < b.states; ++i) own[i] = S(state[b.state + i]), own[i].d[0] = rates[b.state + i];
      dual_inputs<1>(n, inputs, input_slopes, input);
      return L::margin(p, At<S>{x, own, input, b.piece, ws.sys.points}, who);
    }
    return S(1);
  });
}

/// Take the law of a switching branch to its next piece; returns it and moves the states where the law says so.
template <class T>
int law_cross(const Workspace<T>& ws, const Branch<T>& b, T rate, int who, T* state) {
  return visit_branch(b, [&](auto tag, const T* params, const T* inputs, const T*, int) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
      return L::cross(p, At<T>{rate, state + b.state, inputs, b.piece, ws.sys.points}, who, state + b.state);
    }
    return b.piece;
  });
}

/// Whether a change of sign of the slip matters to the law of a branch now.
template <class T>
bool law_turns(const Branch<T>& b) {
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
    if constexpr (requires { L::runs_on(0, 0); }) return L::runs_on(b.piece, who);
    return true;
  });
}

/// Whether an element or a law switches between pieces.
template <class T>
bool is_switching(const Branch<T>& b) {
  return visit_branch(
      b, [&](auto tag, const T*, const T*, const T*, int) { return SwitchingLaw<typename decltype(tag)::type>; });
}

/// Room that the law of a contact has inside its tables at a slip; below zero it has left one, and `seen` is what did.
template <class T>
T table_room(const Workspace<T>& ws, int c, T slip, T& seen) {
  const System& sys = ws.sys;
  return visit_law(sys.contact_law[c], [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (BoundedLaw<L>) {
      const T* params = ws.params + sys.contact_law_param[c];
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
      return L::outside(p, At<T>{abs(slip), nullptr, ws.in.u + sys.contact_law_input[c], 0, sys.points}, seen);
    }
    return T(1);
  });
}
inline bool is_bounded_law(int law) {
  return visit_law(law, [](auto tag) { return BoundedLaw<typename decltype(tag)::type>; });
}

/// Whether a law jumps with the sign of the slip.
inline bool is_chattering_law(int law) {
  return visit_law(law, [](auto tag) { return requires { decltype(tag)::type::chatters; }; });
}

/// Number of kinks of the function behind a direction, over its rate or its slip.
template <class T>
int edge_count(const Workspace<T>& ws, int direction) {
  const System& sys = ws.sys;
  auto count = [&](auto tag, const T* params) {
    using E = typename decltype(tag)::type;
    if constexpr (Kinked<E, T>) {
      return E::edges(*reinterpret_cast<const typename E::template Params<T>*>(params));
    } else {
      return 0;
    }
  };
  if (direction < sys.elements) {
    return visit_torque(sys.element_kind[direction],
                        [&](auto tag) { return count(tag, ws.params + sys.element_param[direction]); });
  }
  const int c = direction - int(sys.elements);
  return visit_law(sys.contact_law[c], [&](auto tag) { return count(tag, ws.params + sys.contact_law_param[c]); });
}

/// Kink number i of the function behind a direction.
template <class T>
double edge_at(const Workspace<T>& ws, int direction, int i) {
  const System& sys = ws.sys;
  auto at = [&](auto tag, const T* params) {
    using E = typename decltype(tag)::type;
    if constexpr (Kinked<E, T>) {
      return E::edge(*reinterpret_cast<const typename E::template Params<T>*>(params), sys.points, i);
    } else {
      return 0.0;
    }
  };
  if (direction < sys.elements) {
    return visit_torque(sys.element_kind[direction],
                        [&](auto tag) { return at(tag, ws.params + sys.element_param[direction]); });
  }
  const int c = direction - int(sys.elements);
  return visit_law(sys.contact_law[c], [&](auto tag) { return at(tag, ws.params + sys.contact_law_param[c]); });
}

/// The piece that holds x; at a kink the one above.
template <class T>
int piece_of(const Workspace<T>& ws, int direction, double x) {
  int low = 0, high = edge_count(ws, direction);
  while (low < high) {
    const int middle = (low + high) / 2;
    if (edge_at(ws, direction, middle) <= x) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace clutchwork
