#pragma once
#include <clutchwork/components/regions.hpp>

namespace clutchwork::elements {

/// Torque of a combustion engine over speed and throttle, with its controls. docs/theory/sources.md (7)
struct EngineTorque : declared::EngineTorque {
  template <class T>
  struct Params {
    Curve<T> speeds;                   ///< rad/s
    Curve<T> throttles;                ///< 1
    Curve<T> torques;                  ///< N m
    Curve<T> deficit;                  ///< N m
    T stall_speed;                     ///< [rad/s]
    T lag;                             ///< [s]
    T governed;                        ///< [1]
    T idle_speed;                      ///< [rad/s]
    T idle_gain;                       ///< [s/rad]
    T idle_integral;                   ///< [1/rad]
    T idle_limit;                      ///< [1]
    Word<T, choice::Limiter> limiter;  ///< [1]
    T max_speed;                       ///< [rad/s]
    T limit_band;                      ///< [rad/s]
    T charged;                         ///< [1]
    T boost_lag;                       ///< [s]
    T ripples;                         ///< [1]
    Curve<T> orders;                   ///< 1
    Curve<T> amplitudes;               ///< 1
    Curve<T> phases;                   ///< rad
  };
  // the integral of the idle control rests at its lower end, its output is clipped there, moves, is clipped at the
  // upper end, where at last the integral rests too
  enum Idle : int { rest, low, moving, high, full, idles };
  // what sets the throttle
  enum Chosen : int { by_throttle, by_idle, by_limit, choices };

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const Place x(p, at.piece);
    const Row<T, S> row(p, at, x);
    // what the drag is at rest a contact has
    const S drag = S(x.side) * (row.at(0) - S(row.torques[0]));
    if (x.side < 0 || value(row.grid[x.cell]) < value(p.stall_speed)) return drag;
    const S u = reached(p, at, x);
    S burning = row.between(x.column, u) - row.at(0);
    if (value(p.charged) != 0) burning -= (S(1) - own(p, at, boost)) * u * row.deficit();
    return drag + burning * wave(p, at);
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const Place x(p, at.piece);
    int i = 0;
    if (value(p.lag) > 0) rates[i++] = (command(p, at, x) - own(p, at, opening)) / p.lag;
    if (value(p.governed) != 0) {
      const bool held = x.idle == rest || x.idle == full;
      rates[i++] = held ? S(0) : p.idle_integral * (p.idle_speed - at.rate);
    }
    if (value(p.charged) != 0) rates[i++] = (reached(p, at, x) - own(p, at, boost)) / p.boost_lag;
    if (value(p.ripples) != 0) rates[i] = at.rate;
  }
  template <class T>
  static int count(const Params<T>& p) {
    return place_of(p, states);
  }

  template <class T>
  static int edges(const Params<T>& p) {
    return Mirrored{count_of(p.speeds)}.borders();
  }
  template <class T>
  static auto edge(const Params<T>& p, const auto* points, int i) {
    return Mirrored{count_of(p.speeds)}.border(NumberList(p.speeds, points), i);
  }
  template <class T>
  static bool fits(const Params<T>& p) {
    const double rows = value(p.speeds.count), waves = value(p.orders.count);
    return value(p.throttles.count) >= 2 && value(p.torques.count) == rows * value(p.throttles.count) &&
           value(p.deficit.count) == rows && value(p.amplitudes.count) == waves && value(p.phases.count) == waves;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const Place x(p, at.piece);
    Least<S> least(who);
    if (value(p.governed) != 0) watch_idle(p, at, x, least);
    watch_choice(p, at, x, least);
    if (p.limiter == choice::Limiter::cut) {
      const S room = S(p.max_speed) - at.rate, size = S(T(1) / p.max_speed);
      least.watch((x.cut != 0 ? S(p.limit_band) - room : room) * size, x.cut != 0 ? burns : cuts);
    }
    const NumberList columns(p.throttles, at.points);
    const S u = given(p, at, x);
    if (x.column > 0) least.watch(u - S(columns[x.column - 1]), closer);
    if (x.column < columns.count) least.watch(S(columns[x.column]) - u, wider);
    return least.margin();
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T* state) {
    Place x(p, at.piece);
    if (who != turned) x.go(who);
    // the integral rests on its end to the last bit
    const int i = place_of(p, idle);
    if (who == rest) state[i] = T(0);
    if (who == full) state[i] = p.idle_limit;
    return settle(p, At<T>{at.rate, state, at.input, x.number(p), at.points});
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  /// Of the highest order of the ripple.
  template <class T>
  static T pace(const Params<T>& p, const At<T>& at) {
    if (value(p.ripples) == 0) return T(0);
    const NumberList orders(p.orders, at.points);
    return abs(at.rate) * T(orders[orders.count - 1]);
  }
  /// From the present place on, as long as a guard is clearly passed.
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    constexpr int most = 100;
    Place x(p, at.piece);
    if (value(p.governed) != 0 && x.idle == rest && value(own(p, at, idle)) > border_slack) x.idle = moving;
    for (int round = 0; round < most; ++round) {
      int who = turned;
      const T left = margin(p, At<T>{at.rate, at.state, at.input, x.number(p), at.points}, who);
      if (who == turned || value(left) >= -border_slack) break;
      x.go(who);
    }
    return x.number(p);
  }

