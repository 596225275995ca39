#pragma once
#include <clutchwork/components/dense.hpp>
#include <clutchwork/workspace/settings.hpp>

#include <type_traits>

/// What contacts whose directions depend on each other hold together, and the share of each: docs/theory/contacts.md.
namespace clutchwork {

/// One set of n locked contacts. The first `rank` of them are independent; column i expresses
/// contact i in terms of them, so that the torques x hold the load when the sum of x[i] times column i is the load.
template <class T>
struct DependentSet {
  int n, rank;
  T* column;  ///< n x rank
  T* load;    ///< rank [N m]
  T* lower;   ///< n [N m], not above zero
  T* upper;   ///< n [N m], not below zero, may be infinite
  T* x;       ///< n [N m], shares
};

/// Most of the load that counts: a set that holds it twice is far from its limit.
inline constexpr double ample = 2;

/// Steps of a bounded simplex. P has `rows` and `width` of its tableau, the bounds of its variables, their values and
/// prices, the variable of each row, and the row of each variable (-1: it is not basic).
///
/// A variable that raises the last one, and which way it goes; -1: that is the largest.
template <class P>
int entering(const P& p, int& way) {
  double most = 0;
  for (int j = 0; j < p.width(); ++j) most = larger(most, abs(value(p.price[j])));
  for (int j = p.width() - 1; j >= 0; --j) {
    if (p.place[j] >= 0 || abs(value(p.price[j])) <= 1e-11 * most) continue;
    way = value(p.price[j]) > 0 ? 1 : -1;
    if (way > 0 ? value(p.x[j]) < value(p.upper(j)) : value(p.x[j]) > value(p.lower(j))) return j;
  }
  return -1;
}

/// Move variable j until it or a basic one meets its bound; the row of that one (-1: j itself).
template <class P>
int move(const P& p, int j, int way) {
  using T = std::remove_reference_t<decltype(*p.x)>;
  T step = way > 0 ? p.upper(j) - p.x[j] : p.x[j] - p.lower(j);
  int row = -1;
  double most = 1;
  for (int r = 0; r < p.rows(); ++r) most = larger(most, abs(value(p.tableau[r * p.width() + j])));
  for (int r = 0; r < p.rows(); ++r) {
    const T rate = p.tableau[r * p.width() + j] * T(-way);
    // round-off of earlier pivots
    if (abs(value(rate)) <= 1e-11 * most) continue;
    const int b = p.basis[r];
    const T bound = value(rate) > 0 ? p.upper(b) : p.lower(b);
    if (abs(value(bound)) == infinity) continue;
    const T room = larger((bound - p.x[b]) / rate, T(0));
    if (value(room) < value(step) || (row >= 0 && value(room) == value(step) && b > p.basis[row])) step = room, row = r;
  }
  for (int r = 0; r < p.rows(); ++r) p.x[p.basis[r]] -= T(way) * step * p.tableau[r * p.width() + j];
  p.x[j] += T(way) * step;
  if (row >= 0) {
    const int b = p.basis[row];
    p.x[b] = value(p.tableau[row * p.width() + j]) * way < 0 ? p.upper(b) : p.lower(b);
  }
  if (row < 0) p.x[j] = way > 0 ? p.upper(j) : p.lower(j);
  return row;
}

/// Variable j becomes the basic one of a row.
template <class P>
void pivot(const P& p, int row, int j) {
  using T = std::remove_reference_t<decltype(*p.x)>;
  T* own = p.tableau + row * p.width();
  const T inverse = T(1) / own[j];
  for (int k = 0; k < p.width(); ++k) own[k] *= inverse;
  auto clear = [&](T* other) {
    const T factor = other[j];
    for (int k = 0; k < p.width(); ++k) other[k] -= factor * own[k];
    other[j] = T(0);
  };
  for (int r = 0; r < p.rows(); ++r) {
    if (r != row) clear(p.tableau + r * p.width());
  }
  clear(p.price);
  p.place[p.basis[row]] = -1, p.place[j] = row, p.basis[row] = j;
}

/// Raise the last variable as far as it goes.
template <class P>
void raise(const P& p, int most_rounds) {
  for (int round = 0; round < most_rounds; ++round) {
    int way = 0;
    const int j = entering(p, way);
    if (j < 0) break;
    const int row = move(p, j, way);
    if (row >= 0) pivot(p, row, j);
  }
}

/// The largest factor of the load that the set can hold, at most `ample`. docs/theory/contacts.md (11) Variables: the
/// torques, then the factor. Memory: tableau rank x (n + 1), x, price and `place` n + 1 each.
template <class T>
struct LimitLoad {
  const DependentSet<T>& set;
  T *tableau, *x, *price;
  int *basis, *place;  ///< variable of each row; row of each variable, -1: not basic

