#pragma once
#include <clutchwork/components/regions.hpp>

namespace clutchwork::elements {

/// Heat convection whose conductance is a table over abs(speed), constant beyond its ends. docs/theory/thermal.md
struct Convection : declared::Convection {
  template <class T>
  struct Params {
    Curve<T> conductance;  ///< rad/s -> W/K
  };

  /// Heat flow from the first to the second node [W]; inputs: their temperatures [K], the speed [rad/s].
  template <class T, class S>
  static S flow(const Params<T>& p, const At<S>& at) {
    const Place x(p, at.points, at.piece);
    const S size = S(x.side) * at.input[Input::speed];
    return (at.input[Input::hot] - at.input[Input::cold]) * held_value(p.conductance, at.points, size, x.interval);
  }

  /// Speed to the nearer end of the piece.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const Place x(p, at.points, at.piece);
    const Point<S>* points = at.points + 3 * int(common(p.conductance.first));
    const S& speed = at.input[Input::speed];
    Least<S> least(who);
    if (x.count < 2) return S(1);
    if (x.interval < x.count) {
      least.watch(S(points[3 * x.interval]) - S(x.side) * speed, x.side > 0 ? ahead : behind);
      if (x.interval == 0) least.watch(S(points[0]) + S(x.side) * speed, x.side > 0 ? behind : ahead);
    }
    if (x.interval > x.lowest) least.watch(S(x.side) * speed - S(points[3 * (x.interval - 1)]), slower);
    if (x.interval == x.lowest && x.interval > 0) least.watch(S(x.side) * speed, turns);
    return least.margin();
  }
  /// A speed that jumps may pass many points.
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T*) {
    Place x(p, at.points, at.piece);
    if (who == turns) x.side = -x.side;
    if (who == slower && x.interval > x.lowest) --x.interval;
    if (who == ahead || who == behind) x.side = who == ahead ? 1 : -1, x.interval += x.interval < x.count;
    const auto* points = at.points + 3 * int(common(p.conductance.first));
    auto border = [&](int i) { return value(points[3 * i]); };
    const auto speed = x.side * value(at.input[Input::speed]), slack = border_slack * (1 + abs(border(x.count - 1)));
    const int reached = settled_interval(speed, x.count, x.interval, slack, border);
    x.interval = larger(reached, x.lowest);
    return x.number();
  }

 private:
  // who leaves a piece: faster in either direction, slower, or through rest
  enum Who : int { ahead, behind, slower, turns };

  /// What the number of a piece stands for: the interval of abs(speed), 0 below the first point, and the direction.
  struct Place {
    int count, lowest = 0, interval, side;

    template <class T>
    Place(const Params<T>& p, const auto* points, int piece) : count(int(common(p.conductance.count))) {
      const auto* x = points + 3 * int(common(p.conductance.first));
      while (lowest < count && value(x[3 * lowest]) <= 0) ++lowest;
      interval = piece % (count + 1), side = piece / (count + 1) % 2 == 0 ? 1 : -1;
      if (interval < lowest) interval = lowest;
    }
    int number() const { return interval + (side > 0 ? 0 : count + 1); }
  };
};

}  // namespace clutchwork::elements
