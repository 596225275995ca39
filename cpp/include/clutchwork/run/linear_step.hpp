#pragma once
#include <clutchwork/components/slopes.hpp>
#include <clutchwork/run/integrator/rodas5p.hpp>

#include <utility>

/// A step of few derivatives, whose equations are linear: matrices and loads at five instants, in registers.
/// docs/theory/gradients.md (23)
namespace clutchwork {

/// Instants of a step, of its length, at which its equations are known; between them they are a quartic. With one less
/// the embedded method, which is exact for a cubic, would see no error of it.
struct Lobatto {
  static constexpr int count = 5;
  static constexpr double node[count] = {0, 0.1726731646460114, 0.5, 0.8273268353539886, 1};
  struct Shares {
    double of[count];
  };

  /// Share at x of what is known at instant k.
  static constexpr double share(int k, double x) {
    double found = 1;
    for (int m = 0; m < count; ++m) found *= m == k ? 1.0 : (x - node[m]) / (node[k] - node[m]);
    return found;
  }
  /// The same of the derivative at the start.
  static constexpr double slope(int k) {
    double found = 0;
    for (int o = 0; o < count; ++o) {
      double part = o == k ? 0 : 1 / (node[k] - node[o]);
      for (int m = 0; m < count; ++m) part *= m == k || m == o ? 1.0 : -node[m] / (node[k] - node[m]);
      found += part;
    }
    return found;
  }
  static constexpr Shares shares(double x) {
    Shares found{};
    for (int k = 0; k < count; ++k) found.of[k] = share(k, x);
    return found;
  }
  static constexpr Shares slopes() {
    Shares found{};
    for (int k = 0; k < count; ++k) found.of[k] = slope(k);
    return found;
  }
};

/// One direction: up to N numbers, or of eight directions each. `put` and `get` the number i.
template <int N, int R>
struct OneDirection {
  Slopes<N, R> at;
  void put(int i, double x) { reinterpret_cast<double*>(&at)[i] = x; }
  double get(int i) const { return reinterpret_cast<const double*>(&at)[i]; }
  double* data() { return reinterpret_cast<double*>(&at); }

  friend CLUTCHWORK_HOT void add_times(double a, const OneDirection& x, OneDirection& y) { add_times(a, x.at, y.at); }
};
template <int N, int R>
struct ManyDirections {
  using Number = Slopes<8, R>;
  Number at[N];
  void put(int i, const Number& x) { at[i] = x; }
  const Number& get(int i) const { return at[i]; }

  // there are many of them in a step
  friend CLUTCHWORK_HOT void add_times(double a, const ManyDirections& x, ManyDirections& y) {
#pragma GCC unroll 1
    for (int i = 0; i < N; ++i) add_times(a, x.at[i], y.at[i]);
  }
};

/// Columns of a matrix of n by n numbers.
template <int N, int R>
struct FewColumns {
  Slopes<N, R> column[N];

  double& entry(int i, int j) { return reinterpret_cast<double*>(column + j)[i]; }
  double entry(int i, int j) const { return reinterpret_cast<const double*>(column + j)[i]; }
  /// y += this x.
  CLUTCHWORK_HOT void add(int n, const OneDirection<N, R>& x, OneDirection<N, R>& y) const {
    for (int j = 0; j < n; ++j) add_times(x.get(j), column[j], y.at);
  }
  [[gnu::noinline]] void add(int n, const ManyDirections<N, R>& x, ManyDirections<N, R>& y) const {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) add_times(entry(i, j), x.at[j], y.at[i]);
    }
  }
  static CLUTCHWORK_HOT void mix(const Lobatto::Shares& share, int n, const FewColumns* from, FewColumns& to) {
    for (int j = 0; j < n; ++j) {
      Slopes<N, R> x = from[0].column[j] * share.of[0];
      for (int k = 1; k < Lobatto::count; ++k) add_times(share.of[k], from[k].column[j], x);
      to.column[j] = x;
    }
  }
};

/// What a tape keeps of a step: run/linear_record.hpp. Numbers that carry their derivatives have none.
template <class T>
struct StepRecord {};

/// The matrices of a step of n numbers.
template <int N, int R>
struct LinearStep {
  using Matrix = FewColumns<N, R>;
  static constexpr int stages = 8, inside = 4;  ///< the first stage is at the start, the last ones are at the end
  int n = 0;
  double h = 0;
  Matrix known[Lobatto::count];  ///< derivatives of the slopes by the state
  Matrix inverse, mass;          ///< of M / (gamma h) - J at the start; M
  Matrix at[inside], drift;      ///< what stages take, and its change with time, times h