  T size = T(0);        ///< of the load [N m]: the factor is counted in it
  double most = ample;  ///< factor that counts as any larger one

  T lower(int j) const { return j < set.n ? set.lower[j] : T(0); }
  T upper(int j) const { return j < set.n ? set.upper[j] : T(most) * size; }
  int width() const { return set.n + 1; }
  int rows() const { return set.rank; }

  /// The independent contacts are the first basis; no torque, no load.
  void start() {
    for (int j = 0; j < width(); ++j) x[j] = price[j] = T(0), place[j] = -1;
    price[set.n] = T(1);
    size = T(0);
    for (int r = 0; r < set.rank; ++r) size = larger(size, abs(set.load[r]));
    for (int r = 0; r < set.rank; ++r) {
      for (int j = 0; j < set.n; ++j) tableau[r * width() + j] = set.column[j * set.rank + r];
      tableau[r * width() + set.n] = value(size) > 0 ? -set.load[r] / size : T(0);
      basis[r] = r, place[r] = r;
    }
  }

  /// The largest factor. `price` then tells how the set gives way: a contact with a positive one slips backward.
  T solve() {
    start();
    raise(*this, 50 + 20 * set.n);
    return value(size) > 0 ? x[set.n] / size : T(most);
  }
};

/// Shares of a load as springs in parallel would have them whose stiffness is the capacity, each yielding at its
/// bound: Newton on the common deflection. docs/theory/contacts.md (13)
template <class T>
struct Shares {
  const DependentSet<T>& set;
  T *deflection, *step, *residual;  ///< rank each
  T* matrix;                        ///< rank x rank
  T free_stiffness = T(1);          ///< of a contact without bound

  T use(int i, const T* at) const { return dot(set.rank, set.column + i * set.rank, at); }
  T stiffness(int i, bool ahead) const {
    const T bound = ahead ? set.upper[i] : -set.lower[i];
    return value(bound) < infinity ? bound : free_stiffness;
  }
  T torque(int i, T use) const {
    const bool ahead = value(use) >= 0;
    return larger(smaller(stiffness(i, ahead) * use, set.upper[i]), set.lower[i]);
  }
  bool yields(int i, T use) const {
    const T bound = value(use) >= 0 ? set.upper[i] : set.lower[i];
    return value(bound) == 0 || (abs(value(bound)) < infinity && abs(value(use)) > 1);
  }

  /// Columns and load in terms of other contacts, where some are many times as fast as those that are the basis, as
  /// beside a dead point: their torques would be stiffness times the difference of two large deflections. The shares
  /// are the same; `column` and `load` of the set are left in the new basis.
  void change_basis() {
    constexpr double most = 1e3;
    const int m = set.rank;
    // each round multiplies the determinant of the basis by more than that
    while (true) {
      int pivot = 0;
      for (int e = 1; e < set.n * m; ++e) pivot = abs(value(set.column[e])) > abs(value(set.column[pivot])) ? e : pivot;
      if (!(abs(value(set.column[pivot])) > most)) return;
      const int r = pivot % m;
      T* own = set.column + (pivot - r);
      for (int k = 0; k <= set.n; ++k) {
        T* of = k < set.n ? set.column + k * m : set.load;
        if (of == own) continue;
        const T share = of[r] / own[r];
        axpy(m, -share, own, of);
        of[r] = share;
      }
      for (int k = 0; k < m; ++k) own[k] = T(k == r);
    }
  }

