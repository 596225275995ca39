#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/regions.hpp>
#include <clutchwork/components/speed_ratio.hpp>

namespace clutchwork::elements {

/// Fluid coupling: torque k(slow/fast) fast^2 from the fast to the slow shaft. Pieces: the intervals of the table with
/// the base as the fast shaft, then with the follower. docs/theory/coupled.md
struct FluidCoupling : declared::FluidCoupling {
  template <class T>
  struct Params {
    Curve<T> speed_ratio;         ///< 1
    Curve<T> capacity;            ///< N m s2/rad2
    Curve<T> performance_number;  ///< 1
    T density;                    ///< [kg/m3]
    T diameter;                   ///< [m]
  };

  template <class T, class S>
  static void torques(const Params<T>& p, const At<S>& at, OwnTorques<S> torque) {
    const List ratios = list_of(p.speed_ratio, at.points);
    const bool by_base = at.piece < ratios.count;
    const S fast = by_base ? at.rates[Way::base] : at.rates[Way::follower], &slip = at.rates[Way::slip];
    torque[Way::base] = torque[Way::follower] = S(0);
    torque[Way::slip] = S(0);
    if (vanishes(fast)) return;
    const S above = (by_base ? slip : -slip) / fast;
    const S k = over_ratio(ratios, at.piece % ratios.count, above, [&](int i) { return factor(p, at.points, i); });
    torque[Way::slip] = k * fast * abs(fast) * S(by_base ? 1 : -1);
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>&, S*) {}

  template <class T>
  static bool fits(const Params<T>& p) {
    const int n = int(common(p.speed_ratio.count)), k = int(common(p.capacity.count));
    return n >= 2 && (k == n || (k == 1 && int(common(p.performance_number.count)) == n));
  }

  /// Who: 0 leaves its piece to lower ratios, 1 to higher ones.
  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const List ratios = list_of(p.speed_ratio, at.points);
    const int piece = at.piece % ratios.count;
    const bool by_base = at.piece < ratios.count;
    const S fast = by_base ? at.rates[Way::base] : at.rates[Way::follower];
    const S slow = by_base ? at.rates[Way::follower] : at.rates[Way::base];
    const S slip = by_base ? at.rates[Way::slip] : -at.rates[Way::slip];
    // near rest, where the torque vanishes, round-off does not change the piece
    const auto size = abs(value(fast)) + 1.0;
    const S turn = S((value(fast) < 0 ? -1 : 1) / size);
    Least<S> least(who);
    least.watch((slow - S(piece == 0 ? -1.0 : ratios[piece - 1]) * fast) * turn, 0);
    least.watch(-(slip + S(1.0 - ratios[piece]) * fast) * turn, 1);
    return least.margin();
  }
  template <class T, class S>
  static int cross(const Params<T>& p, const At<S>& at, int who, S*) {
    const int n = int(common(p.speed_ratio.count)), piece = at.piece % n, side = at.piece - piece;
    const int up = piece + 1 < n ? at.piece + 1 : piece + (side == 0 ? n : 0);
    const int down = piece > 0 ? at.piece - 1 : side == 0 ? n : 0;
    // near rest several pieces are passed at once, or round-off has taken the wrong shaft for the fast one
    const int next = who == 1 ? up : down, there = placed(p, at);
    if ((there < n) != (side == 0)) return there;
    if ((next < n) != (side == 0)) return next;
    return who == 1 ? larger(next, there) : smaller(next, there);
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  template <class T, class S>
  static int settle(const Params<T>& p, const At<S>& at) {
    int who = turned;
    if (value(margin(p, at, who)) >= 0) return at.piece;
    return placed(p, at);
  }

 private:
  /// The piece that holds both speeds.
  template <class T, class S>
  static int placed(const Params<T>& p, const At<S>& at) {
    const List ratios = list_of(p.speed_ratio, at.points);
    const auto base = value(at.rates[Way::base]), follower = value(at.rates[Way::follower]);
    const bool by_base = abs(base) >= abs(follower);
    const auto fast = by_base ? base : follower, slow = by_base ? follower : base;
    return ratio_piece(ratios, fast == 0 ? decltype(fast)(0) : slow / fast) + (by_base ? 0 : ratios.count);
  }
  /// k at point i.
  template <class T>
  static T factor(const Params<T>& p, const auto* points, int i) {
    if (common(p.capacity.count) > 1) return T(list_of(p.capacity, points)[i]);
    const T d = p.diameter;
    return T(list_of(p.performance_number, points)[i]) * p.density * d * d * d * d * d;
  }
};

}  // namespace clutchwork::elements
