#pragma once
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/run/guards/fault.hpp>
#include <clutchwork/run/guards/gap.hpp>
#include <clutchwork/run/guards/line.hpp>
#include <clutchwork/run/guards/line_flip.hpp>
#include <clutchwork/run/guards/load.hpp>
#include <clutchwork/run/guards/parting.hpp>
#include <clutchwork/run/guards/piece.hpp>
#include <clutchwork/run/guards/process.hpp>
#include <clutchwork/run/guards/set_limit.hpp>
#include <clutchwork/run/guards/table_exit.hpp>
#include <clutchwork/run/guards/torque_limit.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/workspace.hpp>

/// Everything that may happen inside a step: docs/theory/events.md.
///
/// A guard has a name and an effect, for whoever reads of it. It says whether it watches anything in the present modes,
/// where in a step it is first, and what happens then
/// (`settle`). For derivatives it says how it follows from time and state (`at`: zero at the event), over what size it
/// is measured (`scale`) and whose it is (`component`). It may list what it watches where modes begin (`watch`), take
/// the state to where it was hit (`arrive`), know its time derivative (`rate`), and
/// list the borders of pieces that a run may begin on (`each_border`).
namespace clutchwork {

template <class... G>
struct Guarded {
  static constexpr int count = int(sizeof...(G));

  /// Call f(tag, place) for each guard in turn.
  template <class F>
  CLUTCHWORK_INLINE static void each(F&& f) {
    int place = 0;
    (f(Tag<G>{}, place++), ...);
  }
  /// Call f(tag) for the guard at a place.
  template <class F>
  CLUTCHWORK_INLINE static void visit(int place, F&& f) {
    int i = 0;
    ((i++ == place ? f(Tag<G>{}) : void()), ...);
  }
  // what the caller of a run with derivatives knows them by, and what they do
  static constexpr const char* name[] = {G::name...};
  static constexpr Effect effect[] = {G::effect...};
};

// those that cut a step first spare the later ones work; a bend stands before what it bends
using GuardList = Guarded<LineCrossing, PieceEnd, CapacityBend, ProcessEnd, TorqueLimit, SetLimit, Parting, Failure,
                          TableExit, LineFlip, LoadZero, GapEnd>;

/// List what the guards watch in the present modes.
template <class T>
void watch_guards(Workspace<T>& ws) {
  GuardList::each([&](auto tag, int) {
    using G = typename decltype(tag)::type;
    if constexpr (requires { G::watch(ws); }) G::watch(ws);
  });
}

/// First guard that turns negative inside the step. Where a load ends, what gives way before that is looked for once
/// more: behind it, at the end of the step, less may have to be held.
template <class Form>
CLUTCHWORK_INLINE Hit find_hit(Form& form, Step<Form>& step) {
  Hit hit;
  // before guards move the inputs from the end of the step
  list_near_loads(form.ws, step.h);
  for (bool again = false;;) {
    GuardList::each([&](auto tag, int place) CLUTCHWORK_HOT_LAMBDA {
      using G = typename decltype(tag)::type;
      constexpr bool holds = std::is_same_v<G, TorqueLimit> || std::is_same_v<G, SetLimit>;
      if (again && !holds) return;
      hit.asked = place;
      if (G::watches(form.ws)) G::find(form, step, hit);
    });
    if (again || !hit.load_ends || form.ws.held.n == 0) return hit;
    again = true;
  }
}

}  // namespace clutchwork
