#pragma once
#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/kinds.hpp>
#include <clutchwork/contacts/ratios.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/motion/shared.hpp>
#include <clutchwork/workspace.hpp>

/// Derivatives of all components where a run stands, its modes held: docs/theory/linearisation.md (2).
namespace clutchwork {

/// Sizes of the matrix of derivatives. Rows: torque of each direction, rate of each state, static torque of each
/// contact, most torque of each contact, then least one, value of each flow, ratio of each transmission, then its time
/// derivative with the rates of what it depends on held. Columns: rate of each direction, each
/// state, each signal, then the value itself.
struct LocalSizes {
  std::int64_t directions, states, contacts, signals;
  std::int64_t rows, columns;

  explicit LocalSizes(const System& s)
      : directions(s.elements + s.contacts),
        states(s.states),
        contacts(s.contacts),
        signals(s.inputs),
        rows(directions + states + 3 * contacts + s.flows + 2 * s.transmissions),
        columns(directions + states + signals + 1) {}
};

/// The parameters of a component as numbers of another scalar.
template <class C, class S, class T>
struct Lifted {
  static constexpr int n = int(sizeof(typename C::template Params<T>) / sizeof(T));
  S at[n > 0 ? n : 1];

  explicit Lifted(const T* params) {
    for (int i = 0; i < n; ++i) at[i] = S(params[i]);
  }
  const typename C::template Params<S>& get() const {
    return *reinterpret_cast<const typename C::template Params<S>*>(&at[0]);
  }
};

/// Fills the matrix; `d` is scratch for the rates of all states.
template <class T>
class LocalDerivatives {
 public:
  LocalDerivatives(Workspace<T>& workspace, double* to) : ws_(workspace), sys_(ws_.sys), out_(to), n_(ws_.sys) {}

  /// Torques of the contacts as the last row of output has them tell which way a static torque acts.
  void fill() {
    for (std::int64_t i = 0; i < n_.rows * n_.columns; ++i) out_[i] = 0;
    inputs_with(ws_, ws_.time, ws_.state);
    present_rates(ws_);
    T *rate = ws_.observed.rate, *torque = ws_.observed.torque, *d = ws_.observed.state_rates;
    for (int i = 0; i < sys_.states; ++i) d[i] = T(0);
    for (int k = 0; k < ws_.n_branches; ++k) {
      rate[k] = rate_of(ws_, ws_.branch[k].direction);
      const Branch<T>& b = ws_.branch[k];
      if (b.ways == 1) torque[k] = branch_torque_once(ws_, b, rate[k], ws_.state, d);
    }
    for (int k = 0; k < ws_.n_branches; ++k) {
      const Branch<T>& b = ws_.branch[k];
      if (b.ways > 1) element_torques(ws_, b, rate + k, ws_.state + b.state, b.input, d + b.state, torque + k);
    }
    if (sys_.shared > 0) shared_rates(ws_, rate, torque, ws_.state, d);
    for (int k = 0; k < ws_.n_branches; ++k) {
      if (ws_.branch[k].ways > 0) fill_branch(k);
    }
    for (int h = 0; h < sys_.heats; ++h) fill_heat(h);
    for (int f = 0; f < sys_.flows; ++f) fill_flow(f);
    for (int a = 0; a < sys_.transmissions; ++a) fill_ratio(a);
    for (int i = 0; i < sys_.processes; ++i) fill_process(i);
    for (int c = 0; c < sys_.contacts; ++c) fill_bounds(c);
  }

 private:
  static constexpr int most_own = most_own_states > 0 ? most_own_states : 1;
  static constexpr int first_own = most_ways, first_input = first_own + most_own, N = first_input + 2 * most_inputs;
  using S = Dual<T, N>;

  Workspace<T>& ws_;
  const System& sys_;
  double* out_;
  LocalSizes n_;

