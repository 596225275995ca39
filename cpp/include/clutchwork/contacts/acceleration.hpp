#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/dense.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/contacts/problem.hpp>
#include <clutchwork/workspace.hpp>

/// How the slips accelerate without the torques of the contacts, and the problem that finds those.
namespace clutchwork {

/// Mass-weighted acceleration without contacts that may stick: L^-1 (forces - M_p du/dt).
/// ws.effort: sum of the sizes of all contributions, what round-off of q is measured against.
template <class T>
void free_motion(Workspace<T>& ws, const int* candidate, T* q) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds);
  for (int i = 0; i < nv; ++i) q[i] = T(0);
  ws.effort = 0;
  auto add = [&](T size, int d) {
    T square = T(0);
    for (int e = ws.white_first[d]; e < ws.white_first[d + 1]; ++e) {
      q[ws.white_col[e]] += size * ws.white[e];
      square += ws.white[e] * ws.white[e];
    }
    ws.effort += abs(value(size)) * sqrt(value(square));
  };
  for (int p = 0; p < sys.prescribed; ++p) axpy(nv, -ws.prescribed_slope[p], ws.prescribed_momentum + p * nv, q);
  for (int d = 0; d < ws.n_directions; ++d) {
    const int c = d - int(sys.elements);
    int sign = 0;
    if (c >= 0 && !ws.loaded[c]) continue;
    if (c >= 0 && !ws.compliant[c]) {
      if (candidate[c]) continue;
      sign = ws.mode[c];
      if (sign != forward && sign != backward) continue;
    }
    const Branch<T> b = make_branch(ws, d, sign);
    T* rates = ws.scratch;
    add(branch_torque(ws, b, rate_of(ws, d), ws.state, rates), d);
  }
}

/// Acceleration of a slip for mass-weighted acceleration q.
template <class T>
T slip_acceleration(const Workspace<T>& ws, int c, const T* q) {
  const int d = int(ws.sys.elements) + c, nv = int(ws.sys.speeds);
  T a = dot(nv, ws.direction + d * nv, q);
  for (int p = 0; p < ws.sys.prescribed; ++p) a += prescribed_share(ws, d, p) * ws.prescribed_slope[p];
  return a;
}

/// Acceleration of a slip that the prescribed speeds give.
template <class T>
T slip_slope(const Workspace<T>& ws, int c) {
  T a = T(0);
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    a += prescribed_share(ws, int(ws.sys.elements) + c, p) * ws.prescribed_slope[p];
  }
  return a;
}

/// Gather the problem of the contacts in list[0..n): matrix and views.
template <class T>
BoundedProblem<T> gather(Workspace<T>& ws, const int* list, int n) {
  const int nc = int(ws.sys.contacts);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) ws.qp_m[a * n + b] = ws.mobility[list[a] * nc + list[b]];
  }
  return {n,       ws.qp_m,      ws.qp_g,          ws.qp_lo, ws.qp_hi,  ws.qp_w,
          ws.qp_x, ws.qp_x + nc, ws.qp_x + 2 * nc, ws.qp_f,  ws.qp_fix, ws.qp_fix + nc};
}

}  // namespace clutchwork
