#include <clutchwork/branch.hpp>
#include <initializer_list>

#include "check.hpp"

/// Every function of every registered component: dual numbers against plain ones and central differences.
using namespace clutchwork;

namespace {

// arguments of a function: rate, states, inputs, parameters
constexpr int most = 16;
using D = Dual<double, most>;
constexpr double points[8 * 3] = {0, 1, 0.5,  1, 1.5, -0.2, 2, 1.3, -0.1, 3, 1.2, 0,
                                  4, 1, -0.3, 5, 0.7, 0.1,  6, 0.8, 0.2,  7, 1,   0.3};

/// Compare f at x; arguments with step zero are not differentiated.
template <class F>
void differentiate(F&& f, const double* x, int n, const bool* fixed) {
  D dual[most];
  double moved[most];
  for (int i = 0; i < n; ++i) dual[i] = D::variable(x[i], i), moved[i] = x[i];
  const D r = f(static_cast<const D*>(dual));
  const double plain = f(x);
  if (plain - plain != 0) return;
  CHECK(check::same_bits(r.v, plain));
  bool zero = false;
  for (int i = 0; i < n; ++i) zero = zero || fixed[i];
  for (int i = 0; i < n; ++i) {
    // a parameter of zero may divide: then only the value counts
    if (fixed[i] || (zero && r.d[i] - r.d[i] != 0)) continue;
    const double h = 1e-6 * (1 + abs(x[i]));
    moved[i] = x[i] + h;
    const double up = f(static_cast<const double*>(moved));
    moved[i] = x[i] - h;
    const double down = f(static_cast<const double*>(moved));
    moved[i] = x[i];
    const double slope = (up - down) / (2 * h);
    CHECK_NEAR(r.d[i], slope, 1e-7 * (1 + abs(slope)) + 1e-9 * abs(plain));
  }
}

/// Run `call(params, at)` over rates, pieces and parameter sets, one parameter at a time also zero.
template <class E, class F>
void over_arguments(F&& call, int inputs, int states) {
  using P = typename E::template Params<double>;
  constexpr int np = int(sizeof(P) / sizeof(double));
  const int n = 1 + states + inputs + np;
  check::Random g{17};
  for (double rate : {-60.0, -3.1, -0.4, 0.7, 2.9, 60.0}) {
    for (int zero = -1; zero < np; ++zero) {
      double x[most] = {rate};
      bool fixed[most] = {};
      for (int i = 1; i < 1 + states + inputs; ++i) x[i] = g.between(-2, 2);
      // above one and no whole numbers: a curve among them keeps its points when it is moved
      for (int k = 0; k < np; ++k) x[n - np + k] = k == zero ? 0.0 : 1.35 + 0.3 * k;
      if (zero >= 0) fixed[n - np + zero] = true;
      int edges = 0;
      if constexpr (Kinked<E, double>) edges = E::edges(*reinterpret_cast<const P*>(x + n - np));
      for (int piece = 0; piece <= edges; ++piece) {
        differentiate(
            [&](const auto* v) {
              using S = std::remove_cvref_t<decltype(*v)>;
              const auto& p = *reinterpret_cast<const typename E::template Params<S>*>(v + n - np);
              return call(p, At<S>{v[0], v + 1, v + 1 + states, piece, points});
            },
            x, n, fixed);
      }
    }
  }
}

void torque_kinds_all() {
  for (int kind = 0; kind < torque_kinds; ++kind) {
    visit_torque(kind, [](auto tag) {
      using E = typename decltype(tag)::type;
      over_arguments<E>([](const auto& p, const auto& at) { return E::torque(p, at); }, E::inputs, E::states);
      for (int i = 0; i < E::states; ++i) {
        over_arguments<E>(
            [i](const auto& p, const auto& at) {
              std::remove_cvref_t<decltype(at.rate)> rates[E::states > 0 ? E::states : 1];
              E::state_rates(p, at, rates);
              return rates[i];
            },
            E::inputs, E::states);
      }
    });
  }
}

void contact_kinds_all() {
  for (int kind = 0; kind < contact_kinds; ++kind) {
    visit_contact(kind, [](auto tag) {
      using E = typename decltype(tag)::type;
      over_arguments<E>([](const auto& p, const auto& at) { return E::load(p, at); }, E::inputs, E::states);
    });
  }
}

void law_kinds_all() {
  for (int kind = 0; kind < law_kinds; ++kind) {
    visit_law(kind, [](auto tag) {
      using L = typename decltype(tag)::type;
      over_arguments<L>([](const auto& p, const auto& at) { return L::slide(p, at); }, 0, L::states);
      over_arguments<L>(
          [](const auto& p, const auto& at) -> std::remove_cvref_t<decltype(at.rate)> { return L::hold(p); }, 0,
          L::states);
    });
  }
}

/// The partial derivatives that the integrators use: by rate, by own states, by time through rate and inputs.
void branches() {
  check::Random g{23};
  Workspace<double> ws;
  ws.sys.points = points;
  for (int kind = 0; kind < torque_kinds + contact_kinds * law_kinds; ++kind) {
    double params[8], law[8], input[4], slope[4], moved[4], state[4], rates[4], more[4], partials[3][4], own[16];
    for (int i = 0; i < 8; ++i) params[i] = law[i] = 1.35 + 0.3 * i;
    for (int i = 0; i < 4; ++i) input[i] = g.between(0.5, 2), slope[i] = g.between(-1, 1), state[i] = g.between(-1, 1);
    const int contact = kind - torque_kinds;
    Branch<double> b{params, law, input, slope, kind, -1, 0, 0, 0, 0, 0, false};
    if (contact >= 0) b.kind = contact / law_kinds, b.law = contact % law_kinds, b.sign = kind % 2 == 0 ? 1 : -1;
    b.states = states_of<double>(b.kind, b.law);
    const double rate = 0.8 * (b.sign < 0 ? -1 : 1), turn = 0.3, h = 1e-6;
    for (int held = 0; held <= (contact >= 0 ? 1 : 0); ++held) {
      b.held = held != 0;
      b.input = input;
      const Partial<double> p =
          branch_partial(ws, b, rate, turn, state, rates, {partials[0], partials[1], partials[2], own});
      auto torque = [&](double r) { return branch_torque(ws, b, r, state, more); };
      const double here = torque(rate);
      CHECK(check::same_bits(here, p.torque));
      for (int i = 0; i < b.states; ++i) CHECK(check::same_bits(more[i], rates[i]));
      CHECK_NEAR(p.by_rate, (torque(rate + h) - torque(rate - h)) / (2 * h), 1e-8);
      for (int i = 0; i < b.states; ++i) {
        const double keep = state[i];
        state[i] = keep + h;
        const double up = torque(rate);
        state[i] = keep;
        CHECK_NEAR(partials[0][i], (up - here) / h, 1e-6);
        torque(rate + h);
        CHECK_NEAR(partials[1][i], (more[i] - rates[i]) / h, 1e-6);
      }
      double ends[2];
      for (int side = 0; side < 2; ++side) {
        const double dt = side == 0 ? -h : h;
        for (int i = 0; i < 4; ++i) moved[i] = input[i] + dt * slope[i];
        b.input = moved;
        ends[side] = torque(rate + dt * turn);
      }
      CHECK_NEAR(p.by_time, (ends[1] - ends[0]) / (2 * h), 1e-8);
    }
  }
}

}  // namespace

int main() {
  torque_kinds_all();
  contact_kinds_all();
  law_kinds_all();
  branches();
  return check::result();
}
