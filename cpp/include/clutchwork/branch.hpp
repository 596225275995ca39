#pragma once
#include <clutchwork/input.hpp>

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

/// Whether a law never sticks.
inline bool is_compliant_law(int law) {
  return visit_law(law, [](auto tag) { return CompliantLaw<typename decltype(tag)::type>; });
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

/// Torque of a contact whose law never sticks; the rates of its states go to `rates`.
template <class T>
[[gnu::noinline]] T compliant_torque(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  const T load = larger(contact_load(b.kind, b.params, b.input), T(0));
  return visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (CompliantLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      const At<T> at{rate, state + b.state, nullptr, b.piece, ws.sys.points};
      if constexpr (L::states > 0) L::state_rates(p, at, rates + b.state);
      return -load * L::coefficient(p, at);
    }
    return T(0);
  });
}

/// Torque of a sliding or held contact with a law that sticks, on its follower.
template <class T>
CLUTCHWORK_INLINE T sticking_torque(const Workspace<T>& ws, const Branch<T>& b, T rate) {
  const T load = larger(contact_load(b.kind, b.params, b.input), T(0));
  if (b.held) return T(b.sign) * load * law_hold(b.law, b.law_params);
  const T coefficient = visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (StickingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      return L::slide(p, At<T>{T(b.sign) * rate, nullptr, b.input, b.piece, ws.sys.points});
    }
    return T(0);
  });
  return T(-b.sign) * load * coefficient;
}

/// Torque of a contact on its follower; the rates of its states go to `rates`.
template <class T>
CLUTCHWORK_INLINE T contact_torque(const Workspace<T>& ws, const Branch<T>& b, T rate, const T* state, T* rates) {
  if (b.compliant) [[unlikely]]
    return compliant_torque(ws, b, rate, state, rates);
  return sticking_torque(ws, b, rate);
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

/// Inputs as dual numbers over time.
template <int N, class S, class T>
CLUTCHWORK_INLINE void dual_inputs(int count, const Branch<T>& b, S* out) {
  for (int i = 0; i < count; ++i) {
    out[i] = S(b.input[i]);
    out[i].d[N - 1] = b.input_slope[i];
  }
}

/// Load of a contact and its derivative by time.
template <class T>
CLUTCHWORK_INLINE Dual<T, 2> dual_load(const Branch<T>& b) {
  using S = Dual<T, 2>;
  return visit_contact(b.kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    S input[E::inputs > 0 ? E::inputs : 1];
    dual_inputs<2>(E::inputs, b, input);
    return larger(contact_load<T, S>(b.kind, b.params, input), S(0));
  });
}

/// As branch_partial, for a contact whose law never sticks.
template <class T>
[[gnu::noinline]] Partial<T> compliant_partial(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                               const T* state, T* rates, const StatePartials<T>& out) {
  const Dual<T, 2> load = dual_load(b);
  return visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (CompliantLaw<L>) {
      constexpr int most = L::states, N = most + 2;
      using S = Dual<T, N>;
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      S own[most > 0 ? most : 1], own_rates[most > 0 ? most : 1];
      for (int i = 0; i < b.states; ++i) own[i] = S::variable(state[b.state + i], 1 + i);
      S x = S::variable(rate, 0);
      x.d[N - 1] = rate_slope;
      const At<S> at{x, own, nullptr, b.piece, ws.sys.points};
      const S f = L::coefficient(p, at);
      if constexpr (most > 0) {
        L::state_rates(p, at, own_rates);
        for (int i = 0; i < b.states; ++i) {
          rates[b.state + i] = own_rates[i].v;
          out.f_state[i] = -load.v * f.d[1 + i];
          out.g_rate[i] = own_rates[i].d[0];
          out.g_time[i] = own_rates[i].d[N - 1];
          for (int j = 0; j < b.states; ++j) out.g_state[i * b.states + j] = own_rates[i].d[1 + j];
        }
      }
      return Partial<T>{-load.v * f.v, -load.v * f.d[0], -(load.v * f.d[N - 1] + load.d[1] * f.v)};
    }
    return Partial<T>{};
  });
}

/// Torque and partial derivatives by (rate, own states, time), from dual numbers.
template <class T>
CLUTCHWORK_INLINE Partial<T> branch_partial(const Workspace<T>& ws, const Branch<T>& b, T rate, T rate_slope,
                                            const T* state, T* rates, const StatePartials<T>& out) {
  if (b.compliant) [[unlikely]]
    return compliant_partial(ws, b, rate, rate_slope, state, rates, out);
  if (b.law >= 0) {
    using S = Dual<T, 2>;
    const S load = dual_load(b);
    if (b.held) {
      const T hold = law_hold(b.law, b.law_params) * T(b.sign);
      return {hold * load.v, T(0), hold * load.d[1]};
    }
    const S coefficient = visit_law(b.law, [&](auto tag) {
      using L = typename decltype(tag)::type;
      if constexpr (StickingLaw<L>) {
        const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
        S x(T(b.sign) * rate);
        x.d[0] = T(b.sign);
        x.d[1] = T(b.sign) * rate_slope;
        return L::slide(p, At<S>{x, nullptr, nullptr, b.piece, ws.sys.points});
      }
      return S(0);
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

/// How far the law of a switching branch is from leaving its piece, and its time derivative; `who` would leave.
template <class T>
Dual<T, 1> law_margin(const Workspace<T>& ws, const Branch<T>& b, T rate, T slope, const T* state, const T* rates,
                      int& who) {
  using S = Dual<T, 1>;
  return visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      S x(rate), own[L::states];
      x.d[0] = slope;
      for (int i = 0; i < b.states; ++i) own[i] = S(state[b.state + i]), own[i].d[0] = rates[b.state + i];
      return L::margin(p, At<S>{x, own, nullptr, b.piece, ws.sys.points}, who);
    }
    return S(1);
  });
}

/// Take the law of a switching branch to its next piece; returns it and moves the states where the law says so.
template <class T>
int law_cross(const Workspace<T>& ws, const Branch<T>& b, T rate, int who, T* state) {
  return visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(b.law_params);
      return L::cross(p, At<T>{rate, state + b.state, nullptr, b.piece, ws.sys.points}, who, state + b.state);
    }
    return b.piece;
  });
}

/// Whether a change of sign of the slip matters to the law of a branch now.
template <class T>
bool law_turns(const Branch<T>& b) {
  return visit_law(b.law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (SwitchingLaw<L>) {
      return L::turns(*reinterpret_cast<const typename L::template Params<T>*>(b.law_params), b.piece);
    }
    return false;
  });
}

/// Whether a law switches between pieces, or jumps with the sign of the slip.
inline bool is_switching_law(int law) {
  return visit_law(law, [](auto tag) { return SwitchingLaw<typename decltype(tag)::type>; });
}
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
