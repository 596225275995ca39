#pragma once
#include <clutchwork/components/slopes.hpp>
#include <clutchwork/motion/dynamics.hpp>
#include <clutchwork/run/integrator/memory.hpp>
#include <clutchwork/workspace.hpp>

/// Derivatives of the slopes of the motion along a plain step. docs/theory/gradients.md (20)
namespace clutchwork {

/// Whether any of n numbers has derivatives.
template <class T>
bool moves(const T* x, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) {
    if (!is_constant(x[i])) return true;
  }
  return false;
}

/// Of a run in a form, of which `plain` and `taken` are the image and its step.
template <class Form, class Plain>
class SlopesAlong {
  using T = typename Form::Scalar;
  template <class X>
  using As = SlopesAs<T, X>;

  Form& form_;
  Step<Form>& step_;
  Workspace<T>& ws_;
  Plain& plain_;
  Step<Plain>& taken_;
  bool rows_move_ = true, mass_moves_ = true;  ///< with the numbers of the model
  bool moved_ = true;                          ///< they have a part in the phase

 public:
  SlopesAlong(Form& form, Step<Form>& step, Plain& plain, Step<Plain>& taken)
      : form_(form), step_(step), ws_(form.ws), plain_(plain), taken_(taken) {}

  /// The rows and the mass of the phase are there.
  void reflect() {
    rows_move_ = moves(ws_.rows.rate.val, ws_.rows.rate.first[ws_.n_branches]);
    mass_moves_ = moves(ws_.rows.mass.val, ws_.rows.mass.first[plain_.nz()]);
    moved_ = rows_move_ || mass_moves_ || Form::full || ws_.sys.shared > 0;
    for (int k = 0; k < ws_.n_branches; ++k) moved_ = moved_ || ws_.moved.moves[ws_.branch[k].direction] != 0;
  }
  /// Whether derivatives that are zero stay so: no number with derivatives has a part in the phase.
  bool stay_zero() const { return !moved_ && !moves(step_.y0(), plain_.n()); }

  /// At a share of the step, where the derivatives of the state are `y`, into `d`. `still`: these are zero.
  template <class X>
  void at(double share, const X* y, X* d, bool still) {
    interpolate(plain_, taken_, share, taken_.point());
    here(share, y, d, still);
  }
  /// The same where taken.point() is there.
  template <class X>
  [[gnu::noinline]] void here(double share, const X* y, X* d, bool still = true) {
    if (still && !moved_) {
      for (int i = 0; i < plain_.n(); ++i) d[i] = X(0);
      return;
    }
    const double t = taken_.t + share * taken_.h;
    const bool all = Form::full || rows_move_ || ws_.sys.shared > 0;
    T *whole = step_.point(), *made = step_.p(2);
    for (int i = all ? 0 : plain_.nz(); i < plain_.n(); ++i) whole[i] = As<X>::number(taken_.point()[i], y[i]);
    if (all) {
      evaluate(form_, t, whole, made);
      for (int i = 0; i < plain_.n(); ++i) d[i] = As<X>::of(made[i]), taken_.slope()[i] = value(made[i]);
    } else if constexpr (!Form::full) {
      evaluate_over_plain_rows(t, whole, y, d, still);
    }
    if (mass_moves_) take_from_mass(d);
  }

 private:
  /// As evaluate, where the rows of the branches have no derivatives. Slopes that the mass needs go to taken.slope().
  template <class X>
  void evaluate_over_plain_rows(double t, const T* whole, const X* y, X* d, bool still) {
    const int nz = plain_.nz();
    T* own = step_.p(2);
    if (mass_moves_) evaluate(plain_, t, taken_.point(), taken_.slope());
    inputs_with(ws_, t, whole + nz);
    for (int i = 0; i < plain_.n(); ++i) d[i] = X(0);
    for (int i = nz; i < plain_.n(); ++i) own[i] = T(0);
    for (int k = 0; k < ws_.n_branches; ++k) {
      const Branch<T>& b = ws_.branch[k];
      // by the state alone nothing changes there
      if (still && !ws_.moved.moves[b.direction]) continue;
      T rate = As<X>::number(plain_.rate(k, taken_.point()), plain_.rate(k, y));
      if (ws_.sys.prescribed > 0) rate += offset_rate(ws_, k);
      plain_.push(k, As<X>::of(branch_torque(ws_, b, rate, whole + nz, own + nz)), d);
    }
    for (int i = nz; i < plain_.n(); ++i) d[i] = As<X>::of(own[i]);
  }
  /// What a mass that changes takes of the slopes.
  template <class X>
  void take_from_mass(X* d) {
    double* velocity = taken_.slope();
    plain_.solve_mass(velocity);
    T *moved = step_.slope(), *lost = step_.p(2);
    for (int i = 0; i < plain_.nz(); ++i) {
      const bool massless = ws_.rows.mass.first[i] == ws_.rows.mass.first[i + 1];
      moved[i] = T(massless ? 0.0 : velocity[i]), lost[i] = T(0);
    }
    form_.add_mass_times(T(-1), moved, lost);
    for (int i = 0; i < plain_.nz(); ++i) d[i] += As<X>::of(lost[i]);
  }
};

/// Marks the directions whose torques have numbers with derivatives of their own.
template <class T>
void mark_moving(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  // numbers of a component end where those of another one begin, at the latest
  auto end_of = [&](std::int64_t first) {
    std::int64_t end = sys.n_params;
    auto look = [&](const auto* at, std::int64_t n) {
      for (std::int64_t i = 0; i < n; ++i) end = at[i] > first && at[i] < end ? at[i] : end;
    };
    look(sys.element_param, sys.elements), look(sys.contact_param, sys.contacts);
    look(sys.contact_law_param, sys.contacts), look(sys.process_param, sys.processes), look(sys.flow_param, sys.flows);
    return end;
  };
  auto numbers = [&](std::int64_t first) { return moves(ws.params + first, end_of(first) - first); };
  auto signals = [&](std::int64_t first, int n) {
    for (std::int64_t ref = first; ref < first + n; ++ref) {
      const std::int64_t i = ws.in.ref_signal[ref];
      if (i >= sys.inputs) return true;
      const std::int64_t at = sys.input_first[i], count = sys.input_count[i];
      if (moves(sys.input_value + i, 1) || moves(sys.segment_time + at, count) ||
          moves(sys.segment_coef + segment_size * at, segment_size * count) || moves(sys.input_period + i, 1))
        return true;
    }
    return false;
  };
  const bool all = sys.prescribed > 0 || moves(ws.moved.points, 3 * sys.n_points);
  for (std::int64_t e = 0; e < sys.elements; ++e) {
    ws.moved.moves[e] =
        all || numbers(sys.element_param[e]) || signals(sys.element_input[e], element_inputs(sys.element_kind[e]));
  }
  for (std::int64_t c = 0; c < sys.contacts; ++c) {
    ws.moved.moves[sys.elements + c] = all || numbers(sys.contact_param[c]) || numbers(sys.contact_law_param[c]) ||
                                       signals(sys.contact_input[c], contact_inputs(sys.contact_kind[c])) ||
                                       signals(sys.contact_law_input[c], law_inputs_of(sys.contact_law[c]));
  }
}

}  // namespace clutchwork
