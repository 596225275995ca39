// Formulas of friction laws: what their words compute for every scalar, and which words are refused.

#include <clutchwork/components/dual.hpp>
#include <clutchwork/components/lanes.hpp>
#include <vector>

#include "check.hpp"
#include "fixture.hpp"

using namespace clutchwork;
using namespace fixture;

namespace {

using F = laws::Formula;
using D = laws::DynamicFormula;

/// low + (high - low) exp(-v/width), as Python writes it; at rest `high`.
struct Falling {
  static constexpr int own = 3;
  // curves of the words and of the head, then low, high, width
  double params[4 + own] = {0, 6, 6, 2, 0.3, 0.4, 0.5};
  std::vector<double> points;

  Falling() {
    put(Operation::subtract, 4, 3), put(Operation::negate, 0, 0), put(Operation::divide, 7, 5);
    put(Operation::exp_behind, 8, 0), put(Operation::multiply, 6, 9), put(Operation::add, 3, 10);
    // registers of both coefficients and the words of the first; numbers, constants, words of rates
    points.insert(points.end(), {11, 4, 6, own, 0, 6});
  }
  void put(Operation what, double a, double b) { points.insert(points.end(), {double(int(what)), a, b}); }
  const F::Params<double>& p() const { return *reinterpret_cast<const F::Params<double>*>(params); }
};

double expected(double v) { return 0.3 + (0.4 - 0.3) * clutchwork::exp(-v / 0.5); }

void values() {
  Falling f;
  const double input[2] = {300, 1e5};
  CHECK(F::is_sound(f.p(), f.points.data(), Falling::own));
  for (double v : {0.0, 1e-9, 0.2, 3.0, 100.0, -0.1}) {
    const At<double> at{v, nullptr, input, 0, f.points.data()};
    CHECK(check::same_bits(F::slide(f.p(), at), expected(v)));
    CHECK(F::hold(f.p(), At<double>{0, nullptr, input, 0, f.points.data()}) == 0.4);
    // duals have the same value, and the slope of the formula
    using S = Dual<double, 2>;
    const S inputs[2] = {S(300), S(1e5)};
    const S x = F::slide(f.p(), At<S>{S::variable(v, 0), nullptr, inputs, 0, f.points.data()});
    CHECK(check::same_bits(x.v, expected(v)));
    CHECK_NEAR(x.d[0], -(0.4 - 0.3) / 0.5 * clutchwork::exp(-v / 0.5), 1e-15);
    CHECK(x.d[1] == 0);
  }
  // what a trial step meets far behind the zero is finite
  const double far = F::slide(f.p(), At<double>{-1e4, nullptr, input, 0, f.points.data()});
  CHECK(far == 0.3 + (0.4 - 0.3) * clutchwork::exp(20.0));
}

void lanes_have_the_bits_of_one() {
  Falling f;
  using L = Lanes<2>;
  alignas(64) L params[7];
  std::vector<L> points(f.points.begin(), f.points.end());
  for (int i = 0; i < 7; ++i) params[i] = L(f.params[i]);
  for (int i = 0; i < n_lanes; ++i) params[4][i] = 0.3 + 0.01 * i;
  L v(0.0);
  for (int i = 0; i < n_lanes; ++i) v[i] = 0.3 * i - 0.1;
  const L input[2] = {L(300.0), L(1e5)};
  const auto& p = *reinterpret_cast<const F::Params<L>*>(params);
  const L together = F::slide(p, At<L>{v, nullptr, input, 0, points.data()});
  for (int i = 0; i < n_lanes; ++i) {
    Falling one;
    one.params[4] = 0.3 + 0.01 * i;
    const double plain[2] = {300, 1e5};
    CHECK(check::same_bits(together[i], F::slide(one.p(), At<double>{v[i], nullptr, plain, 0, one.points.data()})));
  }
}

/// Words that read or write what is not there are refused, each number on its own.
void damage() {
  const Falling whole;
  CHECK(!F::is_sound(whole.p(), whole.points.data(), Falling::own - 1));
  const double odd[] = {-1, 0.5, 12, 63, 64, 1e9, 1e300, NAN, INFINITY};
  int refused = 0;
  for (std::size_t i = 0; i < whole.points.size(); ++i) {
    for (double x : odd) {
      Falling one;
      one.points[i] = x;
      if (!F::is_sound(one.p(), one.points.data(), Falling::own)) {
        ++refused;
        continue;
      }
      // what is taken can be computed
      const double input[2] = {300, 1e5};
      F::slide(one.p(), At<double>{1, nullptr, input, 0, one.points.data()});
      F::hold(one.p(), At<double>{0, nullptr, input, 0, one.points.data()});
    }
  }
  CHECK(refused > 100);
}

/// Operations in one word have the bits of those that they are made of, for duals too.
void fused() {
  const double low = 0.3, high = 0.4, width = 0.5, v = 0.7, input[2] = {300, 1e5};
  const Operation what[] = {Operation::bell, Operation::add_quotient, Operation::subtract_quotient};
  const double wanted[] = {clutchwork::exp(-((v / width) * (v / width))), low + v / width, low - v / width};
  for (int i = 0; i < 3; ++i) {
    double params[7] = {0, 1, 1, 2, low, high, width};
    const double points[] = {double(int(what[i]) + 3 * words_per_operation), 0, 5, 6, 6, 1, 3, 0, 1};
    const auto& p = *reinterpret_cast<const F::Params<double>*>(params);
    CHECK(F::is_sound(p, points, 3));
    CHECK(check::same_bits(F::slide(p, At<double>{v, nullptr, input, 0, points}), larger(wanted[i], 0.0)));
    using S = Dual<double, 1>;
    const S inputs[2] = {S(300), S(1e5)};
    const S x = F::slide(p, At<S>{S::variable(v, 0), nullptr, inputs, 0, points});
    const double slopes[] = {-2 * v / (width * width) * wanted[0], 1 / width, 0};
    CHECK_NEAR(x.d[0], slopes[i], 1e-14);
  }
}

/// A coefficient without a value holds nothing, whichever of both it is.
void no_value() {
  for (int gone = 0; gone < 2; ++gone) {
    double params[6] = {0, 0, 0, 2, 0.3, 0.4};
    const double points[] = {3, 4, 0, 2, 0, 0}, input[2] = {300, 1e5};
    params[4 + gone] = NAN;
    const auto& p = *reinterpret_cast<const F::Params<double>*>(params);
    const double held = F::hold(p, At<double>{0, nullptr, input, 0, points});
    CHECK(held != held);
  }
}

/// A state of the law: elastic' = v, the coefficient is the state; without a state it is zero at rest.
void states() {
  double params[6] = {0, 1, 1, 2, 3, 2}, points[15] = {0, 0, 0, 3, 4, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  const auto& p = *reinterpret_cast<const D::Params<double>*>(params);
  CHECK(D::count(p) == 1);
  CHECK(D::is_sound(p, points, 0));
  const double input[2] = {300, 1e5}, state[1] = {0.25};
  double rates[1] = {NAN};
  CHECK(D::coefficient_and_rates(p, At<double>{2, state, input, 0, points}, rates) == 0.25);
  CHECK(rates[0] == 2);
  CHECK(D::coefficient(p, At<double>{2, state, input, 0, points}) == 0.25);
  CHECK(D::hold(p, At<double>{0, nullptr, input, 0, points}) == 0);
  params[5] = 7;
  CHECK(!D::is_sound(p, points, 0));
  params[5] = 2, points[12] = 5;
  CHECK(!D::is_sound(p, points, 0));
}

}  // namespace

int test_formula() {
  values();
  lanes_have_the_bits_of_one();
  damage();
  fused();
  no_value();
  states();
  return check::result();
}
