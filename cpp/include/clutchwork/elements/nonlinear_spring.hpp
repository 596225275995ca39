#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/elastic_contact.hpp>
#include <clutchwork/components/stretch.hpp>

namespace clutchwork::elements {

/// Spring whose torque is a table over its twist, and a damper beside it. docs/theory/compliance.md (9)
struct NonlinearSpring : declared::NonlinearSpring {
  template <class T>
  struct Params {
    Curve<T> torque;  ///< rad -> N m
    T damping;        ///< [N m s/rad]
  };

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return -(curve_value(p.torque, at.points, at.state[twist], at.piece) + p.damping * at.rate);
  }
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    return p.damping * at.rate * at.rate;
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[twist] = at.rate;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    LeastGuard<S> guards;
    each_end(p.torque, at.points, at.state[twist], at.piece, [&](const S& g, int next) { guards.watch(g, next); });
    who = guards.who;
    return guards.least + guards.change;
  }
  template <class T>
  static int cross(const Params<T>&, const At<T>& at, int who, T*) {
    return who == turned ? at.piece : who;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    return stretch_of(p.torque, at.points, value(at.state[twist]), at.piece);
  }
};

}  // namespace clutchwork::elements
