#pragma once
#include <clutchwork/workspace.hpp>

/// What the kinds of components say of themselves, and what a contact can hold.
namespace clutchwork {

/// Number of own states of a torque element (law < 0) or of a contact, which are those of its law; `params` are those
/// of the element or the law.
template <class T>
int states_of(int kind, int law, const T* params) {
  auto count = [&](auto tag) {
    using C = typename decltype(tag)::type;
    if constexpr (Sized<C>) return C::count(*reinterpret_cast<const typename C::template Params<T>*>(params));
    return int(C::states);
  };
  return law < 0 ? visit_torque(kind, count) : visit_law(law, count);
}

/// Ways of a torque element.
inline int ways_of(int kind) {
  return visit_torque(kind, [](auto tag) { return int(decltype(tag)::type::ways); });
}

/// Most states of a law.
inline int most_law_states(int law) {
  return visit_law(law, [](auto tag) { return int(decltype(tag)::type::states); });
}

/// Span of own state i of a torque element (law < 0) or of a law [s].
inline double state_span(int kind, int law, int i) {
  auto of = [&](auto tag) {
    using C = typename decltype(tag)::type;
    if constexpr (C::states > 0) return C::span[i];
    return 0.0;
  };
  return law < 0 ? visit_torque(kind, of) : visit_law(law, of);
}

/// Inputs of a torque element, a contact or a law.
inline int element_inputs(int kind) {
  return visit_torque(kind, [](auto tag) { return int(decltype(tag)::type::inputs); });
}
inline int contact_inputs(int kind) {
  return visit_contact(kind, [](auto tag) { return int(decltype(tag)::type::inputs); });
}
inline int law_inputs_of(int law) {
  return visit_law(law, [](auto tag) { return int(decltype(tag)::type::inputs); });
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
CLUTCHWORK_INLINE S contact_load(int kind, const T* params, const S* input, const Point<T>* points) {
  return visit_contact(kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (computes_with<E, T>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
      return E::load(p, At<S>{S(0), nullptr, input, 0, points});
    }
    return S(0);
  });
}

/// Torque per load of a contact whose law gives the coefficient mu, slipping in a direction.
template <class T, class S>
CLUTCHWORK_INLINE S contact_gain(int kind, const T* params, const S& mu, int direction) {
  return visit_contact(kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (ShapedContact<E> && computes_with<E, T>)
      return E::gain(*reinterpret_cast<const typename E::template Params<T>*>(params), mu, direction);
    return mu;
  });
}

/// What holds against slip of a size in a direction, over its load, of a contact that follows one.
template <class T, class S>
Bound<S> contact_bound(int kind, const T* params, const S& slip, const S* input, int piece, const Point<T>* points,
                       int direction) {
  return visit_contact(kind, [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (LoadedContact<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(params);
      return E::bound(p, At<S>{slip, nullptr, input, piece, points}, direction);
    }
    return Bound<S>{};
  });
}

/// Whether a contact follows a load.
inline bool is_loaded(int kind) {
  return visit_contact(kind, [](auto tag) { return LoadedContact<typename decltype(tag)::type>; });
}

/// Whether what a contact holds may depend on the way in which it is pulled.
inline bool is_directed(int kind) {
  return visit_contact(kind, [](auto tag) {
    using E = typename decltype(tag)::type;
    return ShapedContact<E> || LimitedContact<E> || LoadedContact<E>;
  });
}

/// Static coefficient of a law.
template <class T>
CLUTCHWORK_INLINE T law_hold(int law, const T* params, const T* input, const Point<T>* points) {
  return visit_law(law, [&](auto tag) {
    using L = typename decltype(tag)::type;
    if constexpr (computes_with<L, T>) {
      const auto& p = *reinterpret_cast<const typename L::template Params<T>*>(params);
      return L::hold(p, At<T>{T(0), nullptr, input, 0, points});
    }
    return T(0);
  });
}

/// Static torque of a contact that resists slip in a direction, not negative.
template <class T, class Sys>
T contact_limit(const Sys& sys, const Point<T>* points, int c, const T* params, const T* input, const T* law_input,
                int direction) {
  const T* own = params + sys.contact_param[c];
  const T hold = law_hold(sys.contact_law[c], params + sys.contact_law_param[c], law_input, points);
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(own);
    const At<T> at{T(0), nullptr, input, 0, points};
    if constexpr (!computes_with<E, T>) {
      return T(0);
    } else if constexpr (LimitedContact<E>) {
      return larger(E::limit(p, at, hold, direction), T(0));
    } else {
      const T load = larger(E::load(p, at), T(0));
      if constexpr (ShapedContact<E>) return load * E::gain(p, hold, direction);
      return load * hold;
    }
  });
}

/// The sign of the slip that a contact cannot oppose, however pressed: forward of a freewheel, away from the end of a
/// stop that is closed; 0: there is none.
template <class T>
CLUTCHWORK_INLINE int free_way(const Workspace<T>& ws, int c) {
  if (ws.contact.fault[c] == cannot_transmit) return 0;
  return visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (StopContact<E> && !has_lanes<T>) return -ws.contact.side[c];
    return int(E::one_way);
  });
}
template <class T>
CLUTCHWORK_INLINE bool contact_one_way(const Workspace<T>& ws, int c) {
  return free_way(ws, c) != 0;
}

/// What a freewheel holds before it gives way [N m].
template <class T>
[[gnu::noinline]] T freewheel_limit(const Workspace<T>& ws, int c) {
  return visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (YieldingContact<E>)
      return E::holding(*reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.contact_param[c]));
    return T(infinity);
  });
}

}  // namespace clutchwork
