#pragma once
#include <clutchwork/workspace.hpp>

/// How stiff the motion is, for the choice of the method: docs/theory/integrators.md.
namespace clutchwork {

/// Bound of the rates [1/s] at which the motion changes by itself where its partial derivatives were taken last.
template <class T>
double fastest_rate(const Workspace<T>& ws) {
  const Jacobian<T>& j = ws.jacobian;
  double damping = 0, stiffness = 0;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    const double mobility = value(ws.geometry.own[b.direction]);
    damping += mobility * abs(value(j.partial[k].by_rate));
    for (int s = 0; s < b.states; ++s) {
      stiffness += mobility * abs(value(j.f_state[b.state + s] * j.g_rate[b.state + s]));
      damping += abs(value(j.g_state[j.block[k] + s * b.states + s]));
    }
  }
  return damping + sqrt(stiffness);
}

/// Steps that are shorter than so many times the inverse of it have nothing in them that settles.
inline constexpr double long_step = 10;

/// Whether something may settle within a step of length h: of shared states nothing is known here.
template <class T>
bool may_settle_within(const Workspace<T>& ws, double h) {
  return ws.sys.shared > 0 || h * fastest_rate(ws) >= long_step;
}

/// Whether a rate settles within a step of length h by its own torque alone.
inline bool is_steep(double mobility, double by_rate, double h) { return mobility * abs(by_rate) * h > long_step; }

/// Whether that of any branch does. Of the full form, whose partial derivatives are elsewhere, nothing is known here.
template <class T>
bool follows_closely(const Workspace<T>& ws, double h) {
  for (int k = 0; k < ws.n_branches; ++k) {
    const double mobility = value(ws.geometry.own[ws.branch[k].direction]);
    if (is_steep(mobility, value(ws.jacobian.partial[k].by_rate), h)) return true;
  }
  return false;
}

}  // namespace clutchwork
