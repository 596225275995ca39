#pragma once
#include <clutchwork/components/losses.hpp>

namespace clutchwork::elements {

/// Friction of a gear mesh with a loss table: its capacity follows the torque that it transmits.
struct MeshFriction {
  static constexpr bool one_way = false;

  template <class P, class S>
  static S load(const P&, const At<S>&) {
    return S(1);
  }
  template <class P, class S>
  static Bound<S> bound(const P& p, const At<S>& at, int direction) {
    return LossTable{p.loss_table}.on(at.points, at.piece, at.rate).bound(direction);
  }
  template <class P>
  static bool steady(const P& p) {
    return LossTable{p.loss_table}.rows() == 1;
  }
  template <class P>
  static int edges(const P& p) {
    return LossTable{p.loss_table}.edges();
  }
  template <class P>
  static auto edge(const P& p, const auto* points, int i) {
    return LossTable{p.loss_table}.edge(points, i);
  }
  template <class P>
  static bool fits(const P& p) {
    return LossTable{p.loss_table}.fits();
  }
};

/// Gear mesh with losses.
struct Mesh : declared::Mesh, MeshFriction {
  template <class T>
  struct Params {
    T ratio;              ///< [1]
    Curve<T> loss_table;  ///< 1
  };
};

}  // namespace clutchwork::elements
