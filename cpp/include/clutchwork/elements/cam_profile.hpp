#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/elastic_contact.hpp>
#include <clutchwork/components/stretch.hpp>

namespace clutchwork::elements {

/// Cam whose lift is a periodic spline; the angle starts again with each revolution, piece k ends at point k + 1.
/// docs/theory/varying-ratios.md (16)
struct CamProfile : declared::CamProfile {
  template <class T>
  struct Params {
    Curve<T> lift;       ///< rad -> m
    Curve<T> curvature;  ///< m/rad2
  };

  template <class T, class S>
  static S ratio(const Params<T>& p, const At<S>& at) {
    const Point<S>* x = at.points + 3 * (int(common(p.lift.first)) + at.piece);
    const Point<S>* bend = at.points + 3 * (int(common(p.curvature.first)) + at.piece);
    const Point<S> width = x[3] - x[0], start = x[2] - width * (2 * bend[0] + bend[3]) / 6;
    const S u = at.state[angle] - S(x[0]);
    return S(start) + u * (S(bend[0]) + u * S((bend[3] - bend[0]) / (2 * width)));
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[angle] = at.rates[Way::shaft];
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    LeastGuard<S> guards;
    const Point<S>* x = at.points + 3 * (int(common(p.lift.first)) + at.piece);
    const S scale = S(curve_width(p.lift, at.points));
    guards.watch((S(x[3]) - at.state[angle]) / scale, next), guards.watch((at.state[angle] - S(x[0])) / scale, last);
    who = guards.who;
    return guards.least + guards.change;
  }
  /// Where the table ends the next revolution starts.
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    if (who != next && who != last) return at.piece;
    const int pieces = curve_edges(p.lift) + 1, to = who == next ? at.piece + 1 : at.piece - 1;
    const T turn = T(curve_width(p.lift, at.points));
    if (to == pieces) state[angle] -= turn;
    if (to < 0) state[angle] += turn;
    return (to + pieces) % pieces;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    return stretch_of(p.lift, at.points, value(at.state[angle]), at.piece);
  }

 private:
  enum Who : int { next, last };
};

}  // namespace clutchwork::elements
