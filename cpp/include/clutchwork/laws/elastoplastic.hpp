#pragma once
#include <clutchwork/components/bristles.hpp>

namespace clutchwork::laws {

/// LuGre with a range of deflection that is purely elastic: no drift below it.
struct ElastoPlastic : Bristles<ElastoPlastic>, declared::ElastoPlastic {
  static constexpr bool fixed_steps = false;  ///< bristles change within any step

  template <class T>
  struct Params : StribeckCurve<T> {
    T stiffness;  ///< [1/rad]
    T damping;    ///< [s/rad]
    T elastic;    ///< [rad]
    T plastic;    ///< [rad]
  };

  /// Share of the slip that is plastic: 0 inside the elastic range and on the way back, 1 beyond the plastic one.
  template <class T, class S>
  static S plasticity(const Params<T>& p, const At<S>& at, const S& level) {
    const S size = abs(at.state[0]);
    const S low = S(p.stiffness * p.elastic);
    if (size <= low || (value(at.rate) < 0) != (value(at.state[0]) < 0)) return S(0);
    const S high = value(p.plastic) > 0 ? S(p.stiffness * p.plastic) : level;
    if (size >= high) return S(1);
    const double pi = 3.141592653589793;
    return S(0.5) + S(0.5) * sin(S(pi) * (size - (high + low) * S(0.5)) / (high - low));
  }
  /// Rate of the deflection [rad/s].
  template <class T, class S>
  static S bending(const Params<T>& p, const At<S>& at) {
    const S level = sliding_level(p, at.rate);
    return at.rate - plasticity(p, at, level) * abs(at.rate) * at.state[0] / level;
  }
};

}  // namespace clutchwork::laws
