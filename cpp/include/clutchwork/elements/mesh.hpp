#pragma once
#include <clutchwork/components/losses.hpp>

namespace clutchwork::elements {

/// Gear mesh with losses: its capacity follows the torque that it transmits.
struct Mesh : declared::Mesh {
  template <class T>
  struct Params {
    T ratio;              ///< [1]
    Curve<T> loss_table;  ///< 1
  };
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>&, const At<S>&) {
    return S(1);
  }
  template <class T, class S>
  static Bound<S> bound(const Params<T>& p, const At<S>& at, int direction) {
    return LossTable<T>{p.loss_table}.on(at.points, at.piece, at.rate).bound(direction);
  }
  template <class T>
  static int edges(const Params<T>& p) {
    return LossTable<T>{p.loss_table}.edges();
  }
  template <class T>
  static double edge(const Params<T>& p, const double* points, int i) {
    return LossTable<T>{p.loss_table}.edge(points, i);
  }
  template <class T>
  static bool fits(const Params<T>& p) {
    return LossTable<T>{p.loss_table}.fits();
  }
};

}  // namespace clutchwork::elements
