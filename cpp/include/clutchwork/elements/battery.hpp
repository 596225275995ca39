#pragma once
#include <clutchwork/components/regions.hpp>

namespace clutchwork::elements {

/// Charge and energies of a battery on a DC link. docs/theory/sources.md (10) to (12)
struct Battery : declared::Battery {
  template <class T>
  struct Params {
    Curve<T> charges;        ///< 1
    Curve<T> voltages;       ///< V
    Curve<T> resistances;    ///< ohm
    T capacity;              ///< [A s]
    T max_current;           ///< [A]
    T max_charging_current;  ///< [A]
  };

  // a piece is a cell of the tables: 0 below the first charge, where it is empty, the last one where it is full
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const NumberList grid(p.charges, at.points), voltages(p.voltages, at.points), ohms(p.resistances, at.points);
    const int n = grid.count, cell = at.piece < n ? at.piece : n;
    const S q = at.state[charge] / p.capacity;
    // held beyond the ends
    const int from = cell == 0 ? 0 : cell == n ? n - 1 : cell - 1;
    const S share = cell == 0 || cell == n ? S(0) : share_of_cell(grid, from, q);
    const S u = value_in_cell(n, from, share, [&](int i) { return voltages[i]; });
    const S r = value_in_cell(n, from, share, [&](int i) { return ohms[i]; });
    const S asked = at.input[Input::load] + at.input[Input::second_load] + at.input[Input::third_load] +
                    at.input[Input::fourth_load];
    const S wanted = current_of(u, r, asked), i = limited(p, wanted, cell == 0, cell == n);
    const bool serves = value(i) == value(wanted) && has_current(u, r, asked);
    rates[charge] = -i;
    rates[energy] = u * i;
    rates[loss] = r * i * i;
    // exactly nothing, no round-off of a difference
    const S left = serves ? S(0) : asked - (u - r * i) * i;
    rates[unserved] = larger(left, S(0));
    rates[refused] = larger(-left, S(0));
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const NumberList grid(p.charges, at.points);
    const int n = grid.count, cell = at.piece < n ? at.piece : n;
    const S q = at.state[charge] / p.capacity;
    // an empty or a full one is left a little further on, so that it is not entered again at once
    const S down = cell == 0 ? S(1e300) : q - S(grid[cell - 1]) + S(cell == n ? aside : 0);
    const S up = cell == n ? S(1e300) : S(grid[cell]) - q + S(cell == 0 ? aside : 0);
    who = value(down) < value(up) ? falls : rises;
    return who == falls ? down : up;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int who, T*) {
    return at.piece + (who == rises ? 1 : -1);
  }

 private:
  enum Who : int { falls, rises };
  static constexpr double aside = 1e-9;

  /// Current that gives a power: the smaller root; where there is none, that of the most power.
  template <class S>
  static S current_of(const S& u, const S& r, const S& power) {
    // at the most power the root has no slope
    if (!has_current(u, r, power)) return u / (S(2) * r);
    return S(2) * power / (u + sqrt(u * u - S(4) * r * power));
  }
  template <class S>
  static bool has_current(const S& u, const S& r, const S& power) {
    return value(u * u - S(4) * r * power) > 1e-14 * value(u * u);
  }
  template <class T, class S>
  static S limited(const Params<T>& p, const S& i, bool empty, bool full) {
    const S high = empty ? S(0) : S(p.max_current), low = full ? S(0) : S(-p.max_charging_current);
    return larger(smaller(i, high), low);
  }
};

}  // namespace clutchwork::elements
