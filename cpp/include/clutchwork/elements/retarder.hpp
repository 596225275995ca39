#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Hydrodynamic retarder: its torque rises with the square of the speed up to a limit, then follows a power.
/// docs/theory/sources.md (3)
struct Retarder : declared::Retarder {
  template <class T>
  struct Params {
    T capacity;    ///< [N m s2/rad2]
    T max_torque;  ///< [N m]
    T max_power;   ///< [W]
    T lag;         ///< [s]
  };

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const S y = value(p.lag) > 0 ? at.state[filling] : command(at);
    return at.piece <= middle(p) ? y * size(p, at, middle(p) - at.piece) : -(y * size(p, at, at.piece - middle(p) - 1));
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    if (value(p.lag) > 0) rates[filling] = (command(at) - at.state[filling]) / p.lag;
  }
  template <class T>
  static int count(const Params<T>& p) {
    return value(p.lag) > 0 ? 1 : 0;
  }

  /// Between the limits of each side stands the change of direction.
  template <class T>
  static int edges(const Params<T>& p) {
    return 2 * middle(p) + 1;
  }
  template <class T>
  static T edge(const Params<T>& p, const double*, int i) {
    const int m = middle(p);
    return i == m ? T(0) : i < m ? -border(p, m - 1 - i) : border(p, i - m - 1);
  }

 private:
  /// What is wanted of it, from empty to full: what another component gives has no bounds.
  template <class S>
  static S command(const At<S>& at) {
    return larger(smaller(at.input[Input::command], S(1)), S(0));
  }
  /// Whether there is a range of speeds in which the torque has its limit.
  template <class T>
  static bool is_flat(const Params<T>& p) {
    const auto w = value(p.max_power) / value(p.max_torque);
    return value(p.capacity) * w * w > value(p.max_torque);
  }
  /// Borders on each side of rest.
  template <class T>
  static int middle(const Params<T>& p) {
    return is_flat(p) ? 2 : 1;
  }
  /// Speed at the end of range i.
  template <class T>
  static T border(const Params<T>& p, int i) {
    if (!is_flat(p)) return cbrt(p.max_power / p.capacity);
    return i == 0 ? sqrt(p.max_torque / p.capacity) : p.max_power / p.max_torque;
  }
  /// Size of the torque of a full one in range i away from rest.
  template <class T, class S>
  static S size(const Params<T>& p, const At<S>& at, int i) {
    if (i == 0) return p.capacity * at.rate * at.rate;
    return i == 1 && is_flat(p) ? S(p.max_torque) : p.max_power / abs(at.rate);
  }
};

}  // namespace clutchwork::elements