  template <class F, int... s>
  static CLUTCHWORK_HOT void each(F&& f, std::integer_sequence<int, s...>) {
    (f(std::integral_constant<int, s>{}), ...);
  }
  /// f for each of the stages.
  template <class F>
  static CLUTCHWORK_HOT void each_stage(F&& f) {
    each(f, std::make_integer_sequence<int, stages>{});
  }
  template <int s>
  static constexpr double share(int k) {
    return Lobatto::share(k, Rodas5P::node[s]);
  }
  template <int s>
  const Matrix& matrix() const {
    if constexpr (s == 0) return known[0];
    if constexpr (s > inside) return known[Lobatto::count - 1];
    return at[s > 0 && s <= inside ? s - 1 : 0];
  }

  /// Matrices of the stages from those that are known.
  void prepare() {
    each_stage([&](auto stage) CLUTCHWORK_HOT_LAMBDA {
      constexpr int s = stage.value;
      constexpr Lobatto::Shares shares = Lobatto::shares(Rodas5P::node[s]);
      if constexpr (s > 0 && s <= inside) Matrix::mix(shares, n, known, at[s - 1]);
    });
    constexpr Lobatto::Shares slopes = Lobatto::slopes();
    Matrix::mix(slopes, n, known, drift);
  }

  /// Where stage s is, from those before it.
  template <int s, class S>
  static CLUTCHWORK_HOT void point(const S& start, const S* k, S& u) {
    if constexpr (s > 5) {
      add_times(1, k[s - 1], u);
    } else {
      u = start;
      for (int j = 0; j < s; ++j) add_times(Rodas5P::a[s][j], k[j], u);
    }
  }
  /// Stage s of a step of length h from the slopes there, and h times their change with time.
  template <int s, class S>
  CLUTCHWORK_HOT void solve(double length, const S& change, S& slope, S* k) const {
    if constexpr (s > 0) {
      S mix{};
      for (int j = 0; j < s; ++j) add_times(Rodas5P::c[s][j] / length, k[j], mix);
      mass.add(n, mix, slope);
    }
    if constexpr (s < 5) add_times(Rodas5P::d[s], change, slope);
    k[s] = S{};
    inverse.add(n, slope, k[s]);
  }

  /// Stages and end from the start and the loads at the known instants.
  template <class S>
  [[gnu::noinline]] void take(const S& start, const S* load, S* k, S& end) const {
    S change{}, u = start;
    drift.add(n, start, change);
    for (int m = 0; m < Lobatto::count; ++m) add_times(Lobatto::slope(m), load[m], change);
    each_stage([&](auto stage) CLUTCHWORK_HOT_LAMBDA {
      constexpr int s = stage.value;
      point<s>(start, k, u);
      S slope{};
      for (int m = 0; m < Lobatto::count; ++m) {
        if (share<s>(m) != 0) add_times(share<s>(m), load[m], slope);
      }
      matrix<s>().add(n, u, slope);
      solve<s>(h, change, slope, k);
    });
    end = u;
    add_times(1, k[stages - 1], end);
  }

  /// The other way, with transposed matrices: from weights of the end and of the interpolant those of start and loads.
  template <class S>
  [[gnu::noinline]] void give_back(const S& end, const S* dense, S& start, S* load) const {
    S k[stages]{}, moved{}, u = end;
    for (int s = 0; s < stages; ++s) {
      for (int q = 0; q < 3; ++q) add_times(Rodas5P::dense[q][s], dense[q], k[s]);
    }
    add_times(1, end, k[stages - 1]);
    each_stage([&](auto stage) CLUTCHWORK_HOT_LAMBDA {
      constexpr int s = stages - 1 - stage.value;
      S slope{}, mix{};
      inverse.add(n, k[s], slope);
      for (int m = 0; m < Lobatto::count; ++m) {
        if (share<s>(m) != 0) add_times(share<s>(m), slope, load[m]);
      }
      if (s < 5) add_times(Rodas5P::d[s], slope, moved);
      if (s > 0) mass.add(n, slope, mix);
      for (int j = 0; j < s; ++j) add_times(Rodas5P::c[s][j] / h, mix, k[j]);
      if (s < 5) u = S{};
      matrix<s>().add(n, slope, u);
      if constexpr (s > 5) {
        add_times(1, u, k[s - 1]);
      } else {
        add_times(1, u, start);
        for (int j = 0; j < s; ++j) add_times(Rodas5P::a[s][j], u, k[j]);
      }
    });
    drift.add(n, moved, start);
    for (int m = 0; m < Lobatto::count; ++m) add_times(Lobatto::slope(m), moved, load[m]);
  }
};

}  // namespace clutchwork
