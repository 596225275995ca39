#pragma once
#include <clutchwork/components/component.hpp>
#include <clutchwork/run/integrator/dopri5.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>
#include <clutchwork/workspace/settings.hpp>

/// The integrators. Each tells whether it is made for stiff motion, algebraic speeds included, with what share of the
/// step before an event it starts after it, and up to how many own states it is compiled for the small dense forms too.
/// docs/theory/integrators.md
namespace clutchwork {

template <class... Integrators>
struct MethodList {
  static constexpr int count = sizeof...(Integrators);
};

/// Every Method but `auto` and `fixed`, which has no phases: a new integrator is its header, a line here and its name
/// in declare/layout.py.
using Methods = MethodList<Rodas5P, Dopri5>;
static_assert(Methods::count + 1 == last_method && int(Method::fixed) == last_method,
              "run/methods.hpp: as many integrators as Method names");

/// Call f with the tag of the integrator behind a method; nothing for `auto`.
template <class F>
void visit_method(Method method, F&& f) {
  auto visit = [&]<class... Integrators>(MethodList<Integrators...>) {
    ((method == Integrators::method ? f(Tag<Integrators>{}) : void()), ...);
  };
  visit(Methods{});
}

inline bool is_for_stiff(Method method) {
  bool stiff = false;
  visit_method(method, [&](auto tag) { stiff = decltype(tag)::type::stiff; });
  return stiff;
}
/// Most own states of the small forms that it is compiled for, -1: for none.
inline int most_small_states(Method method) {
  int most = -1;
  visit_method(method, [&](auto tag) { most = decltype(tag)::type::most_small_states; });
  return most;
}

/// The first method that is made for stiff motion, or for soft motion.
inline Method first_method(bool stiff) {
  int number = 1;
  while (number < Methods::count && is_for_stiff(Method(number)) != stiff) ++number;
  return Method(number);
}

}  // namespace clutchwork
