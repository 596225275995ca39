#pragma once
#include <clutchwork/workspace.hpp>

/// Two forms of the same reduced motion M dz/dt = sum of row' torque, behind one set of functions.
namespace clutchwork {

/// What a solve needs of a branch with one state: its row, its inverse, what it pushes and what its rate does to it.
template <class T>
struct OneState {
  const T* row;
  T inverse, push, gain;
};

/// a b for a few numbers; the first product is not added to zero, for which everything behind it would wait.
template <class T>
CLUTCHWORK_HOT T few_products(int n, const T* a, const T* b) {
  T s = n > 0 ? a[0] * b[0] : T(0);
  for (int i = 1; i < n; ++i) s += a[i] * b[i];
  return s;
}

/// Up to a handful of speeds: M = 1, dense rows. NZ, NS: numbers of speeds and of states where the compiler knows them,
/// else -1; in memory all of them are alike.
template <class T, int NZ = -1, int NS = -1>
struct SmallForm {
  using Scalar = T;
  static constexpr bool small = true, full = false;
  static constexpr int fixed_size = NZ >= 0 && NS >= 0 ? NZ + NS : 0;
  static constexpr bool has_one_state = NS == 1;
  Workspace<T>& ws;
  const int speeds, states;
  T w[small_speeds * small_speeds];
  int own[small_states], n_own = 0;  ///< branches with states, since the last factor
  OneState<T> one;                   ///< where the compiler knows that there is one state

  explicit SmallForm(Workspace<T>& workspace) : SmallForm(workspace, workspace.reduced.nz, int(workspace.sys.states)) {}
  SmallForm(Workspace<T>& workspace, int n_speeds, int n_states) : ws(workspace), speeds(n_speeds), states(n_states) {}
  CLUTCHWORK_HOT int nz() const { return NZ < 0 ? speeds : NZ; }
  CLUTCHWORK_HOT int ns() const { return NS < 0 ? states : NS; }
  CLUTCHWORK_HOT int n() const { return nz() + ns(); }

  CLUTCHWORK_HOT T rate(int k, const T* z) const { return few_products(nz(), ws.reduced.row_z + k * nz(), z); }
  CLUTCHWORK_HOT void push(int k, T torque, T* q) const {
    const T* r = ws.reduced.row_z + k * nz();
    for (int i = 0; i < nz(); ++i) q[i] += r[i] * torque;
  }
  CLUTCHWORK_HOT void add_mass_times(T factor, const T* x, T* y) const {
    for (int i = 0; i < nz(); ++i) y[i] += factor * x[i];
  }
  CLUTCHWORK_HOT void solve_mass(T*) const {}

  /// w := inverse of scale M - sum row' stiff row (symmetric).
  CLUTCHWORK_HOT Truth<T> factor(T scale, const T* stiff) {
    for (int i = 0; i < nz() * nz(); ++i) w[i] = T(0);
    for (int k = 0; k < ws.n_branches; ++k) {
      if (all(value(stiff[k]) == 0)) continue;
      const T* r = ws.reduced.row_z + k * nz();
      for (int i = 0; i < nz(); ++i) {
        const T s = stiff[k] * r[i];
        for (int j = 0; j <= i; ++j) w[i * nz() + j] -= s * r[j];
      }
    }
    for (int i = 0; i < nz(); ++i) w[i * nz() + i] += scale;
    return invert_symmetric();
  }
  CLUTCHWORK_HOT void solve(T* b) const {
    T x[small_speeds];
    for (int i = 0; i < nz(); ++i) x[i] = few_products(nz(), w + i * nz(), b);
    for (int i = 0; i < nz(); ++i) b[i] = x[i];
  }

 private:
  // Gauss-Jordan without pivoting on the symmetric matrix, whose lower half is given
  CLUTCHWORK_HOT Truth<T> invert_symmetric() {
    Truth<T> regular(true);
    for (int i = 0; i < nz(); ++i) {
      for (int j = 0; j < i; ++j) w[j * nz() + i] = w[i * nz() + j];
    }
    for (int c = 0; c < nz(); ++c) {
      regular = regular && value(w[c * nz() + c]) != 0;
      if (none(regular)) break;
      const T inverse = T(1) / w[c * nz() + c];
      for (int j = 0; j < nz(); ++j) w[c * nz() + j] = j == c ? inverse : w[c * nz() + j] * inverse;
      for (int r = 0; r < nz(); ++r) {
        if (r == c) continue;
        const T factor = w[r * nz() + c];
        for (int j = 0; j < nz(); ++j)
          w[r * nz() + j] = j == c ? -factor * inverse : w[r * nz() + j] - factor * w[c * nz() + j];
      }
    }
    return regular;
  }
};

/// Any size: compressed rows, reduced mass, LDL' in an envelope.
template <class T>
struct SparseForm {
  using Scalar = T;
  static constexpr bool has_one_state = false;
  static constexpr bool small = false, full = false;
  static constexpr int fixed_size = 0;
  Workspace<T>& ws;
  T* w;
  bool mass_factored = false;