  /// Load that is not held at a deflection; its size.
  double miss(const T* at) {
    for (int r = 0; r < set.rank; ++r) residual[r] = set.load[r];
    for (int i = 0; i < set.n; ++i) axpy(set.rank, -torque(i, use(i, at)), set.column + i * set.rank, residual);
    double size = 0;
    for (int r = 0; r < set.rank; ++r) size = larger(size, abs(value(residual[r])));
    return size;
  }

  bool newton_step() {
    const int m = set.rank;
    for (int e = 0; e < m * m; ++e) matrix[e] = T(0);
    for (int i = 0; i < set.n; ++i) {
      const T at = use(i, deflection), k = stiffness(i, value(at) >= 0);
      const T* c = set.column + i * m;
      for (int a = 0; a < m && !yields(i, at); ++a) axpy(m, k * c[a], c, matrix + a * m);
    }
    // where all have yielded the deflection is not unique: a little of the stiffness before that, of each component for
    // itself, whose units differ; where none is left on this side, of a contact without bound
    for (int a = 0; a < m; ++a) {
      T all = T(0);
      for (int i = 0; i < set.n; ++i) {
        const T c = set.column[i * m + a];
        all += stiffness(i, value(use(i, deflection)) >= 0) * c * c;
      }
      matrix[a * m + a] += T(1e-13) * (value(all) > 0 ? all : free_stiffness);
    }
    for (int a = 0; a < m; ++a) step[a] = residual[a];
    if (!cholesky(m, matrix, m)) return false;
    forward_solve(m, matrix, m, step);
    backward_solve(m, matrix, m, step);
    return true;
  }

  /// How far to go along the step: where the load that is missing no longer points ahead.
  void search() {
    T* from = matrix;
    for (int r = 0; r < set.rank; ++r) from[r] = deflection[r];
    double low = 0, high = 1;
    for (int k = 0; k < 50; ++k) {
      const double s = k == 0 ? 1.0 : 0.5 * (low + high);
      for (int r = 0; r < set.rank; ++r) deflection[r] = from[r] + T(s) * step[r];
      miss(deflection);
      const double ahead = value(dot(set.rank, residual, step));
      if (k == 0 && ahead >= 0) return;
      (ahead >= 0 ? low : high) = s;
    }
  }

  /// One whole step where nothing is missing any more: what is left to do are the derivatives.
  void follow() {
    miss(deflection);
    if (!newton_step()) return;
    for (int r = 0; r < set.rank; ++r) deflection[r] += without_value(step[r]);
  }

  /// What is missing where some have yielded, and their deflections may be any, goes to those that have not.
  void complete() {
    if (!newton_step()) return;
    for (int i = 0; i < set.n; ++i) {
      const T at = use(i, deflection);
      if (yields(i, at)) continue;
      const T more = set.x[i] + stiffness(i, value(at) >= 0) * use(i, step);
      set.x[i] = larger(smaller(more, set.upper[i]), set.lower[i]);
    }
  }

  void solve() {
    double scale = 0;
    change_basis();
    free_stiffness = T(0);
    for (int i = 0; i < set.n; ++i) {
      if (value(set.upper[i]) < infinity) free_stiffness += T(0.5) * set.upper[i];
      if (value(set.lower[i]) > -infinity) free_stiffness -= T(0.5) * set.lower[i];
    }
    if (value(free_stiffness) == 0) free_stiffness = T(1);
    for (int r = 0; r < set.rank; ++r) deflection[r] = T(0), scale = larger(scale, abs(value(set.load[r])));
    for (int round = 0; round < 60 && miss(deflection) > 4e-16 * scale; ++round) {
      if (!newton_step()) break;
      search();
    }
    if constexpr (has_tangents<T>) follow();
    for (int i = 0; i < set.n; ++i) set.x[i] = torque(i, use(i, deflection));
    // far more than round-off
    if (miss(deflection) > 1e-13 * scale) complete();
  }
};

}  // namespace clutchwork
