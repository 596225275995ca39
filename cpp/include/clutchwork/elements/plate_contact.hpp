#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Friction plates: load = gain * derating * (pressure - threshold), with wear and faults. docs/theory/clutches.md
struct PlateContact : declared::PlateContact {
  template <class T>
  struct Params {
    T gain;                          ///< [m3]
    T threshold;                     ///< [Pa]
    T worn;                          ///< [1]
    T running_in;                    ///< [m]
    T touch_shift;                   ///< [Pa/m]
    T reversed;                      ///< [1]
    Word<T, choice::Fault> fault;    ///< [1]
    Word<T, choice::Report> report;  ///< [1]
  };
  static constexpr bool one_way = false;

  template <class T, class S>
  static S load(const Params<T>& p, const At<S>& at) {
    const S depth = larger(at.input[Input::wear], S(0));
    const S derating = p.worn + (T(1) - p.worn) * exp(-depth / p.running_in);
    const S side = S(value(p.reversed) != 0 ? -1 : 1);
    return p.gain * derating * (side * at.input[Input::pressure] - p.threshold - p.touch_shift * depth);
  }
  template <class T>
  static T fault(const Params<T>&, const At<T>& at) {
    return larger(at.input[Input::fault_signal], at.input[Input::fault_time]) - T(0.5);
  }
  template <class T>
  static choice::Fault fault_kind(const Params<T>& p) {
    return p.fault;
  }
  template <class T>
  static choice::Report fault_report(const Params<T>& p) {
    return p.report;
  }
};

}  // namespace clutchwork::elements
