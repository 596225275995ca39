#pragma once
#include <clutchwork/components/bound.hpp>
#include <clutchwork/components/component.hpp>

/// Losses in a gear mesh from efficiencies and friction over the speed: docs/theory/load-dependent.md.
namespace clutchwork {

/// Efficiencies and friction of both directions of power at one speed.
template <class S>
struct Losses {
  S ahead, back;                    ///< [1] efficiency where the input drives, and where the output does
  S friction_ahead, friction_back;  ///< [N m] at the input

  /// What holds against slip in a direction, over the torque of the mesh on its input. docs/theory/load-dependent.md
  /// (3)
  Bound<S> bound(int direction) const {
    const S gain = S(1) / ahead - S(1), loss = S(1) - back, sign = S(direction);
    const S weak = select(value(back) > 0, back * friction_back, S(0));
    return {{-sign * gain, sign * loss}, {friction_ahead / ahead, weak}};
  }
};

/// A loss table in the pool: rows of speed, two efficiencies, two frictions; linear between rows and beyond them, there
/// until a loss would be a gain.
template <class T>
struct LossTable {
  const Curve<T>& list;
  static constexpr int columns = 5;

  int rows() const { return int(common(list.count)) / columns; }
  template <class G>
  G at(const G* points, int row, int column) const {
    return points[3 * (int(common(list.first)) + row * columns + column)];
  }
  bool fits() const {
    const int count = int(common(list.count));
    return count > 0 && count % columns == 0;
  }
  /// Speeds at which one line follows another.
  int edges() const { return rows() > 2 ? rows() - 2 : 0; }
  auto edge(const auto* points, int i) const { return at(points, i + 1, 0); }

  template <class S>
  Losses<S> on(const auto* points, int piece, const S& speed) const {
    if (rows() == 1) {
      auto same = [&](int column) { return S(at(points, 0, column)); };
      return {same(1), same(2), same(3), same(4)};
    }
    const auto start = at(points, piece, 0), length = at(points, piece + 1, 0) - start;
    auto line = [&](int column) {
      const auto first = at(points, piece, column), rise = (at(points, piece + 1, column) - first) / length;
      return S(first) + (speed - S(start)) * S(rise);
    };
    const S none(0), all(1);
    return {smaller(line(1), all), smaller(line(2), all), larger(line(3), none), larger(line(4), none)};
  }
};

}  // namespace clutchwork
