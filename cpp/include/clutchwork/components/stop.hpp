#pragma once
#include <clutchwork/components/component.hpp>

namespace clutchwork {

/// What rigid stops have in common: no load, no way of their own.
struct RigidStop {
  static constexpr bool one_way = false;

  template <class P, class S>
  static S load(const P&, const At<S>&) {
    return S(0);
  }
};

}  // namespace clutchwork
