#pragma once
#include <clutchwork/input.hpp>

/// Torque of one branch and its derivatives; the only place where components are called.
namespace clutchwork {

template <class T>
CLUTCHWORK_INLINE int states_of(int kind, int law) {
  if (law < 0) return visit_torque(kind, [](auto tag) { return decltype(tag)::type::states; });
  return visit_law(law, [](auto tag) { return decltype(tag)::type::states; });
}

/// Load of a contact at the given inputs, negative where the clamp is relieved.
template <class T, class S>
CLUTCHWORK_INLINE S contact_load(int kind, const T* params, const S* input) {
  return visit_contact(kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
    return E::load(p, At<S>{S(0), nullptr, input, 0, nullptr});
  });
}

/// Static coefficient of a law.
template <class T>
CLUTCHWORK_INLINE T law_hold(int law, const T* params) {
  return visit_law(law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    return L::hold(*reinterpret_cast<const typename L::template Params<T>*>(params));
  });
}

template <class T>
CLUTCHWORK_INLINE bool contact_one_way(const Workspace<T>& ws, int c) {
  return visit_contact(ws.sys.contact_kind[c], [](auto tag) { return decltype(tag)::type::one_way; });
}

/// Torque of a sliding or held contact on its follower.
template <class T>
CLUTCHWORK_INLINE T contact_torque(const Workspace<T>& ws, const Branch<T>& b, T rate) {
  const T load = larger(contact_load(b.kind, b.params, b.input), T(0));
  if (b.held) return T(b.sign) * load * law_hold(b.law, b.law_params);
  const T coefficient = visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
    return L::slide(p, At<T>{T(b.sign) * rate, nullptr, b.input, b.piece, ws.sys.points});
  });
  return T(-b.sign) * load * coefficient;
}

/// Torque of a branch on its follower; the rates of its states go to `rates`.
template <class T>
CLUTCHWORK_INLINE T branch_torque(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  if (b.law >= 0) return contact_torque(ws, b, rate);
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

/// Inputs as dual numbers over time.
template <int N, class S, class T>
CLUTCHWORK_INLINE void dual_inputs(int count, const Branch<T>& b, S* out) {
  for (int i = 0; i < count; ++i) {
    out[i] = S(b.input[i]);
    out[i].d[N - 1] = b.input_slope[i];
  }
}

/// Torque and partial derivatives by (rate, own states, time), from dual numbers.
template <class T>
CLUTCHWORK_INLINE Partial<T> branch_partial(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                            const T* state, T* rates, const StatePartials<T>& out) {
  if (b.law >= 0) {
    using S = Dual<T, 2>;
    const S load = visit_contact(b.kind, [&](auto tag) {
      using E = typename decltype(tag)::type;
      S input[E::inputs > 0 ? E::inputs : 1];
      dual_inputs<2>(E::inputs, b, input);
      return larger(contact_load<T, S>(b.kind, b.params, input), S(0));
    });
    if (b.held) {
      const T hold = law_hold(b.law, b.law_params) * T(b.sign);
      return {hold * load.v, T(0), hold * load.d[1]};
    }
    const S coefficient = visit_law(b.law, [&](auto tag) {
      using L = typename decltype(tag)::type;
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      S x(T(b.sign) * rate);
      x.d[0] = T(b.sign);
      x.d[1] = T(b.sign) * rate_slope;
      return L::slide(p, At<S>{x, nullptr, nullptr, b.piece, ws.sys.points});
    });
    const S f = load * coefficient;
    return {T(-b.sign) * f.v, T(-b.sign) * f.d[0], T(-b.sign) * f.d[1]};
  }
  return visit_torque(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    constexpr int n = E::states, N = n + 2;
    using S = Dual<T, N>;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
    S input[E::inputs > 0 ? E::inputs : 1];
    dual_inputs<N>(E::inputs, b, input);
    S own[n > 0 ? n : 1], own_rates[n > 0 ? n : 1];
    for (int i = 0; i < n; ++i) own[i] = S::variable(state[b.state + i], 1 + i);
    S x = S::variable(rate, 0);
    x.d[N - 1] = rate_slope;
    const At<S> at{x, own, input, b.piece, ws.sys.points};
    const S f = E::torque(p, at);
    if constexpr (n > 0) {
      E::state_rates(p, at, own_rates);
      for (int i = 0; i < n; ++i) {
        rates[b.state + i] = own_rates[i].v;
        out.f_state[i] = f.d[1 + i];
        out.g_rate[i] = own_rates[i].d[0];
        out.g_time[i] = own_rates[i].d[N - 1];
        for (int j = 0; j < n; ++j) out.g_state[i * n + j] = own_rates[i].d[1 + j];
      }
    }
    return Partial<T>{f.v, f.d[0], f.d[N - 1]};
  });
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
