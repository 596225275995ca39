#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/regions.hpp>
#include <clutchwork/components/speed_ratio.hpp>

namespace clutchwork::elements {

/// Torque converter. Pieces: the intervals of the table while the impeller drives; the same while the turbine overruns
/// it; the turbine alone, its impeller turning back; neither; the intervals again, while the impeller drives and the
/// oil still carries a torque of coast, which finds the stator running free. docs/theory/coupled.md
struct TorqueConverter : declared::TorqueConverter {
  template <class T>
  struct Params {
    Curve<T> speed_ratio;     ///< 1
    Curve<T> torque_ratio;    ///< 1
    Curve<T> capacity;        ///< N m s2/rad2
    Curve<T> k_factor;        ///< rad/s
    Curve<T> coast_capacity;  ///< N m s2/rad2
    T lag;                    ///< [s]
  };
  enum Who : int { down, up, back, stop, catches };

  template <class T, class S>
  static void torques(const Params<T>& p, const At<S>& at, OwnTorques<S> torque) {
    const S taken = value(p.lag) > 0 ? at.state[impeller_torque] : statically(p, at);
    torque[Way::impeller] = -taken;
    torque[Way::turbine] = multiplied(p, at) * taken;
    torque[Way::slip] = S(0);
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    if (value(p.lag) > 0) rates[impeller_torque] = (statically(p, at) - at.state[impeller_torque]) / p.lag;
  }
  template <class T>
  static int count(const Params<T>& p) {
    return value(p.lag) > 0 ? 1 : 0;
  }
  template <class T>
  static bool fits(const Params<T>& p) {
    auto size = [](const Curve<T>& c) { return int(common(c.count)); };
    const int n = size(p.speed_ratio), coast = size(p.coast_capacity);
    const bool drive = size(p.capacity) == n || (size(p.capacity) == 1 && size(p.k_factor) == n - 1);
    return n >= 2 && size(p.torque_ratio) == n && drive && (coast == n || coast == 1);
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const List ratios = list_of(p.speed_ratio, at.points);
    const S &w = at.rates[Way::impeller], &t = at.rates[Way::turbine], &slip = at.rates[Way::slip];
    // near rest, where the torques vanish, round-off does not change the piece
    const auto size = abs(value(w)) + abs(value(t)) + 1.0;
    const int n = ratios.count, piece = without_stator(n, at.piece), i = piece % n;
    Least<S> least(who);
    auto watch = [&](const S& guard, int number) { least.watch(guard / S(size), number); };
    if (piece != at.piece)
      least.watch(-at.state[impeller_torque] / S(abs(value(at.state[impeller_torque])) + 1.0), catches);
    if (piece < n) {
      watch(w, stop);
      if (i > 0) watch(t - S(ratios[i - 1]) * w, down);
      watch(-(slip + S(1.0 - ratios[i]) * w), up);
    } else if (piece < 2 * n) {
      i > 0 && ratios[i - 1] > 0 ? watch(w - S(ratios[i - 1]) * t, down) : watch(w, back);
      watch(slip - S(1.0 - ratios[i]) * t, up);
    } else if (piece == 2 * n) {
      watch(-w, back), watch(t, stop);
    } else {
      watch(-w, back), watch(-t, stop);
    }
    return least.margin();
  }
  template <class T, class S>
  static int cross(const Params<T>& p, const At<S>& at, int who, S*) {
    const List ratios = list_of(p.speed_ratio, at.points);
    const int piece = without_stator(ratios.count, at.piece);
    return who == catches ? piece : with_stator(p, at, next_piece(ratios, at, piece, who));
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  template <class T, class S>
  static int settle(const Params<T>& p, const At<S>& at) {
    int who = 0;
    const List ratios = list_of(p.speed_ratio, at.points);
    const int n = ratios.count;
    if (value(margin(p, at, who)) >= 0) return with_stator(p, at, without_stator(n, at.piece));
    const auto w = value(at.rates[Way::impeller]), t = value(at.rates[Way::turbine]);
    if (w < 0) return t > 0 ? 2 * n : 2 * n + 1;
    if (value(at.rates[Way::slip]) > 0) return n + ratio_piece(ratios, w / t);
    return with_stator(p, at, drives(ratios, at));
  }

 private:
  /// The piece behind the guard `who` of one, where the stator holds.
  template <class S>
  static int next_piece(const auto& ratios, const At<S>& at, int piece, int who) {
    const int n = ratios.count, last = n - 1, alone = 2 * n, none = 2 * n + 1;
    if (piece == none) return who == stop ? alone : drives(ratios, at);
    if (piece == alone) return who == stop ? none : n + ratio_piece(ratios, 0);
    if (who == back) return alone;
    if (who == stop) return none;
    // near rest several pieces are passed at once
    const int zone = piece < n ? 0 : n, now = piece - zone, there = zone == 0 ? drives(ratios, at) : now;
    if (who == down) return zone + (there < now ? there : now - 1);
    if (now < last) return zone + (there > now ? there : now + 1);
    return zone == 0 ? n + last : last;
  }
  /// Torque that the impeller takes up at rest of the oil; below zero where the turbine drives it.
  template <class T, class S>
  static S statically(const Params<T>& p, const At<S>& at) {
    const List ratios = list_of(p.speed_ratio, at.points);
    const S &w = at.rates[Way::impeller], &t = at.rates[Way::turbine], &slip = at.rates[Way::slip];
    const int n = ratios.count;
    const int piece = without_stator(n, at.piece);
    if (piece > 2 * n || vanishes(piece < n ? w : t) || is_leaving(at, piece)) return S(0);
    if (piece == 2 * n) {
      // as if the impeller stood
      const int i = ratio_piece(ratios, 0);
      return -over_ratio(ratios, i, S(-1), [&](int k) { return coasting(p, at.points, k); }) * t * t;
    }
    if (piece < n) return w * w * over_ratio(ratios, piece, slip / w, [&](int k) { return driving(p, at.points, k); });
    return -t * t * over_ratio(ratios, piece - n, -slip / t, [&](int k) { return coasting(p, at.points, k); });
  }
  /// A piece by its ratio alone, whatever the stator does.
  static int without_stator(int n, int piece) { return piece > 2 * n + 1 ? piece - (2 * n + 2) : piece; }
  /// The same while the stator runs free, where the oil carries a torque of coast.
  template <class T, class S>
  static int with_stator(const Params<T>& p, const At<S>& at, int piece) {
    const int n = list_of(p.speed_ratio, at.points).count;
    const bool free = piece < n && value(p.lag) > 0 && value(at.state[impeller_torque]) < 0;
    return free ? piece + (2 * n + 2) : piece;
  }
  /// The piece that holds the ratio while the impeller drives.
  template <class S>
  static int drives(const auto& ratios, const At<S>& at) {
    const auto w = value(at.rates[Way::impeller]), t = value(at.rates[Way::turbine]);
    if (value(at.rates[Way::slip]) == 0) return ratios.count - 1;
    return w > 0 ? ratio_piece(ratios, t / w) : 0;
  }
  /// On the way from rest with both sides held together: before its guard tells, the piece is still that of stall.
  template <class S>
  static bool is_leaving(const At<S>& at, int piece) {
    return piece == 0 && at.rates[Way::slip] == S(0);
  }
  /// Whether both sides stand, to the round-off with which locked contacts and transmissions hold them: there is no
  /// ratio of their speeds.
  template <class S>
  static bool rests(const At<S>& at) {
    constexpr double standing = 1e-9;
    return abs(value(at.rates[Way::impeller])) + abs(value(at.rates[Way::turbine])) < standing;
  }
  /// Torque of the turbine over that of the impeller.
  template <class T, class S>
  static S multiplied(const Params<T>& p, const At<S>& at) {
    const List ratios = list_of(p.speed_ratio, at.points);
    const S& w = at.rates[Way::impeller];
    // beside an impeller that is held still there is no ratio either
    if (at.piece >= ratios.count || vanishes(w) || rests(at) || is_leaving(at, at.piece)) return S(1);
    const List m = list_of(p.torque_ratio, at.points);
    return over_ratio(ratios, at.piece, at.rates[Way::slip] / w, [&](int k) { return m[k]; });
  }
  /// k at point i.
  template <class T, class G>
  static G driving(const Params<T>& p, const G* points, int i) {
    if (common(p.capacity.count) > 1) return list_of(p.capacity, points)[i];
    const List k = list_of(p.k_factor, points);
    return i < k.count ? G(1) / (k[i] * k[i]) : G(0);
  }
  template <class T, class G>
  static G coasting(const Params<T>& p, const G* points, int i) {
    return common(p.coast_capacity.count) > 1 ? list_of(p.coast_capacity, points)[i] : driving(p, points, i);
  }
};

}  // namespace clutchwork::elements
