#pragma once
#include <clutchwork/components/taped.hpp>
#include <clutchwork/run/linear_step.hpp>

#include <cstring>

/// A step of few derivatives on a tape: its matrices, and which numbers it has led to which. docs/theory/gradients.md
namespace clutchwork {

/// The step that is tried, in the one direction beside the tape.
class LinearRecord {
  static constexpr int few = 8, matrices = Lobatto::count + 2, inputs = 1 + Lobatto::count;
  /// On the tape; then come the numbers of start and loads, and the matrices row by row.
  struct Head {
    double h;
    std::int64_t n;
  };

  int n_ = 0;
  double stage_[8][few], last_[few];
  std::int32_t first_ = 0;  ///< of the results: the end, then the rows of the interpolant; 0: they are constants

  static std::int64_t words_of_ids(std::int64_t n) { return (inputs * n + 1) / 2; }

  /// The matrices of a step that are kept.
  template <class L, class F>
  static void each_matrix(L& linear, F&& f) {
    for (auto& matrix : linear.known) f(matrix);
    f(linear.inverse), f(linear.mass);
  }

 public:
  /// Derivatives by which steps are chosen: of the stages and of the end.
  template <class S>
  void take(int n, const S* k, const S& last) {
    n_ = n;
    for (int i = 0; i < n; ++i) last_[i] = last.get(i);
    for (int s = 0; s < 8; ++s) {
      for (int i = 0; i < n; ++i) stage_[s][i] = k[s].get(i);
    }
  }

  /// Note the step, and give its end numbers of its own.
  template <class L, class T, class X>
  void note(const L& linear, const T* start, X* const* loads, T* end) {
    const std::int64_t n = n_;
    std::int32_t id[inputs * few], any = 0;
    for (int i = 0; i < n; ++i) {
      any |= id[i] = start[i].id;
      for (int m = 0; m < Lobatto::count; ++m) any |= id[(m + 1) * n + i] = loads[m][i].number();
    }
    first_ = 0;
    const std::int64_t words = 2 + words_of_ids(n) + matrices * n * n;
    auto* to = any != 0 ? static_cast<double*>(Tape::current()->block(8 * words, 4 * n_, first_)) : nullptr;
    for (int i = 0; i < n; ++i) end[i].id = first_ != 0 ? first_ + i : 0, end[i].probe = last_[i];
    if (to == nullptr) return;
    const Head head{linear.h, n};
    std::memcpy(to, &head, sizeof(head)), to += 2;
    std::memcpy(to, id, std::size_t(inputs * n) * sizeof(id[0])), to += words_of_ids(n);
    each_matrix(linear, [&](const auto& matrix) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) *to++ = matrix.entry(i, j);
      }
    });
  }

  /// The derivatives of its interpolant.
  template <class Step>
  void fit(Step& step) const {
    for (int q = 0; q < 3; ++q) {
      for (int i = 0; i < n_; ++i) {
        auto& p = step.p(q)[i];
        p.id = first_ != 0 ? first_ + (1 + q) * n_ + i : 0, p.probe = 0;
        for (int s = 0; s < 8; ++s) p.probe += Rodas5P::dense[q][s] * stage_[s][i];
      }
    }
  }

  /// From derivatives by the results those by start and loads.
  static void back(const void* kept, const double* results, double* adjoint) {
    Head head;
    std::memcpy(&head, kept, sizeof(head));
    if (head.n <= few / 2)
      back_as<few / 2>(head, static_cast<const double*>(kept) + 2, results, adjoint);
    else
      back_as<few>(head, static_cast<const double*>(kept) + 2, results, adjoint);
  }

 private:
  template <int N>
  static void back_as(const Head& head, const double* from, const double* results, double* adjoint) {
    using S = OneDirection<N, 2>;
    const int n = int(head.n);
    S end, dense[3], start{}, load[Lobatto::count]{};
    bool any = false;
    for (int i = 0; i < n; ++i) {
      end.put(i, results[i]);
      for (int q = 0; q < 3; ++q) dense[q].put(i, results[(1 + q) * n + i]);
    }
    for (int i = 0; i < 4 * n; ++i) any = any || results[i] != 0;
    if (!any) return;
    LinearStep<N, 2> linear;
    linear.n = n, linear.h = head.h;
    const auto* id = reinterpret_cast<const std::int32_t*>(from);
    from += words_of_ids(n);
    each_matrix(linear, [&](auto& matrix) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) matrix.entry(j, i) = *from++;
      }
    });
    linear.prepare();
    linear.give_back(end, dense, start, load);
    for (int i = 0; i < n; ++i) {
      adjoint[id[i]] += start.get(i);
      for (int m = 0; m < Lobatto::count; ++m) adjoint[id[(m + 1) * n + i]] += load[m].get(i);
    }
  }
};

template <>
struct StepRecord<Taped> : LinearRecord {};

}  // namespace clutchwork
