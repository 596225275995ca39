#pragma once
#include <clutchwork/components/regions.hpp>

namespace clutchwork::elements {

/// Torque of an electric motor: a command, clipped to what speed and temperature allow; its losses.
/// docs/theory/sources.md (5)
struct MotorTorque : declared::MotorTorque {
  template <class T>
  struct Params {
    Curve<T> speeds;                ///< rad/s
    Curve<T> motoring;              ///< N m
    Curve<T> generating;            ///< N m
    T motor_power;                  ///< [W]
    T generator_power;              ///< [W]
    Curve<T> torques;               ///< N m
    Curve<T> map;                   ///< 1
    Word<T, choice::MapOf> map_of;  ///< [1]
    T no_load_loss;                 ///< [W]
    T drag_loss;                    ///< [W s/rad]
    T iron_loss;                    ///< [W s2/rad2]
    T copper_loss;                  ///< [W/(N2 m2)]
    Curve<T> derating;              ///< K -> 1
    T scale;                        ///< [N m]
    T lag;                          ///< [s]
  };
  // by which limit the command is clipped: of torque or of power, below or above
  enum Clip : int { low_torque, low_power, free, high_torque, high_power, clips };

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    const Place x(p, at.piece);
    if (x.clip == free) return wanted(p, at);
    const Range<S> range(p, at, x);
    return x.clip > free ? range.high(x.clip == high_power) : -range.low(x.clip == low_power);
  }
  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    if (value(p.lag) > 0) rates[request] = (at.input[Input::command] - at.state[request]) / p.lag;
  }
  template <class T>
  static int count(const Params<T>& p) {
    return value(p.lag) > 0 ? 1 : 0;
  }
  /// Losses [W].
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    const Place x(p, at.piece);
    const S f = torque(p, at), w = S(x.side) * at.rate;
    return p.no_load_loss + w * (p.drag_loss + p.iron_loss * w) + p.copper_loss * f * f + mapped(p, at, x, f, w);
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
    const double rows = value(p.speeds.count);
    return value(p.motoring.count) == rows && value(p.generating.count) == rows &&
           value(p.map.count) == rows * value(p.torques.count);
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    const Place x(p, at.piece);
    Least<S> least(who);
    watch_clip(p, at, x, Range<S>(p, at, x, is_held(p, at)), least);
    watch_load(p, at, x, least);
    const int n = warmths(p);
    const NumberList at_kelvin(p.derating, at.points);
    const S warm = at.input[Input::temperature];
    if (n > 1 && x.warmth > 0) least.watch((warm - S(at_kelvin[x.warmth - 1])) * T(1e-2), cooler);
    if (n > 1 && x.warmth + 1 < n) least.watch((S(at_kelvin[x.warmth]) - warm) * T(1e-2), warmer);
    return least.margin();
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T*) {
    Place x(p, at.piece);
    const bool clipped = who != turned && who < clips;
    if (clipped) x.clip = who;
    // at rest as in settle, but for one that passes it, whose torque jumps over the border
    if (who != turned && is_at_rest(p, at) && (!clipped || drives_at_limit(p, at, x))) {
      Place held = x;
      turn(p, at, held);
      const int there = settled_behind(p, at, held, who);
      if (who == less ? held.load < x.load : who != more || held.load > x.load) return there;
    }
    return settled_behind(p, at, x, who);
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  /// The same place as before where it may be kept. At rest the command drives whichever way it points.
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    Place x(p, at.piece);
    if (is_at_rest(p, at)) turn(p, at, x);
    return settled(p, at, x);
  }

 private:
  // who leaves a piece; below `clips`: where the clip goes
  enum Who : int { less = clips, more, cooler, warmer };

  template <class T>
  static int count_of(const Curve<T>& c) {
    return int(common(c.count));
  }
  /// Intervals of the temperature.
  template <class T>
  static int warmths(const Params<T>& p) {
    return count_of(p.derating) > 1 ? count_of(p.derating) + 1 : 1;
  }

  /// Intervals of the torque, where there is a map.
  template <class T>
  static int loads_of(const Params<T>& p) {
    return count_of(p.torques) > 1 ? 2 * count_of(p.torques) : 1;
  }

  /// What the number of a piece stands for.
  struct Place {
    int speed, clip, load, warmth;
    int side, cell;

    template <class T>
    Place(const Params<T>& p, int piece) {
      const Mirrored grid{count_of(p.speeds)};
      const int n = grid.intervals(), loads = loads_of(p);
      speed = piece % n, piece /= n;
      clip = piece % clips, piece /= clips;
      load = piece % loads, warmth = piece / loads % warmths(p);
      side = grid.side(speed), cell = grid.cell(speed);
    }
    template <class T>
    int number(const Params<T>& p) const {
      return speed + 2 * count_of(p.speeds) * (clip + clips * (load + loads_of(p) * warmth));
    }
  };

  /// Limits at a speed and a temperature, as sizes; those of power over it. What is held at rest drives either way.
  template <class S>
  struct Range {
    S w, up, down, up_power, down_power;

    template <class T>
    Range(const Params<T>& p, const At<S>& at, const Place& x, bool held = false) : w(S(x.side) * at.rate) {
      const NumberList grid(p.speeds, at.points), motor(p.motoring, at.points), generator(p.generating, at.points);
      const S share = share_of_cell(grid, x.cell, w);
      const S drives = value_in_cell(grid.count, x.cell, share, [&](int i) { return motor[i]; });
      const S brakes = value_in_cell(grid.count, x.cell, share, [&](int i) { return generator[i]; });
      const S warm = at.input[Input::temperature];
      const S left = held_value(p.derating, at.points, warm, warmths(p) > 1 ? x.warmth : 0);
      const bool forth = held || x.side > 0, back = held || x.side < 0;
      up = left * (forth ? drives : brakes), down = left * (back ? drives : brakes);
      up_power = left * S(forth ? p.motor_power : p.generator_power);
      down_power = left * S(back ? p.motor_power : p.generator_power);
    }
    S high(bool power) const { return power ? up_power / w : up; }
    S low(bool power) const { return power ? down_power / w : down; }
  };

  template <class T>
  static int settled(const Params<T>& p, const At<T>& at, Place& x) {
    const NumberList kelvin(p.derating, at.points), loads(p.torques, at.points);
    const int n = warmths(p);
    if (n > 1) {
      const auto warm = value(at.input[Input::temperature]);
      x.warmth = settled_interval(warm, n - 1, x.warmth, 1e2 * border_slack, [&](int i) { return kelvin[i]; });
    }
    x.clip = settled_clip(p, at, x);
    const auto f = value(torque(p, At<T>{at.rate, at.state, at.input, x.number(p), at.points}));
    const Mirrored grid{count_of(p.torques)};
    const auto slack = border_slack * value(p.scale);
    x.load = settled_interval(f, loads_of(p) - 1, x.load, slack, [&](int i) { return grid.border(loads, i); });
    return x.number(p);
  }

  /// The same behind a border of the map or of the derating.
  template <class T>
  static int settled_behind(const Params<T>& p, const At<T>& at, Place& x, int who) {
    if (who == less || who == more) x.load += who == more ? 1 : -1;
    if (who == cooler || who == warmer) x.warmth += who == warmer ? 1 : -1;
    return settled(p, at, x);
  }

  /// Whether it stands, but for round-off.
  template <class T, class S>
  static bool is_at_rest(const Params<T>& p, const At<S>& at) {
    const NumberList speeds(p.speeds, at.points);
    return abs(value(at.rate)) <= 1e-11 * (1 + value(speeds[speeds.count - 1]));
  }
  /// Whether it stays at rest.
  template <class T, class S>
  static bool is_held(const Params<T>& p, const At<S>& at) {
    constexpr double still = 1e-6;
    if constexpr (requires { at.rate.d; }) {
      if (abs(value(at.rate.d[0])) > still) return false;
    }
    return is_at_rest(p, at);
  }
  /// At rest: whether the command has reached what it may drive with.
  template <class T>
  static bool drives_at_limit(const Params<T>& p, const At<T>& at, const Place& x) {
    const Range<T> range(p, at, x, true);
    return abs(value(wanted(p, at))) >= value(range.up) - border_slack * value(p.scale);
  }
  /// From rest to the side to which the command drives.
  template <class T>
  static void turn(const Params<T>& p, const At<T>& at, Place& x) {
    const bool back = value(wanted(p, at)) < 0;
    x.speed = count_of(p.speeds) - int(back), x.side = back ? -1 : 1, x.cell = 0;
  }

  /// The command where it acts.
  template <class T, class S>
  static S wanted(const Params<T>& p, const At<S>& at) {
    return value(p.lag) > 0 ? at.state[request] : at.input[Input::command];
  }

  /// Loss by the map at a torque f and a speed w >= 0.
  template <class T, class S>
  static S mapped(const Params<T>& p, const At<S>& at, const Place& x, const S& f, const S& w) {
    const NumberList rows(p.speeds, at.points), columns(p.torques, at.points), map(p.map, at.points);
    const Mirrored loads{columns.count};
    const int cell = loads.cell(x.load), sign = loads.side(x.load);
    const S down = share_of_cell(rows, x.cell, w), across = share_of_cell(columns, cell, S(sign) * f);
    const S found = value_in_cell(rows.count, x.cell, down, [&](int i) {
      return value_in_cell(columns.count, cell, across, [&](int j) { return map[i * columns.count + j]; });
    });
    if (p.map_of == choice::MapOf::losses) return found;
    const S power = S(sign) * f * w;
    return sign * x.side > 0 ? power * (S(1) / found - S(1)) : power * (S(1) - found);
  }

  template <class T, class S>
  static void watch_clip(const Params<T>& p, const At<S>& at, const Place& x, const Range<S>& range, Least<S>& least) {
    const S r = wanted(p, at), unit = S(T(1) / p.scale);
    // a guard of power, in the size of a torque
    const S per_speed = unit / S(T(1) + value(range.w));
    if (x.clip == free) {
      least.watch((range.up - r) * unit, high_torque);
      least.watch((range.up_power - r * range.w) * per_speed, high_power);
      least.watch((range.down + r) * unit, low_torque);
      least.watch((range.down_power + r * range.w) * per_speed, low_power);
      return;
    }
    const bool high = x.clip > free, power = x.clip == high_power || x.clip == low_power;
    const S pull = high ? r : -r, most = high ? range.up : range.down, rated = high ? range.up_power : range.down_power;
    const S spare = (rated - most * range.w) * per_speed;
    least.watch(power ? (pull * range.w - rated) * per_speed : (pull - most) * unit, free);
    if (high) least.watch(power ? -spare : spare, power ? high_torque : high_power);
    if (!high) least.watch(power ? -spare : spare, power ? low_torque : low_power);
  }
  /// Borders of the map over the torque.
  template <class T, class S>
  static void watch_load(const Params<T>& p, const At<S>& at, const Place& x, Least<S>& least) {
    const NumberList loads(p.torques, at.points);
    const Mirrored grid{loads.count};
    const S f = torque(p, at), unit = S(T(1) / p.scale);
    if (x.load > 0) least.watch((f - S(grid.border(loads, x.load - 1))) * unit, less);
    if (x.load + 1 < loads_of(p)) least.watch((S(grid.border(loads, x.load)) - f) * unit, more);
  }
  template <class T>
  static int settled_clip(const Params<T>& p, const At<T>& at, const Place& x) {
    const Range<T> range(p, at, x);
    const auto w = value(range.w), r = value(wanted(p, at)), slack = border_slack * value(p.scale);
    // how far a pull is beyond a limit of torque or of power, in the size of a torque
    auto beyond = [&](Real<T> pull, const T& most, const T& rated) {
      return larger(pull - value(most), (pull * w - value(rated)) / (1 + w));
    };
    auto by_power = [&](bool present, bool now, const T& most, const T& rated) {
      const auto spare = (value(rated) - value(most) * w) / (1 + w);
      return present && abs(spare) <= slack ? now : spare < 0;
    };
    const auto above = beyond(r, range.up, range.up_power), below = beyond(-r, range.down, range.down_power);
    const bool was_high = x.clip > free, was_low = x.clip < free;
    if (was_high ? above >= -slack : above > slack && !(was_low && below >= -slack))
      return by_power(was_high, x.clip == high_power, range.up, range.up_power) ? high_power : high_torque;
    if (was_low ? below >= -slack : below > slack)
      return by_power(was_low, x.clip == low_power, range.down, range.down_power) ? low_power : low_torque;
    return free;
  }
};

}  // namespace clutchwork::elements