  double* row_of_torque(int direction) { return out_ + direction * n_.columns; }
  double* row_of_state(std::int64_t i) { return out_ + (n_.directions + i) * n_.columns; }
  double* row_of_shared(int j) { return row_of_state(n_.states - sys_.shared + j); }
  double* row_of_capacity(int c) { return out_ + (n_.directions + n_.states + c) * n_.columns; }
  double* row_of_most(int c) { return row_of_capacity(int(n_.contacts) + c); }
  double* row_of_least(int c) { return row_of_capacity(int(2 * n_.contacts) + c); }
  double* row_of_flow(int f) { return row_of_capacity(int(3 * n_.contacts) + f); }
  double& value_in(double* row) { return row[n_.columns - 1]; }

  /// A branch at the present point, over the rates of its ways, its own states and its inputs.
  struct Point {
    S rate[most_ways], own[most_own], own_rates[most_own], input[most_inputs], law_input[most_inputs];
  };
  void place(Point& at, const Branch<T>& b, const T* rate) const {
    for (int i = 0; i < b.ways; ++i) at.rate[i] = S::variable(rate[i], i);
    for (int i = 0; i < b.states; ++i) at.own[i] = S::variable(ws_.state[b.state + i], first_own + i);
    for (int i = 0; i < b.inputs; ++i) at.input[i] = S::variable(b.input[i], first_input + i);
    for (int i = 0; i < b.law_inputs; ++i) at.law_input[i] = S::variable(b.law_input[i], first_input + most_inputs + i);
  }

  /// row += factor * derivatives of f, and its value.
  void add(double* row, T factor, const S& f, const Branch<T>& b) {
    for (int i = 0; i < b.ways; ++i) row[b.direction + i] += value(factor * f.d[i]);
    for (int i = 0; i < b.states; ++i) row[n_.directions + b.state + i] += value(factor * f.d[first_own + i]);
    for (int i = 0; i < b.inputs; ++i) add_reference(row, factor * f.d[first_input + i], int(b.input - ws_.in.u) + i);
    for (int i = 0; i < b.law_inputs; ++i)
      add_reference(row, factor * f.d[first_input + most_inputs + i], int(b.law_input - ws_.in.u) + i);
    value_in(row) += value(factor * f.v);
  }

  /// row += factor * derivatives of what stands at a reference.
  void add_reference(double* row, T factor, int ref) {
    if (value(factor) == 0) return;
    const int code = sys_.input_refs[ref];
    if (code < sys_.inputs) {
      row[n_.directions + n_.states + code] += value(factor);
    } else if (code < sys_.inputs + sys_.shared) {
      const int j = code - int(sys_.inputs);
      row[n_.directions + n_.states - sys_.shared + j] += value(factor) * sys_.shared_scale[j];
    } else if (is_sum(ws_, code)) {
      const int c = code - int(sys_.inputs + sys_.shared) - 3 * ws_.n_directions;
      each_drawn(ws_, c, ws_.state, [&](const auto& flow, int by, int states, int inputs) {
        for (int s = 0; s < states; ++s) row[n_.directions + sys_.process_state[by] + s] -= value(factor * flow.d[s]);
        for (int i = 0; i < inputs; ++i)
          add_reference(row, -factor * flow.d[states + i], int(sys_.process_input[by]) + i);
      });
    } else {
      Read what;
      const int k = branch_behind(ws_, ref, what);
      if (k < 0) return;
      if (what == Read::rate) {
        row[ws_.branch[k].direction] += value(factor);
        return;
      }
      if (what == Read::supply) add_work(row, factor, k);
      add_heat(row, factor, k, false);
    }
  }

  /// row += factor * derivatives of the work that branch k does [W]; of an element of one way.
  void add_work(double* row, T factor, int k) {
    const int d = ws_.branch[k].direction;
    const double* own_torque = row_of_torque(d);
    for (std::int64_t i = 0; i + 1 < n_.columns; ++i) row[i] += value(factor * ws_.observed.rate[k]) * own_torque[i];
    row[d] += value(factor * ws_.observed.torque[k]);
  }

