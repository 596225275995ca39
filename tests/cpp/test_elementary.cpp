// Elementary functions against those of the library in longer numbers, and the bits that every machine has of them.

#include <clutchwork/components/elementary.hpp>
#include <clutchwork/components/lanes.hpp>
#include <clutchwork/run/step_size.hpp>

#include <cstring>
#include <initializer_list>

#include "check.hpp"

namespace core = clutchwork;

namespace {

/// How far a result is from the true one, in units of its last place.
double units(double found, long double truth) {
  const double size = std::fabs(double(truth));
  return double(std::fabs(static_cast<long double>(found) - truth)) / (std::nextafter(size, INFINITY) - size);
}

/// f against the truth at random places, `most` units apart where the library has longer numbers.
template <class F, class Truth>
void compare(F&& f, Truth&& truth, double low, double high, double most = 2) {
  // where long double is double the library is half a unit away itself
  const double more = sizeof(long double) > sizeof(double) ? 0 : 1;
  check::Random g{7};
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double x = g.between(low, high);
    worst = std::fmax(worst, units(f(x), truth(static_cast<long double>(x))));
  }
  CHECK_NEAR(worst, 0.0, most + more);
}

void against_the_library() {
  const auto exp = [](double x) { return core::exp(x); };
  compare(exp, [](auto x) { return std::exp(x); }, -1, 1, 1);
  compare(exp, [](auto x) { return std::exp(x); }, -700, 709.7);
  compare([](double x) { return core::log(x); }, [](auto x) { return std::log(x); }, 0, 10, 1);
  const auto far = [](auto x) { return std::exp2(double(x)); };
  compare([&](double x) { return core::log(far(x)); }, [&](auto x) { return std::log(decltype(x)(far(x))); }, -1e3, 1e3,
          1);
  compare([](double x) { return core::sin(x); }, [](auto x) { return std::sin(x); }, -7, 7, 1);
  compare([](double x) { return core::cos(x); }, [](auto x) { return std::cos(x); }, -7, 7, 1);
  compare([](double x) { return core::tanh(x); }, [](auto x) { return std::tanh(x); }, -25, 25);
  compare([](double x) { return core::tanh(x); }, [](auto x) { return std::tanh(x); }, -0.6, 0.6, 1);
  compare([](double x) { return core::atan(x); }, [](auto x) { return std::atan(x); }, -3, 3);
  compare([](double x) { return core::atan(x); }, [](auto x) { return std::atan(x); }, -1e6, 1e6, 1);
  compare([](double x) { return core::cbrt(x); }, [](auto x) { return std::cbrt(x); }, 0, 100);
  compare([&](double x) { return core::fifth_root_of_inverse(far(x)); },
          [&](auto x) { return 1 / std::pow(decltype(x)(far(x)), decltype(x)(1) / 5); }, -1000, 1000, 4);
  for (double power : {-0.2, 0.5, 1.7, 40.3})
    compare([&](double x) { return core::pow(x, power); }, [&](auto x) { return std::pow(x, decltype(x)(power)); }, 0,
            10);
}

/// Angles after many turns: what counts there is the error, not its share of a sine that is almost zero.
void many_turns() {
  check::Random g{8};
  for (int i = 0; i < 20000; ++i) {
    const double x = g.between(-4e8, 4e8);
    const auto longer = static_cast<long double>(x);
    CHECK_NEAR(core::sin(x), double(std::sin(longer)), 2e-16);
    CHECK_NEAR(core::cos(x), double(std::cos(longer)), 2e-16);
  }
  for (double x : {1e10, -1e18, 1e300}) {
    const double s = core::sin(x), c = core::cos(x);
    CHECK_NEAR(s * s + c * c, 1.0, 1e-15);
  }
}

