#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Friction plates: load = gain * derating * (pressure - threshold), with wear and faults. docs/theory/clutches.md
struct PlateContact {
  template <class T>
  struct Params {
    T gain;         ///< [m3]
    T threshold;    ///< [Pa]
    T worn;         ///< [1]
    T running_in;   ///< [m]
    T touch_shift;  ///< [Pa/m]
    T reversed;     ///< [1]
    T fault;        ///< [1] number of the kind of fault
    T report;       ///< [1] number of the kind of report
  };
  enum Input : int { pressure, wear, fault_signal, fault_time };
  static constexpr int states = 0;
  static constexpr int inputs = 4;
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>& at) {
    const S depth = larger(at.input[wear], S(0));
    const S derating = p.worn + (T(1) - p.worn) * exp(-depth / p.running_in);
    const S side = S(value(p.reversed) != 0 ? -1 : 1);
    return p.gain * derating * (side * at.input[pressure] - p.threshold - p.touch_shift * depth);
  }
  template <class T>
  static T fault(const Params<T>&, const At<T>& at) {
    return larger(at.input[fault_signal], at.input[fault_time]) - T(0.5);
  }
  template <class T>
  static int fault_kind(const Params<T>& p) {
    return int(value(p.fault));
  }
  template <class T>
  static int fault_report(const Params<T>& p) {
    return int(value(p.report));
  }
};

}  // namespace clutchwork::elements