  /// row += factor * derivatives of the heat of branch k [W], and its value where that is wanted.
  void add_heat(double* row, T factor, int k, bool valued) {
    const Branch<T>& b = ws_.branch[k];
    const T *rate = ws_.observed.rate + k, *torque = ws_.observed.torque + k;
    const double before = value_in(row);
    const bool own =
        b.law < 0 && visit_torque(
                         b.kind,
                         [&](auto tag) {
                           using E = typename decltype(tag)::type;
                           if constexpr (HeatingElement<E>) {
                             Point at;
                             place(at, b, rate);
                             const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(b.params);
                             const At<S> here{at.rate[0], at.own, at.input, b.piece, points_of(ws_), at.rate};
                             add(row, factor, E::heat(p, here), b);
                             return true;
                           }
                           return false;
                         });
    for (int w = 0; w < b.ways && !own; ++w) {
      const double* own_torque = row_of_torque(b.direction + w);
      for (std::int64_t i = 0; i + 1 < n_.columns; ++i) row[i] -= value(factor * rate[w]) * own_torque[i];
      row[b.direction + w] -= value(factor * torque[w]);
      value_in(row) -= value(factor * rate[w] * torque[w]);
    }
    if (!valued) value_in(row) = before;
  }

  /// Ratio of transmission a, and its time derivative with the rates of its states and inputs held.
  void fill_ratio(int a) {
    using D = Dual<S, 1>;
    const int k = ws_.branch_of[first_of(ws_, a)];
    const Branch<T>& b = ws_.branch[k];
    Point at;
    place(at, b, ws_.observed.rate + k);
    visit_transmission(ws_, a, [&](auto tag, const auto& p) {
      using E = typename decltype(tag)::type;
      D own[E::states > 0 ? E::states : 1], input[E::inputs > 0 ? E::inputs : 1];
      if constexpr (E::states > 0)
        E::state_rates(p, At<S>{at.rate[0], at.own, at.input, b.piece, sys_.points, at.rate}, at.own_rates);
      for (int i = 0; i < E::states; ++i) own[i] = D(at.own[i]), own[i].d[0] = S(value(at.own_rates[i]));
      for (int i = 0; i < E::inputs; ++i) {
        input[i] = D(at.input[i]);
        input[i].d[0] = S(value(slope_of_input(ws_, int(b.input - ws_.in.u) + i)));
      }
      const D ratio = E::ratio(p, At<D>{D(S(0)), own, input, b.piece, sys_.points});
      const std::int64_t first = n_.rows - 2 * sys_.transmissions;
      add(out_ + (first + a) * n_.columns, T(1), ratio.v, b);
      add(out_ + (first + sys_.transmissions + a) * n_.columns, T(1), ratio.d[0], b);
    });
  }

  void fill_branch(int k) {
    const Branch<T>& b = ws_.branch[k];
    Point at;
    place(at, b, ws_.observed.rate + k);
    S f[most_ways];
    if (b.law < 0) {
      element_torques(ws_, b, at.rate, at.own, at.input, at.own_rates, f);
    } else if (b.compliant) {
      f[0] = bending_torque<most_own_states, T, S>(ws_, b, at.rate[0], at.own, at.input, at.law_input, at.own_rates);
    } else {
      f[0] = sliding_torque<T, S>(ws_, b, at.rate[0], at.input, at.law_input);
    }
    for (int i = 0; i < b.ways; ++i) add(row_of_torque(b.direction + i), T(1), f[i], b);
    for (int i = 0; i < b.states; ++i) add(row_of_state(b.state + i), T(1), at.own_rates[i], b);
  }

  void fill_heat(int h) {
    const int k = ws_.branch_of[sys_.heat_direction[h]];
    if (k >= 0 && k < ws_.n_branches) add_heat(row_of_shared(sys_.heat_to[h]), T(sys_.heat_share[h]), k, true);
  }

  void fill_flow(int f) {
    visit_flow(sys_.flow_kind[f], [&](auto tag) {
      using E = typename decltype(tag)::type;
      using D = Dual<T, most_inputs>;
      D input[most_inputs];
      for (int i = 0; i < E::inputs; ++i) input[i] = D::variable(ws_.in.u[sys_.flow_input[f] + i], i);
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws_.params + sys_.flow_param[f]);
      const D q = E::flow(p, flow_at<T, D>(ws_, f, input));
      auto to = [&](double* row, double sign) {
        for (int i = 0; i < E::inputs; ++i) add_reference(row, T(sign) * q.d[i], sys_.flow_input[f] + i);
        value_in(row) += sign * value(q.v);
      };
      to(row_of_flow(f), 1);
      if (sys_.flow_from[f] >= 0) to(row_of_shared(sys_.flow_from[f]), -1);
      if (sys_.flow_to[f] >= 0) to(row_of_shared(sys_.flow_to[f]), 1);
    });
  }