void at_the_ends() {
  const double infinite = INFINITY, none = NAN;
  CHECK(core::exp(0.0) == 1 && core::exp(710.0) == infinite && core::exp(-750.0) == 0);
  CHECK(core::exp(infinite) == infinite && core::exp(-infinite) == 0);
  CHECK(units(core::exp(-744.0), std::exp(-744.0L)) <= 1);
  CHECK(core::log(1.0) == 0 && core::log(0.0) == -infinite && core::log(infinite) == infinite);
  CHECK(std::isnan(core::log(-1.0)) && units(core::log(0x1p-1074), std::log(0x1p-1074L)) <= 1);
  CHECK(core::pow(2.0, 10.0) == 1024 && core::pow(-2.0, 3.0) == -8 && std::isnan(core::pow(-2.0, 0.5)));
  CHECK(core::pow(0.0, 2.0) == 0 && core::pow(0.0, -1.0) == infinite && core::pow(0.0, 0.0) == 1);
  CHECK(core::pow(10.0, 400.0) == infinite && core::pow(10.0, -400.0) == 0);
  CHECK(core::pow(10.0, 310.0) == infinite && core::pow(3.0, 700.0) == infinite && core::pow(10.0, -323.0) > 0);
  CHECK(core::pow(infinite, 2.0) == infinite && core::pow(infinite, -2.0) == 0);
  CHECK(core::sin(0.0) == 0 && core::cos(0.0) == 1 && std::isnan(core::sin(infinite)) && std::isnan(core::cos(none)));
  CHECK(core::tanh(30.0) == 1 && core::tanh(-infinite) == -1 && std::isnan(core::tanh(none)));
  CHECK(core::atan(infinite) == 1.5707963267948966 && core::atan(-infinite) == -1.5707963267948966);
  CHECK(core::cbrt(0.0) == 0 && core::cbrt(27.0) == 3);
  using Function = double (*)(double);
  for (const Function f : {Function(core::exp), Function(core::log), Function(core::atan), Function(core::cbrt)})
    CHECK(std::isnan(f(none)));
}

/// One number that depends on every bit of 260 000 results: the same for all compilers and processors.
void the_same_everywhere() {
  check::Random g{9};
  std::uint64_t sum = 0;
  const auto add = [&](double x) { sum = (sum ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u; };
  for (int i = 0; i < 20000; ++i) {
    const double x = g.between(-20, 20), y = g.between(0.01, 20), far = g.between(-1, 1);
    add(core::exp(x)), add(core::log(y)), add(core::pow(y, 0.1 * x)), add(core::sin(1e3 * x)), add(core::cos(x));
    add(core::tanh(x)), add(core::atan(x)), add(core::cbrt(y));
    add(core::exp(745 * far)), add(core::log(y * 0x1p-1070)), add(core::sin(1e12 * far)),
        add(core::pow(1.4, 2200 * far));
    add(core::pow(-y, double(g.below(9) - 4)));
  }
  CHECK(sum == 13293417841469207751u);
}

/// Eight numbers at once have the bits of each alone, whatever is beside it.
template <int R>
void the_same_in_lanes() {
  using Eight = core::Lanes<R>;
  check::Random g{10};
  const double ends[] = {0.0, -0.0, 0.625, -20, 708, -708, 709.5, -745, 1e300, INFINITY, -INFINITY, NAN, 5e-324};
  for (int i = 0; i < 4000; ++i) {
    const double width = i % 3 == 0 ? 0.7 : i % 3 == 1 ? 25 : 750;
    Eight x;
    for (int k = 0; k < core::n_lanes; ++k) x[k] = g.below(8) == 0 ? ends[g.below(13)] : g.between(-width, width);
    const Eight e = exp(x), t = tanh(x);
    for (int k = 0; k < core::n_lanes; ++k) {
      const double alone[] = {core::exp(x[k]), core::tanh(x[k])}, together[] = {e[k], t[k]};
      CHECK(std::memcmp(alone, together, sizeof alone) == 0);
    }
  }
}

}  // namespace

int test_elementary() {
  the_same_in_lanes<2>();
  the_same_in_lanes<4>();
  against_the_library();
  many_turns();
  at_the_ends();
  the_same_everywhere();
  return check::result();
}