  explicit SparseForm(Workspace<T>& workspace) : ws(workspace), w(workspace.rows.envelope) {}
  int nz() const { return ws.reduced.nz; }
  int ns() const { return int(ws.sys.states); }
  int n() const { return ws.reduced.nz + int(ws.sys.states); }

  template <class X>
  CLUTCHWORK_HOT X rate(int k, const X* z) const {
    return ws.rows.rate.times(k, z);
  }
  double rate_size(int k, const T* z) const { return ws.rows.rate.size(k, z); }
  template <class X>
  CLUTCHWORK_HOT void push(int k, const X& torque, X* q) const {
    ws.rows.rate.add(k, torque, q);
  }
  template <class X>
  void add_mass_times(T factor, const X* x, X* y) const {
    const Compressed<T>& mass = ws.rows.mass;
    for (int i = 0; i < ws.reduced.nz; ++i) {
      X s = X(0);
      const X own = factor * x[i];
      for (int e = mass.first[i]; e < mass.first[i + 1]; ++e) {
        add_times(mass.val[e], x[mass.col[e]], s);
        if (mass.col[e] != i) add_times(mass.val[e], own, y[mass.col[e]]);
      }
      add_times(factor, s, y[i]);
    }
  }
  /// b := M^-1 b, with a factor of its own beside the one of the step.
  void solve_mass(T* b) {
    T* factor_of_mass = ws.rows.mass_envelope;
    if (!mass_factored) {
      assemble(factor_of_mass, T(1), nullptr);
      for (int i = 0; i < ws.reduced.nz; ++i) {
        if (value(factor_of_mass[ws.rows.sky[i] + i]) == 0) factor_of_mass[ws.rows.sky[i] + i] = T(1);
      }
      factor_envelope(factor_of_mass);
      mass_factored = true;
    }
    solve_envelope(factor_of_mass, b);
  }
  bool factor(T scale, const T* stiff) {
    assemble(w, scale, stiff);
    return factor_envelope(w);
  }
  template <class X>
  void solve(X* b) const {
    solve_envelope(w, b);
  }

 private:
  int envelope_size() const { return ws.reduced.nz == 0 ? 0 : ws.rows.sky[ws.reduced.nz - 1] + ws.reduced.nz; }

  void assemble(T* a, T scale, const T* stiff) const {
    const Compressed<T>&mass = ws.rows.mass, &rate = ws.rows.rate;
    const int size = envelope_size();
    for (int i = 0; i < size; ++i) a[i] = T(0);
    for (int i = 0; i < ws.reduced.nz; ++i) {
      T* row = a + ws.rows.sky[i];
      for (int e = mass.first[i]; e < mass.first[i + 1]; ++e) row[mass.col[e]] = scale * mass.val[e];
    }
    for (int k = 0; stiff != nullptr && k < ws.n_branches; ++k) {
      if (value(stiff[k]) == 0) continue;
      for (int e = rate.first[k]; e < rate.first[k + 1]; ++e) {
        const T s = stiff[k] * rate.val[e];
        T* row = a + ws.rows.sky[rate.col[e]];
        for (int f = rate.first[k]; f <= e; ++f) row[rate.col[f]] -= s * rate.val[f];
      }
    }
  }

  // LDL' row by row inside the envelope; the diagonal holds 1/d
  bool factor_envelope(T* a) const {
    const int* low = ws.rows.low;
    for (int i = 0; i < ws.reduced.nz; ++i) {
      T* row = a + ws.rows.sky[i];
      for (int j = low[i]; j < i; ++j) {
        const T* other = a + ws.rows.sky[j];
        const int start = larger(low[i], low[j]);
        T s = row[j];
        for (int k = start; k < j; ++k) s -= row[k] * other[k];
        row[j] = s;
      }
      T d = row[i];
      for (int j = low[i]; j < i; ++j) {
        const T l = row[j] * a[ws.rows.sky[j] + j];
        d -= l * row[j];
        row[j] = l;
      }
      if (value(d) == 0) return false;
      row[i] = T(1) / d;
    }
    return true;
  }

  template <class X>
  void solve_envelope(const T* a, X* b) const {
    const int* low = ws.rows.low;
    for (int i = 0; i < ws.reduced.nz; ++i) {
      const T* row = a + ws.rows.sky[i];
      X s = b[i];
      for (int j = low[i]; j < i; ++j) add_times(-row[j], b[j], s);
      b[i] = s;
    }
    for (int i = 0; i < ws.reduced.nz; ++i) b[i] = b[i] * a[ws.rows.sky[i] + i];
    for (int i = ws.reduced.nz - 1; i >= 0; --i) {
      const T* row = a + ws.rows.sky[i];
      const X s = b[i];
      for (int j = low[i]; j < i; ++j) add_times(-row[j], s, b[j]);
    }
  }
};

}  // namespace clutchwork
