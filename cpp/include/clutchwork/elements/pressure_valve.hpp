#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Pressure over current with a lag; piece i of the table ends at its point i. docs/theory/actuators.md (1)
struct PressureValve : declared::PressureValve {
  template <class T>
  struct Params {
    Curve<T> pressure;  ///< A -> Pa
    T lag;              ///< [s]
  };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const int n = int(common(p.pressure.count)), piece = at.piece < n ? at.piece : n;
    const Point<S>* points = at.points + 3 * int(common(p.pressure.first));
    S wanted = S(points[piece == 0 ? 1 : 3 * n - 2]);
    if (piece > 0 && piece < n) wanted = curve_value(p.pressure, at.points, S(at.input[Input::current]), piece - 1);
    rates[pressure] = (wanted - at.state[pressure]) / p.lag;
  }

  /// Current to the nearer end of the piece.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const int n = int(common(p.pressure.count)), piece = at.piece < n ? at.piece : n;
    const Point<S>* points = at.points + 3 * int(common(p.pressure.first));
    const S current = at.input[Input::current];
    const S down = piece > 0 ? current - S(points[3 * (piece - 1)]) : S(1e300);
    const S up = piece < n ? S(points[3 * piece]) - current : S(1e300);
    who = value(up) < value(down) ? 1 : -1;
    return who > 0 ? up : down;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T*) {
    const int n = int(common(p.pressure.count)), next = (at.piece < n ? at.piece : n) + who;
    return next < 0 ? 0 : next;
  }
};

}  // namespace clutchwork::elements