 private:
  static constexpr double ripple_band = 1;  // [rad/s]
  // who leaves a piece: where the idle control goes, then what is chosen, then the others
  static constexpr int chosen = idles, burns = chosen + choices, cuts = burns + 1, closer = cuts + 1,
                       wider = closer + 1;

  template <class T>
  static int count_of(const Curve<T>& c) {
    return int(common(c.count));
  }
  /// Place of a state among those in use, or how many there are.
  template <class T>
  static int place_of(const Params<T>& p, int state) {
    const bool used[] = {value(p.lag) > 0, value(p.governed) != 0, value(p.charged) != 0, value(p.ripples) != 0};
    int n = 0;
    for (int i = 0; i < state; ++i) n += used[i];
    return n;
  }
  template <class T, class S>
  static S own(const Params<T>& p, const At<S>& at, int state) {
    return at.state[place_of(p, state)];
  }

  /// What the number of a piece stands for.
  struct Place {
    int speed, idle, choice, cut, column;
    int side, cell;

    template <class T>
    Place(const Params<T>& p, int piece) {
      const Mirrored grid{count_of(p.speeds)};
      speed = piece % grid.intervals(), piece /= grid.intervals();
      idle = piece % idles, piece /= idles;
      choice = piece % choices, piece /= choices;
      cut = piece % 2, piece /= 2;
      column = piece % (count_of(p.throttles) + 1);
      side = grid.side(speed), cell = grid.cell(speed);
    }
    template <class T>
    int number(const Params<T>& p) const {
      return speed + 2 * count_of(p.speeds) * (idle + idles * (choice + choices * (cut + 2 * column)));
    }
    void go(int who) {
      if (who < idles) {
        idle = who;
      } else if (who < burns) {
        choice = who - chosen;
      } else if (who <= cuts) {
        cut = who == cuts;
      } else {
        column += who == wider ? 1 : -1;
      }
    }
  };

  /// Torques over the throttle at one speed.
  template <class T, class S>
  struct Row {
    const Params<T>& p;
    const Point<S>* points;
    const NumberList<Point<S>> grid, columns, torques;
    int cell;
    S share;

    Row(const Params<T>& params, const At<S>& at, const Place& x)
        : p(params),
          points(at.points),
          grid(p.speeds, points),
          columns(p.throttles, points),
          torques(p.torques, points),
          cell(x.cell),
          share(share_of_cell(grid, x.cell, S(x.side) * at.rate)) {}

    S at(int column) const {
      return value_in_cell(grid.count, cell, share, [&](int i) { return torques[i * columns.count + column]; });
    }
    S between(int interval, const S& u) const {
      if (interval == 0) return at(0);
      if (interval >= columns.count) return at(columns.count - 1);
      const S low = at(interval - 1), high = at(interval);
      return low + (high - low) * (u - S(columns[interval - 1])) / S(columns[interval] - columns[interval - 1]);
    }
    S deficit() const {
      const NumberList lack(p.deficit, points);
      return value_in_cell(grid.count, cell, share, [&](int i) { return lack[i]; });
    }
  };

