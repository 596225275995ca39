#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/run/fixed/products.hpp>
#include <clutchwork/workspace.hpp>

/// Loads as sums over a step: docs/theory/fixed-steps.md (12)
namespace clutchwork::fixed {

/// Rate of direction d in the virtual motion of load l.
inline real load_rate(const SystemOf<real>& sys, int l, int d) {
  const int ne = int(sys.elements);
  return d < ne ? sys.load_element_rate[l * ne + d] : sys.load_contact_rate[l * sys.contacts + d - ne];
}

/// Once per run: what the changes of the speeds put on each load.
inline void weigh_loads(Run& ws) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  for (int l = 0; l < sys.loads; ++l) {
    real *by_speed = f.load_by_speed + l * nv, *by_given = f.load_by_given + l * np;
    for (int i = 0; i < nv; ++i) by_speed[i] = 0;
    for (int p = 0; p < np; ++p) by_given[p] = 0;
    for (int n = 0; n < sys.nodes; ++n) {
      const real share = sys.load_motion[l * sys.nodes + n] * sys.inertia[n];
      if (share == 0) continue;
      const auto row = basis_row(sys, n);
      for (int k = 0; k < row.n; ++k) by_speed[row.column[k]] += share * row.value[k];
      for (int p = 0; p < np; ++p) by_given[p] += share * sys.basis_prescribed[n * np + p];
    }
  }
}

/// Once per length of a step: the impulses of loads by those of contacts, what other torques answer included.
inline void reach_loads(Run& ws, real h) {
  const auto& sys = ws.sys;
  Fixed<real>& f = ws.fixed;
  const int nv = int(sys.speeds), ne = int(sys.elements), nc = int(sys.contacts);
  for (int l = 0; l < sys.loads; ++l) {
    for (int c = 0; c < nc; ++c) {
      const real* answer = f.answer + c * nv;
      real sum = dot(nv, f.load_by_speed + l * nv, answer) - load_rate(sys, l, ne + c);
      for (int d = 0; d < ws.n_directions; ++d) {
        if (f.kept[d] != 0) sum -= 0.5 * h * load_rate(sys, l, d) * f.kept[d] * rate_row(sys, d).times(answer);
      }
      f.load_reach[l * nc + c] = sum;
    }
  }
}

}  // namespace clutchwork::fixed
