#pragma once
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/hit.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/run/locate.hpp>
#include <clutchwork/workspace.hpp>

/// Ends of tables that may not be left. docs/theory/events.md
namespace clutchwork {

/// Where the law of a contact, locked or not, leaves a table that may not be left: the run ends there.
struct TableExit : OwnScale, OfContact {
  static constexpr const char* name = "exit";
  static constexpr Effect effect = Effect::other;

  template <class T>
  static bool watches(const Workspace<T>& ws) {
    return ws.guard.n_bounded > 0;
  }
  template <class T>
  static void watch(Workspace<T>& ws) {
    ws.guard.n_bounded = 0;
    for (int c = 0; c < ws.sys.contacts; ++c) {
      if (ws.contact.loaded[c] && is_bounded_law(ws.sys.contact_law[c])) ws.guard.bounded[ws.guard.n_bounded++] = c;
    }
  }
  template <class Form>
  [[gnu::noinline]] static void find(Form& form, Step<Form>& step, Hit& hit) {
    using T = typename Form::Scalar;
    Workspace<T>& ws = form.ws;
    for (int i = 0; i < ws.guard.n_bounded; ++i) {
      const int c = ws.guard.bounded[i], k = ws.branch_of[ws.sys.elements + c];
      T seen = T(0);
      auto room = [&](double s, const T* y) {
        inputs_of(form, step.t + s * step.h, y);
        const T slip = k < 0 ? T(0) : form.rate(k, y) + offset_rate(ws, k);
        return value(table_room(ws, c, slip, seen));
      };
      const double start = room(0, step.y0()), end = room(1, step.y1());
      if (start >= 0 && end >= 0) continue;
      fit(form, step);
      auto f = [&](double s) {
        interpolate(form, step, s, step.point());
        return room(s, step.point());
      };
      const double s = start < 0 ? 0.0 : first_crossing(f, start, end, hit.s);
      if (!hit.is_after(s)) continue;
      f(s);
      ws.detail.value = value(seen);
      hit.take(s, c);
    }
  }
  template <class Form, class T = typename Form::Scalar>
  static T at(Form&, Step<Form>&, const Hit&, double, const T*, int&) {
    return T(1);
  }
  template <class Phase>
  static void settle(Phase& phase, const Hit& hit) {
    phase.ws().detail.component = component(phase.ws(), hit);
    phase.leave(Status::out_of_table);
  }
};

}  // namespace clutchwork