  /// Factor of the burning part over the crank angle. A ripple that makes it negative comes in over a band of speeds
  /// above the one from which on it burns: else it would hold the engine there, switching on and off.
  template <class T, class S>
  static S wave(const Params<T>& p, const At<S>& at) {
    S sum = S(1);
    if (value(p.ripples) == 0) return sum;
    const NumberList orders(p.orders, at.points), sizes(p.amplitudes, at.points), phases(p.phases, at.points);
    const S angle = own(p, at, crank);
    Real<S> most = 0;
    for (int i = 0; i < orders.count; ++i) {
      sum += S(sizes[i]) * cos(S(orders[i]) * angle + S(phases[i]));
      most += abs(value(sizes[i]));
    }
    const S above = at.rate - S(p.stall_speed);
    if (most <= 1 || value(above) >= ripple_band) return sum;
    return S(1) + (sum - S(1)) * above / T(ripple_band);
  }

  /// Output of the idle control before it is clipped, and after it.
  template <class T, class S>
  static S idle_sum(const Params<T>& p, const At<S>& at) {
    return p.idle_gain * (S(p.idle_speed) - at.rate) + own(p, at, idle);
  }
  template <class T, class S>
  static S idle_throttle(const Params<T>& p, const At<S>& at, const Place& x) {
    if (value(p.governed) == 0 || x.idle < moving) return S(0);
    return x.idle == moving ? idle_sum(p, at) : S(p.idle_limit);
  }
  /// Largest throttle that the limiter leaves.
  template <class T, class S>
  static S most(const Params<T>& p, const At<S>& at, const Place& x) {
    if (p.limiter == choice::Limiter::cut) return S(1 - x.cut);
    const NumberList grid(p.speeds, at.points);
    const auto start = value(grid[x.cell]);
    if (x.side < 0 || start < value(p.max_speed) - value(p.limit_band)) return S(1);
    return start < value(p.max_speed) ? (S(p.max_speed) - at.rate) / p.limit_band : S(0);
  }
  /// The throttle that is wanted, that which has come through, and that within the grid.
  template <class T, class S>
  static S command(const Params<T>& p, const At<S>& at, const Place& x) {
    if (x.choice == by_throttle) return at.input[Input::throttle];
    return x.choice == by_idle ? idle_throttle(p, at, x) : most(p, at, x);
  }
  template <class T, class S>
  static S given(const Params<T>& p, const At<S>& at, const Place& x) {
    return value(p.lag) > 0 ? own(p, at, opening) : command(p, at, x);
  }
  template <class T, class S>
  static S reached(const Params<T>& p, const At<S>& at, const Place& x) {
    const NumberList columns(p.throttles, at.points);
    if (x.column == 0) return S(columns[0]);
    return x.column < columns.count ? given(p, at, x) : S(columns[columns.count - 1]);
  }

  template <class T, class S>
  static void watch_idle(const Params<T>& p, const At<S>& at, const Place& x, Least<S>& least) {
    const S missing = (S(p.idle_speed) - at.rate) / p.idle_speed, sum = idle_sum(p, at), i = own(p, at, idle);
    const S top = S(p.idle_limit);
    // without a share of the speed in it the output ends where the integral does
    const bool plain = value(p.idle_gain) == 0;
    if (x.idle == rest) least.watch(-missing, moving);
    if (x.idle == low) least.watch(-sum, moving), least.watch(i, rest);
    if (x.idle == moving) {
      least.watch(sum, plain || value(i) <= border_slack ? rest : low);
      least.watch(top - sum, plain || value(top - i) <= border_slack ? full : high);
    }
    if (x.idle == high) least.watch(sum - top, moving), least.watch(top - i, full);
    if (x.idle == full) least.watch(missing, moving);
  }
  template <class T, class S>
  static void watch_choice(const Params<T>& p, const At<S>& at, const Place& x, Least<S>& least) {
    const bool governed = value(p.governed) != 0, limited = p.limiter != choice::Limiter::none;
    const S wanted = at.input[Input::throttle], idle = idle_throttle(p, at, x);
    const bool more = governed && idle > wanted;
    if (x.choice == by_throttle && governed) least.watch(wanted - idle, chosen + by_idle);
    if (x.choice == by_idle) least.watch(idle - wanted, chosen + by_throttle);
    if (!limited) return;
    const S end = most(p, at, x);
    if (x.choice == by_limit) {
      least.watch((more ? idle : wanted) - end, chosen + (more ? by_idle : by_throttle));
    } else {
      least.watch(end - (x.choice == by_idle ? idle : wanted), chosen + by_limit);
    }
  }
};

}  // namespace clutchwork::elements
