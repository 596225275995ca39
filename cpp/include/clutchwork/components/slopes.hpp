#pragma once
#include <clutchwork/components/scalar.hpp>

#include <type_traits>

/// Derivatives of the whole run without the values beside them, for what is linear in them. docs/theory/gradients.md
namespace clutchwork {

/// How an X holds the derivatives of a T. `Seen`: those by which steps are chosen.
template <class T, class X>
struct SlopesAs;

/// Derivatives in N directions.
template <int N, int R>
struct Slopes {
  typedef double Part __attribute__((vector_size(8 * R)));
  static constexpr int parts = N / R;
  Part part[parts]{};

  Slopes() = default;
  /// Those of a constant.
  explicit CLUTCHWORK_HOT Slopes(double) {}

  CLUTCHWORK_HOT Slopes& operator+=(const Slopes& b) {
    for (int i = 0; i < parts; ++i) part[i] += b.part[i];
    return *this;
  }
  friend CLUTCHWORK_HOT Slopes operator+(Slopes a, const Slopes& b) { return a += b; }
  friend CLUTCHWORK_HOT Slopes operator*(Slopes a, double b) {
    for (int i = 0; i < parts; ++i) a.part[i] *= b;
    return a;
  }
  friend CLUTCHWORK_HOT Slopes operator*(double a, const Slopes& b) { return b * a; }
  friend CLUTCHWORK_HOT void add_times(double a, const Slopes& x, Slopes& y) {
    for (int i = 0; i < parts; ++i) y.part[i] += x.part[i] * a;
  }
};

}  // namespace clutchwork
