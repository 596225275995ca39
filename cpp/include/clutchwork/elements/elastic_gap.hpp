#pragma once
#include <clutchwork/component.hpp>
#include <clutchwork/components/elastic_contact.hpp>

namespace clutchwork::elements {

/// Spring and damper that only push. docs/theory/play.md
struct ElasticGap : declared::ElasticGap {
  template <class T>
  struct Params {
    T stiffness;  ///< [N m/rad]
    T damping;    ///< [N m s/rad]
  };
  // apart, then pressed as each Touch
  enum Piece : int { apart, pressed };

  template <class T, class S>
  static ElasticContact<S> contact(const Params<T>& p, const At<S>& at) {
    return {-p.stiffness * at.state[gap], -p.damping * at.rate, -at.rate, value(p.damping), true};
  }
  static Touch touch(int piece) { return Touch(piece - pressed); }

  template <class T, class S>
  static S torque(const Params<T>& p, const At<S>& at) {
    return at.piece == apart ? S(0) : contact(p, at).push(touch(at.piece));
  }
  template <class T, class S>
  static S heat(const Params<T>& p, const At<S>& at) {
    if (at.piece == apart) return S(0);
    const ElasticContact<S> c = contact(p, at);
    return (c.push(touch(at.piece)) - c.spring) * c.closing;
  }
  template <class T, class S>
  static void state_rates(const Params<T>&, const At<S>& at, S* rates) {
    rates[gap] = at.rate;
  }

  template <class T, class S>
  static S margin(const Params<T>& p, const At<S>& at, int& who) {
    LeastGuard<S> guards;
    if (at.piece == apart) {
      guards.watch(at.state[gap], pressed);
    } else {
      guards.watch(-at.state[gap], apart);
      contact(p, at).each_limit(touch(at.piece),
                                [&](const S& guard, Touch next) { guards.watch(guard, pressed + int(next)); });
    }
    who = guards.who;
    return guards.least + guards.change;
  }
  template <class T>
  static int cross(const Params<T>& p, const At<T>& at, int who, T*) {
    if (who == turned) return at.piece;
    return at.piece == apart && who != apart ? pressed + int(contact(p, at).touch()) : who;
  }
  template <class T>
  static bool turns(const Params<T>&, int) {
    return false;
  }
  /// What is pressed stays so until its guard says otherwise.
  template <class T>
  static int settle(const Params<T>& p, const At<T>& at) {
    if (at.piece == apart && value(at.state[gap]) >= 0) return apart;
    return pressed + int(contact(p, at).touch());
  }
};

}  // namespace clutchwork::elements
