#pragma once
#include <clutchwork/component.hpp>

namespace clutchwork::elements {

/// Viscosity and density of an oil at its temperature. docs/theory/hydraulics.md (1)
struct HydraulicOil : declared::HydraulicOil {
  template <class T>
  struct Params {
    T viscosity_40;   ///< [m2/s]
    T viscosity_100;  ///< [m2/s]
    T density_15;     ///< [kg/m3]
    T expansion;      ///< [1/K]
    T lag;            ///< [s]
  };

  template <class T, class S>
  static void state_rates(const Params<T>& p, const At<S>& at, S* rates) {
    const S given = at.input[Input::temperature], kelvin = value(given) < coldest ? S(coldest) : given;
    const T cold = twice_log(p.viscosity_40), warm = twice_log(p.viscosity_100);
    const T slope = (cold - warm) / T(log(373.15 / 313.15));
    const S thick = exp(exp(S(cold) - slope * log(kelvin / T(313.15)))) - T(0.7);
    rates[viscosity] = (thick - at.state[viscosity]) / p.lag;
    rates[density] = (p.density_15 * (S(1) - p.expansion * (kelvin - T(288.15))) - at.state[density]) / p.lag;
  }

 private:
  /// Below it oil is solid, and the law has no finite value. [K]
  static constexpr double coldest = 200;

  /// The states are in mm2/s, in which the law was written.
  template <class T>
  static T twice_log(const T& viscosity) {
    return log(log(T(1e6) * viscosity + T(0.7)));
  }
};

}  // namespace clutchwork::elements
