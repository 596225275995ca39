#pragma once
#include <clutchwork/components/scalar.hpp>

/// Powers over a step as cubics through four points: docs/theory/energy.md.
namespace clutchwork {

/// Nodes of the Gauss rule on [0, 1] and the coefficients of its Lagrange polynomials.
struct Gauss {
  static constexpr double node[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263};
  static constexpr double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                       0.17392742256872693};
  double coef[4][4];
  constexpr Gauss() : coef{} {
    for (int i = 0; i < 4; ++i) {
      double p[4] = {1, 0, 0, 0};
      for (int j = 0; j < 4; ++j) {
        if (j == i) continue;
        const double scale = 1 / (node[i] - node[j]);
        for (int k = 3; k >= 0; --k) p[k] = ((k > 0 ? p[k - 1] : 0) - node[j] * p[k]) * scale;
      }
      for (int k = 0; k < 4; ++k) coef[i][k] = p[k];
    }
  }
};
inline constexpr Gauss gauss{};

/// Integral of a cubic, one of n whose coefficients c stand side by side, from 0 to the share r of the length h.
template <class T>
CLUTCHWORK_INLINE T cubic_integral(const T* c, int n, Real<T> r, Real<T> h) {
  using R = Real<T>;
  return h * r * (c[0] + r * (c[n] / R(2) + r * (c[2 * n] / R(3) + r * c[3 * n] / R(4))));
}

}  // namespace clutchwork
