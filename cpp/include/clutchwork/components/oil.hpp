#pragma once
#include <clutchwork/components/component.hpp>
#include <clutchwork/components/regions.hpp>

/// Flow of oil through openings: docs/theory/hydraulics.md.
namespace clutchwork {

inline constexpr double bar = 1e5;         ///< [Pa] one unit of a pressure among the states of hydraulic elements
inline constexpr double ambient = 101325;  ///< [Pa] what pressures are above

/// Oil as it flows: [kg/m3], [m2/s].
template <class S>
struct OilNow {
  S density, viscosity;
};

/// Flow through an opening of an area at a pressure difference u: turbulent above the transition, laminar below.
/// docs/theory/hydraulics.md (2), (3)
template <class T, class S>
S opening_flow(const S& area, const T& discharge, const T& transition, const OilNow<S>& oil, const S& u) {
  constexpr double pi = 3.14159265358979323846;
  // square of Reynolds number times viscosity over the discharge and the hydraulic diameter
  const S speed = transition * oil.viscosity / discharge;
  // 1 Pa keeps it regular without viscosity
  const S laminar = oil.density * speed * speed * T(pi / 8) / area + T(1);
  return discharge * area * sqrt(S(2) / oil.density) * u / sqrt(sqrt(u * u + laminar * laminar));
}

/// Share of an opening that an edge uncovers, with the clearance of its bore: docs/theory/hydraulics.md (6)
template <class T, class S>
S uncovered(const S& way, const T& clearance) {
  // the form that keeps its digits on either side
  const S root = sqrt(way * way + clearance * clearance);
  if (value(way) >= 0) return (way + root) / S(2);
  return S(clearance * clearance) / (S(2) * (root - way));
}

/// Oil of a pump per radian [m3].
template <class T>
T pump_per_radian(const T& displacement) {
  return displacement / T(6.28318530717958647692);
}

/// Share of its chambers that a pump fills: all, unless the pressure at its inlet is near vacuum.
/// docs/theory/hydraulics.md (13)
template <class S>
S pump_filling(const S& inlet) {
  const S x = (inlet + S(ambient)) / S(2e4);
  if (value(x) >= 1) return S(1);
  return value(x) > 0 ? x * x * (S(3) - S(2) * x) : S(0);
}

/// Pieces of a pump: the pressure rises through it, or falls.
enum PumpPiece : int { rising, falling };

/// How far the pressure difference of a pump goes beyond zero before its piece ends, which does not follow what steps
/// miss of the pressures [Pa].
template <class S>
S pump_slack(const S& outlet, const S& inlet) {
  return (abs(outlet) + abs(inlet)) * S(1e-6) + S(1e-3);
}

/// Pressure difference the way it goes now [bar].
template <class S>
S pump_margin(int piece, const S& outlet, const S& inlet, int& who) {
  Least<S> least(who);
  const S way = piece == falling ? inlet - outlet : outlet - inlet;
  least.watch((least.rests ? way : way + pump_slack(outlet, inlet)) / S(bar), 0);
  return least.margin();
}

/// Friction of a pump that grows with its load, against its motion; it fades out where that is slow.
/// docs/theory/hydraulics.md (11)
template <class T, class S>
S pump_friction(const T& efficiency, const T& slow, int piece, const S& ideal, const S& rate) {
  const S size = piece == falling ? -ideal : ideal;
  return (T(1) / efficiency - T(1)) * size * rate / sqrt(rate * rate + slow * slow);
}

}  // namespace clutchwork
