#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Slope and position on a road; piece i ends at point i of its elevation. docs/theory/vehicle.md (5)
struct Road : declared::Road {
  template <class T>
  struct Params {
    Curve<T> elevation;  ///< m -> m
  };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const auto up = slope_on(p, at.points, at.piece);
    rates[slope] = S(0);
    rates[position] = at.input[Input::speed] / T(sqrt(Point<S>(1) + up * up));
  }

  /// Way to the nearer end of the piece.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const int n = int(common(p.elevation.count)), piece = at.piece < n ? at.piece : n;
    const Point<S>* x = at.points + 3 * int(common(p.elevation.first));
    const S back = piece > 0 ? at.state[position] - S(x[3 * (piece - 1)]) : S(1e300);
    const S on = piece < n ? S(x[3 * piece]) - at.state[position] : S(1e300);
    who = value(on) < value(back) ? forward : backward;
    return who == forward ? on : back;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    const int n = int(common(p.elevation.count));
    const Point<T>* points = at.points + 3 * int(common(p.elevation.first));
    auto x = [&](int i) { return value(points[3 * i]); };
    int piece = at.piece < n ? at.piece : n;
    // the point itself, so that round-off does not lead back over it
    const T passed = T(points[3 * (who == forward ? piece : piece - 1)]);
    if (is_at(state[position], passed)) state[position] = passed;
    if (who == forward) {
      for (++piece; piece < n && value(state[position]) > x(piece);) ++piece;
    } else {
      for (--piece; piece > 0 && value(state[position]) < x(piece - 1);) --piece;
    }
    state[slope] = T(slope_on(p, at.points, piece));
    return piece;
  }
  /// The point at which it is, to round-off.
  template <class T>
  static bool corner(const Params<T>& p, const At<T>& at, Corner<T>& found) {
    const int n = int(common(p.elevation.count)), piece = at.piece < n ? at.piece : n;
    const Point<T>* points = at.points + 3 * int(common(p.elevation.first));
    for (int i = piece > 0 ? piece - 1 : 0; i < n && i <= piece; ++i) {
      const T place = T(points[3 * i]);
      if (!is_at(at.state[position], place)) continue;
      const T before = T(slope_on(p, at.points, i)), behind = T(slope_on(p, at.points, i + 1));
      found = {position, slope, int(Input::speed), i, place, before, behind};
      return true;
    }
    return false;
  }

 private:
  template <class T>
  static bool is_at(const T& position, const T& point) {
    return abs(value(position - point)) < 1e-9 * (1 + abs(value(point)));
  }
  /// Slope of a piece; the road is level outside of its points.
  template <class T, class G>
  static G slope_on(const Params<T>& p, const G* points, int piece) {
    const int n = int(common(p.elevation.count));
    return piece > 0 && piece < n ? points[3 * (int(common(p.elevation.first)) + piece) - 1] : G(0);
  }
  enum Who : int { forward, backward };
};

}  // namespace clutchwork::elements