  void fill_process(int c) {
    visit_process(sys_.process_kind[c], [&](auto tag) {
      using E = typename decltype(tag)::type;
      using D = Dual<T, E::states + most_inputs>;
      D input[most_inputs], own[E::states], rates[E::states];
      const int first = sys_.process_state[c], refs = sys_.process_input[c];
      for (int i = 0; i < E::inputs; ++i) input[i] = D::variable(ws_.in.u[refs + i], E::states + i);
      for (int i = 0; i < E::states; ++i) own[i] = D::variable(ws_.state[first + i], i);
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws_.params + sys_.process_param[c]);
      E::state_rates(p, process_at<T, D>(ws_, c, own, input), rates);
      for (int s = 0; s < E::states; ++s) {
        double* row = row_of_state(first + s);
        for (int j = 0; j < E::states; ++j) row[n_.directions + first + j] += value(rates[s].d[j]);
        for (int i = 0; i < E::inputs; ++i) add_reference(row, rates[s].d[E::states + i], refs + i);
        value_in(row) += value(rates[s].v);
      }
    });
  }

  /// Static torque against the slip that the present torque resists, and what the contact holds either way: a freewheel
  /// what it was made for, one that cannot let go anything.
  void fill_bounds(int c) {
    if (ws_.contact.fault[c] == cannot_transmit) return;
    const bool stuck = ws_.contact.fault[c] == cannot_unlock;
    const int resisted = value(ws_.out.torque[sys_.elements + c]) > 0 ? backward : forward;
    add_static(row_of_capacity(c), c, resisted, 1);
    if (stuck) {
      value_in(row_of_most(c)) = infinity, value_in(row_of_least(c)) = -infinity;
      return;
    }
    const int way = free_way(ws_, c);
    if (way < 0) {
      value_in(row_of_least(c)) = -infinity;
    } else {
      add_static(row_of_least(c), c, forward, -1);
    }
    if (way > 0) {
      value_in(row_of_most(c)) = value(freewheel_limit(ws_, c));
    } else {
      add_static(row_of_most(c), c, backward, 1);
    }
  }

  /// row += sign * static torque against slip in a direction.
  void add_static(double* row, int c, int resisted, int sign) {
    const Branch<T> b = make_branch(ws_, int(sys_.elements) + c, 0);
    Point at;
    const T still = T(0);
    place(at, b, &still);
    const S hold = visit_law(b.law, [&](auto tag) {
      using L = typename decltype(tag)::type;
      const At<S> here{S(0), nullptr, at.law_input, 0, sys_.points};
      // numbers of a formula stand behind its parameters, and stay there
      if constexpr (ProgrammedLaw<L>)
        return L::hold(*reinterpret_cast<const typename L::template Params<T>*>(b.law_params), here);
      else
        return L::hold(Lifted<L, S, T>(b.law_params).get(), here);
    });
    const S limit = visit_contact(b.kind, [&](auto tag) {
      using E = typename decltype(tag)::type;
      const Lifted<E, S, T> p(b.params);
      const At<S> here{S(0), nullptr, at.input, 0, sys_.points};
      if constexpr (LimitedContact<E>) {
        return larger(E::limit(p.get(), here, hold, resisted), S(0));
      } else {
        const S load = larger(S(E::load(p.get(), here)), S(0));
        if constexpr (ShapedContact<E>) return load * S(E::gain(p.get(), hold, resisted));
        return load * hold;
      }
    });
    // own states have no part in it
    Branch<T> stateless = b;
    stateless.states = 0;
    add(row, T(sign), limit, stateless);
  }
};

}  // namespace clutchwork
