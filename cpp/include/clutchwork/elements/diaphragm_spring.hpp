#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Clamp force over the travel of the release bearing, which follows the pedal. docs/theory/clutches.md
struct DiaphragmSpring : declared::DiaphragmSpring {
  template <class T>
  struct Params {
    Curve<T> force;                                ///< m -> N
    T ratio;                                       ///< [1]
    T free_travel;                                 ///< [m]
    T wear_ratio;                                  ///< [1]
    T lag;                                         ///< [s]
    Word<T, choice::Interpolation> interpolation;  ///< [1]
  };

  /// Force at the present travel [N]; wear takes the fingers towards the bearing.
  template <class T, class S>
  static S wanted(const Params<T>& p, const At<S>& at) {
    const auto table = cells(p, at.points);
    auto force = [&](int i) { return S(table.axis.x[3 * i + 1]); };
    const S x = table.within(pressed(p, at), at.piece / 2);
    return table_value<S>(table.axis, table.manner, force, x, table.interval(at.piece / 2));
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    rates[0] = (wanted(p, at) - at.state[0]) / p.lag;
  }

  /// Way to the nearer border of the table, and to where the bearing touches the fingers, over the table.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const auto table = cells(p, at.points);
    const auto width = width_of(table.axis);
    Least<S> least(who);
    table.watch(pressed(p, at), at.piece / 2, width, least);
    least.watch(S(is_free(at.piece) ? -1 : 1) * travel(p, at) / S(width), touches);
    return least.margin();
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T*) {
    if (who == touches) return at.piece ^ 1;
    const auto table = cells(p, at.points);
    return 2 * table.next(at.piece / 2, who, value(pressed(p, at)), width_of(table.axis)) + at.piece % 2;
  }

 private:
  // who leaves a piece: borders of the table, or the free travel
  static constexpr int touches = 2;

  static bool is_free(int piece) { return piece % 2 != 0; }
  static auto width_of(const auto& axis) {
    const auto width = value(axis.last()) - value(axis[0]);
    return width > 0 ? width : decltype(value(axis.last()))(1);
  }
  template <class T, class G>
  static Cells<G> cells(const Params<T>& p, const G* points) {
    return {axis_of(p.force, points), Manner{p.interpolation, choice::Extrapolation::nearest}};
  }
  /// Way of the bearing beyond its free travel [m].
  template <class T, class S>
  static S travel(const Params<T>& p, const At<S>& at) {
    return p.ratio * at.input[Input::travel] - p.free_travel;
  }
  template <class T, class S>
  static S pressed(const Params<T>& p, const At<S>& at) {
    const S worn = p.wear_ratio * at.input[Input::wear];
    return is_free(at.piece) ? worn : travel(p, at) + worn;
  }
};

}  // namespace clutchwork::elements
