// Dual numbers: derivatives of every function, and values that have the bits of plain numbers.

#include <clutchwork/components/dual.hpp>

#include "check.hpp"

using namespace clutchwork;
using D = Dual<double, 2>;

namespace {

// not those of the library
using clutchwork::cos, clutchwork::exp, clutchwork::log, clutchwork::pow, clutchwork::sin, clutchwork::tanh;

/// f at (x, y): both partial derivatives, and the value as plain numbers give it to the last bit.
template <class F>
void differentiate(F&& f, double x, double y) {
  const D r = f(D::variable(x, 0), D::variable(y, 1));
  CHECK(check::same_bits(r.v, f(x, y)));
  const double h = 1e-5 * (1 + abs(x)), k = 1e-5 * (1 + abs(y));
  const double dx = (f(x + h, y) - f(x - h, y)) / (2 * h), dy = (f(x, y + k) - f(x, y - k)) / (2 * k);
  CHECK_NEAR(r.d[0], dx, 1e-8 * (1 + abs(dx) + abs(r.v)));
  CHECK_NEAR(r.d[1], dy, 1e-8 * (1 + abs(dy) + abs(r.v)));
}

void functions() {
  check::Random g{5};
  for (int round = 0; round < 500; ++round) {
    const double x = g.between(0.2, 3), y = g.between(0.2, 3), z = g.between(-3, 3);
    differentiate([](auto a, auto b) { return a + b; }, x, z);
    differentiate([](auto a, auto b) { return a - b; }, x, z);
    differentiate([](auto a, auto b) { return a * b; }, x, z);
    differentiate([](auto a, auto b) { return a / b; }, z, y);
    differentiate([](auto a, auto b) { return -a / (b * b + 1.0); }, z, y);
    differentiate([](auto a, auto b) { return exp(a) * log(b); }, z, y);
    differentiate([](auto a, auto b) { return sin(a) / sqrt(b); }, z, y);
    differentiate([](auto a, auto b) { return cos(a) * tanh(b); }, z, x);
    differentiate([](auto a, auto b) { return pow(a, b); }, x, z);
    differentiate([](auto a, auto b) { return abs(a) * abs(b); }, z, x);
    differentiate([](auto a, auto b) { return larger(a, b) - smaller(a * a, b); }, z, x + 0.01);
    differentiate([](auto a, auto b) { return a /= b, a *= a, a += b, a -= 1.0; }, z, y);
  }
}

void comparisons() {
  const D one(1.0), two = D::variable(2.0, 1);
  CHECK(one < two && two > one && one <= two && two >= one && one != two && two == D(2.0));
  CHECK(value(two) == 2.0);
  CHECK(two.d[0] == 0 && two.d[1] == 1);
}

/// Duals of duals carry second derivatives.
void nested() {
  using N = Dual<Dual<double, 1>, 1>;
  N x(Dual<double, 1>::variable(0.7, 0));
  x.d[0] = Dual<double, 1>(1.0);
  const N y = sin(x) * exp(x) / x;
  const double s = std::sin(0.7), c = std::cos(0.7), e = std::exp(0.7), t = 0.7;
  const double second = 2 * c * e / t - 2 * (s + c) * e / (t * t) + 2 * s * e / (t * t * t);
  CHECK_NEAR(y.d[0].d[0], second, 1e-13);
  CHECK(value(y) == value(sin(0.7) * exp(0.7) / 0.7));
}

}  // namespace

int test_dual() {
  functions();
  comparisons();
  nested();
  return check::result();
}
