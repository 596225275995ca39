#pragma once
#include <clutchwork/components/component.hpp>
#include <clutchwork/components/stribeck_curve.hpp>

/// Bristles that bend under the slip, what LuGre and its elastic-plastic variant share. Law::bending gives the rate of
/// the deflection [rad/s]; the state is the elastic part of the coefficient, stiffness times deflection.
namespace clutchwork {

template <class Law>
struct Bristles {
  template <class P, class S>
  static S coefficient(const P& p, const At<S>& at) {
    return at.state[0] + p.damping * Law::bending(p, at) + p.viscous * at.rate;
  }
  template <class P, class S>
  static void state_rates(const P& p, const At<S>& at, S* rates) {
    rates[0] = p.stiffness * Law::bending(p, at);
  }
  template <class P, class T>
  static T hold(const P& p, const At<T>&) {
    return p.static_;
  }
};

}  // namespace clutchwork
