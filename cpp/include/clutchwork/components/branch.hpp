#pragma once
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/workspace.hpp>

/// Torque of one branch, its derivatives and its heat.
namespace clutchwork {

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
  const S load = b.pressed ? contact_load<T, S>(b.kind, b.params, input, points_of(ws)) : S(0);
  S coefficient = visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (StickingLaw<L> && computes_with<L, T>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      return L::slide(p, At<S>{T(b.sign) * rate, nullptr, law_input, b.piece, points_of(ws)});
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
  const S load = b.pressed ? contact_load<T, S>(b.kind, b.params, input, points_of(ws)) : S(0);
  S coefficient = visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (CompliantLaw<L> && L::states <= Room) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      const At<S> at{rate, own, law_input, b.piece, points_of(ws)};
      if constexpr (ProgrammedLaw<L>) {
        return L::coefficient_and_rates(p, at, rates);
      } else {
        if constexpr (L::states > 0) L::state_rates(p, at, rates);
        return L::coefficient(p, at);
      }
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
  if constexpr (!has_lanes<T>) {
    if (b.compliant) [[unlikely]]
      return compliant_torque(ws, b, rate, state, rates);
  }
  return sliding_torque<T, T>(ws, b, rate, b.input, b.law_input);
}

/// Torque of an element of one way; the rates of its states go to `rates`.
template <class E, class T>
CLUTCHWORK_INLINE T torque_of(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
  const At<T> at{rate, state + b.state, b.input, b.piece, points_of(ws)};
  if constexpr (E::states > 0) E::state_rates(p, at, rates + b.state);
  return E::torque(p, at);
}
template <class E, class T>
[[gnu::noinline]] T torque_apart(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  return torque_of<E>(ws, b, rate, state, rates);
}

/// Torque of a branch on its follower; the rates of its states go to `rates`. Elements that switch are compiled apart,
/// so that those of every driveline stay short.
template <class T>
CLUTCHWORK_INLINE T branch_torque(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  if (b.law >= 0) return contact_torque(ws, b, rate, state, rates);
  return visit_torque(b.kind, [&](auto tag) CLUTCHWORK_HOT_LAMBDA {
    using E = typename decltype(tag)::type;
    if constexpr (!computes_with<E, T> || !TorqueElement<E>)
      return T(0);
    else if constexpr (SwitchingLaw<E>)
      return torque_apart<E>(ws, b, rate, state, rates);
    else
      return torque_of<E>(ws, b, rate, state, rates);
  });
}

/// The same, compiled once: for what is asked seldom.
template <class T>
[[gnu::noinline]] T branch_torque_once(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  return branch_torque(ws, b, rate, state, rates);
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

/// Torque of an element of one way and its partial derivatives by (rate, own states, time), from dual numbers.
template <class E, class T>
CLUTCHWORK_INLINE Partial<T> partial_of(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                        const T* state, T* rates, const StatePartials<T>& out) {
  constexpr int n = E::states, N = n + 2;
  using S = Dual<T, N>;
  const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
  S input[E::inputs > 0 ? E::inputs : 1];
  dual_inputs<N>(E::inputs, b.input, b.input_slope, input);
  S own[n > 0 ? n : 1], own_rates[n > 0 ? n : 1];
  const int used = Sized<E> ? b.states : n;
  for (int i = 0; i < used; ++i) own[i] = S::variable(state[b.state + i], 1 + i);
  S x = S::variable(rate, 0);
  x.d[N - 1] = rate_slope;
  const At<S> at{x, own, input, b.piece, points_of(ws)};
  const S f = E::torque(p, at);
  if constexpr (n > 0) E::state_rates(p, at, own_rates);
  return take_partials(b, f, own_rates, used, rates, out);
}
template <class E, class T>
[[gnu::noinline]] Partial<T> partial_apart(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                           const T* state, T* rates, const StatePartials<T>& out) {
  return partial_of<E>(ws, b, rate, rate_slope, state, rates, out);
}

/// Those of a branch.
template <class T>
CLUTCHWORK_INLINE Partial<T> branch_partial_inline(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                                   const T* state, T* rates, const StatePartials<T>& out) {
  if constexpr (!has_lanes<T>) {
    if (b.compliant) [[unlikely]]
      return compliant_partial(ws, b, rate, rate_slope, state, rates, out);
  }
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
  return visit_torque(b.kind, [&](auto tag) CLUTCHWORK_HOT_LAMBDA {
    using E = typename decltype(tag)::type;
    if constexpr (!computes_with<E, T> || !TorqueElement<E>)
      return Partial<T>{};
    else if constexpr (SwitchingLaw<E>)
      return partial_apart<E>(ws, b, rate, rate_slope, state, rates, out);
    else
      return partial_of<E>(ws, b, rate, rate_slope, state, rates, out);
  });
}

template <class T>
[[gnu::noinline]] Partial<T> branch_partial(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                            const T* state, T* rates, const StatePartials<T>& out) {
  return branch_partial_inline(ws, b, rate, rate_slope, state, rates, out);
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
      if constexpr (TorqueElement<E>) {
        const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
        return E::torque(p, At<S>{S(rate), own, input, b.piece, points_of(ws)});
      }
      return S(0);
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
    if constexpr (HeatingElement<E> && TorqueElement<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
      S own[E::states > 0 ? E::states : 1], input[E::inputs > 0 ? E::inputs : 1];
      for (int i = 0; i < b.states; ++i) own[i] = S(state[b.state + i]);
      for (int i = 0; i < E::inputs; ++i) input[i] = S(b.input[i]);
      return E::heat(p, At<S>{x, own, input, b.piece, points_of(ws)});
    }
    return -torque * x;
  });
}

/// Torques along all ways of an element at their rates; the rates of its states go to `rates`.
template <class T, class S>
CLUTCHWORK_INLINE void element_torques(const Workspace<T>& ws, const Branch<T>& b, const S* rate, const S* own,
                                       const S* input, S* rates, S* torque) {
  visit_torque(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
    const At<S> at{rate[0], own, input, b.piece, points_of(ws), rate};
    if constexpr (E::states > 0) E::state_rates(p, at, rates);
    if constexpr (CoupledElement<E>) {
      E::torques(p, at, OwnTorques<S>(torque));
    } else if constexpr (TransmissionElement<E>) {
      // solved for once all others are known
      torque[0] = torque[1] = S(T(0));
    } else {
      torque[0] = E::torque(p, at);
    }
  });
}

/// Heat of an element with all its ways [W], at their rates and torques.
template <class T, class S>
CLUTCHWORK_INLINE S element_heat(const Workspace<T>& ws, const Branch<T>& b, const S* rate, const S* own,
                                 const S* input, const S* torque) {
  return visit_torque(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (HeatingElement<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
      return E::heat(p, At<S>{rate[0], own, input, b.piece, points_of(ws), rate});
    }
    S heat = -torque[0] * rate[0];
    for (int i = 1; i < E::ways; ++i) heat -= torque[i] * rate[i];
    return heat;
  });
}

}  // namespace clutchwork
