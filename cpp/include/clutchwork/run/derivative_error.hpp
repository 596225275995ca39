#pragma once
#include <clutchwork/components/slopes.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/workspace.hpp>

/// Errors of derivatives along a step. docs/theory/gradients.md (21)
namespace clutchwork {

/// What the derivatives miss in a part of a step of the plain image, on the sizes that they have had.
template <class T, class Plain>
struct DerivativeError {
  // a direction may miss so much of itself in a part, of rtol: the error of the motion moves derivatives by more
  static constexpr double allowed = 3;

  Workspace<T>& ws;
  Plain& form;
  Step<Plain>& step;

  /// The largest size of a component so far: one that swings passes zero, where its derivatives are as large as before.
  double largest_size(int component, double size) const {
    double& most = ws.moved.most[component];
    return most = larger(most, size);
  }
  /// Components of two sets x(i) and y(i) of each direction, and their size in the motion, to f.
  template <class X, class At, class Other, class F>
  void each_component(At&& x, Other&& y, F&& f) const {
    const Workspace<double>& plain = form.ws;
    const int nv = int(plain.sys.speeds), nz = form.nz();
    const double least = plain.options.atol / plain.options.rtol;
    double fastest = 0;
    for (int i = 0; i < nv; ++i) fastest = larger(fastest, plain.reduced.size[i]);
    for (int i = 0; i < nv; ++i) {
      auto moved = typename SlopesAs<T, X>::Seen(0), other = moved;
      each_share(form, i, [&](double z, int j) { moved += x(j) * z, other += y(j) * z; });
      f(moved, other, largest_size(i, least + larger(plain.reduced.size[i], 1e-3 * fastest)));
    }
    for (int i = 0; i < form.ns(); ++i) {
      const double most = larger(abs(step.y0()[nz + i]), abs(step.y1()[nz + i]));
      f(x(nz + i), y(nz + i), largest_size(nv + i, plain.reduced.floor[i] / plain.options.rtol + most));
    }
  }
  /// Error of the derivatives in units of the tolerance, each direction of the largest size that it has had.
  /// docs/theory/gradients.md (21)
  template <class X, class Missed, class End>
  double of(Missed&& missed, End&& end) const {
    constexpr int seen = SlopesAs<T, X>::count;
    double sum[seen] = {}, size[seen], worst = 0;
    const double* before = ws.moved.largest;
    double* reached = ws.moved.reached;
    for (int j = 0; j < seen; ++j) size[j] = ws.moved.size[j];
    each_component<X>(end, missed, [&](const auto& x, const auto& lost, double of) {
      for (int j = 0; j < seen; ++j) reached[j] = larger(before[j], abs(SlopesAs<T, X>::at(x, j)));
      for (int j = 0; j < seen; ++j) size[j] = larger(size[j], reached[j] / of);
      for (int j = 0; j < seen; ++j) sum[j] += (SlopesAs<T, X>::at(lost, j) / of) * (SlopesAs<T, X>::at(lost, j) / of);
      before += T::seen, reached += T::seen;
    });
    const double count = double(ws.sys.speeds + form.ns());
    for (int j = 0; j < seen; ++j) {
      if (size[j] > 0) worst = larger(worst, sqrt(sum[j] / count) / (allowed * ws.options.rtol * size[j]));
    }
    return worst;
  }
};

}  // namespace clutchwork
