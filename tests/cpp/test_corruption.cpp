// Systems with damaged bytes: refused, or run to some status, while the sanitizers watch.

#include "check.hpp"
#include "models.hpp"

using namespace fixture;

namespace {

int refused = 0, ran = 0;

/// Bytes from anywhere: refused, or run to some status; the sanitizers watch every access.
void survive(const Bytes& bytes) {
  // memory of its own and of exact size
  const Bytes system(bytes.begin(), bytes.end());
  const std::int64_t n = std::int64_t(system.size()), size = cw_size(system.data(), n);
  if (size < 0) {
    CHECK(cw_load(system.data(), n, nullptr, 0) == nullptr);
    ++refused;
    return;
  }
  if (size > (1 << 24)) return;
  Bytes memory(static_cast<std::size_t>(size));
  cw_run* run = cw_load(system.data(), n, memory.data(), size);
  if (!CHECK(run != nullptr)) return;
  ++ran;
  cw_set_option(run, "max_steps", 60);
  cw_set_option(run, "max_events", 50);
  double times[4] = {0, 0.01, 0.2, 0.2}, detail;
  Numbers rows(std::size_t(4 * cw_row_size(run))), events(std::size_t(100 * event_size));
  std::int64_t filled = 0;
  const int status = cw_advance(run, 0.2, times, rows.data(), 4, 0, &filled);
  CHECK(status >= 0 && status < int(Status::running) && filled <= 4);
  cw_take_events(run, events.data(), 100);
  cw_detail(run, &detail);
  cw_set_param(run, 0, 3.0);
  cw_set_input(run, 0, 1.0);
  cw_advance(run, 0.3, times, rows.data(), 4, 1, &filled);
}

constexpr double reals[] = {0, -1, 1e300, -1e300, NAN, INFINITY, 1e-300, 1, 2, 7, 25, 0.1};

void corrupt(const Model& model, std::uint64_t seed, int rounds) {
  const Bytes whole = model.bytes();
  System sys{};
  bind(sys, whole.data(), std::int64_t(whole.size()));
  const auto head = std::size_t(reinterpret_cast<const unsigned char*>(sys.basis_end) - whole.data());
  check::Random g{seed};
  for (std::size_t n = 0; n < head + 100; ++n) survive(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(n)));
  constexpr std::int32_t numbers[] = {-1, 1, 2, 3, 4, 5, 8, 12, 40, 1000, 0x7fffffff, -0x7fffffff - 1};
  for (int round = 0; round < rounds; ++round) {
    Bytes bytes = whole;
    const int changes = 1 + g.below(3);
    for (int k = 0; k < changes; ++k) {
      // the counts are hit often, the rest evenly
      const std::size_t start = g.below(3) == 0 ? 16 : head, size = start == 16 ? head - 16 : bytes.size() - head;
      const std::size_t at = start + std::size_t(g.below(int(size / 4))) * 4;
      const int kind = g.below(4);
      if (kind == 0) bytes[at + std::size_t(g.below(4))] = static_cast<unsigned char>(g.below(256));
      if (kind == 1) std::memcpy(&bytes[at], &numbers[g.below(12)], 4);
      if (kind == 2) std::memcpy(&bytes[at / 8 * 8], &reals[g.below(12)], 8);
      if (kind == 3)
        std::memcpy(&bytes[at], &bytes[head + std::size_t(g.below(int((bytes.size() - head) / 4))) * 4], 4);
    }
    if (g.below(10) == 0) bytes.resize(bytes.size() - std::size_t(g.below(100)));
    survive(bytes);
  }
}

/// Every parameter takes odd values, the curves of laws and their counts among them.
void odd_parameters(const Model& model) {
  const Bytes whole = model.bytes();
  System sys{};
  bind(sys, whole.data(), std::int64_t(whole.size()));
  const auto pool = std::size_t(reinterpret_cast<const unsigned char*>(sys.params) - whole.data());
  auto put = [&](std::int64_t k, double x) {
    Bytes bytes = whole;
    std::memcpy(&bytes[pool + 8 * std::size_t(k)], &x, 8);
    survive(bytes);
    return cw_size(bytes.data(), std::int64_t(bytes.size())) >= 0;
  };
  for (std::int64_t k = 0; k < sys.n_params; ++k) {
    for (double x : {0.0, -1.0, 1e300, double(NAN), 2.0}) put(k, x);
  }
  for (std::int64_t c = 0; c < sys.contacts; ++c) {
    visit_law_curves(sys.contact_law[c], [&](int at) {
      const std::int64_t first = sys.contact_law_param[c] + at;
      const double n = double(sys.n_points), from = sys.params[first], count = sys.params[first + 1];
      for (double x : {0.0, -3.0, n - from + 0.5, n - from + 1, 1e9, double(NAN)}) CHECK(!put(first + 1, x));
      for (double x : {-1.0, n - count + 0.5, n - count + 1, n, 1e9, double(NAN)}) CHECK(!put(first, x));
      for (double x : {1.0, 2.0, 3.0}) put(first + 1, x), put(first, x);
      Run r(whole);
      for (std::int64_t k = first; k < first + 2; ++k) {
        for (double x : {-1.0, 9.0, 1e9, double(NAN)}) CHECK(cw_set_param(r.run, k, x) == 0);
      }
      CHECK(cw_set_param(r.run, sys.contact_param[c], 0.3) == 1);
    });
    // which of a few kinds is meant
    visit_law_choices(sys.contact_law[c], [&](int at, int n) {
      const std::int64_t place = sys.contact_law_param[c] + at;
      for (double x : {-1.0, 0.5, double(n), 1e9, 1e300, double(NAN), double(INFINITY)}) CHECK(!put(place, x));
      CHECK(put(place, sys.params[place]));
    });
  }
}

/// Many points, too few states: as many elements as the curve has points would write beyond them.
void few_states() {
  Model m;
  const int a = m.shaft(1, 2);
  Numbers x, y;
  for (int i = 1; i <= 14; ++i) x.push_back(0.01 * i), y.push_back(0.1);
  const Numbers all = m.curve(x, y), curve{0.3, 0.2, 3, 1, 2, 0.001};
  for (double count : {4.0, 9.0, 10.0, 14.0}) {
    Model n = m;
    n.contact<elements::BearingFriction, laws::GMS>(housing, a, {9}, {}, joined({curve, {all[0], count}, {30, 0}}));
    const Bytes whole = n.bytes();
    survive(whole);
    System sys{};
    bind(sys, whole.data(), std::int64_t(whole.size()));
    CHECK(sys.states == std::int64_t(count < 10 ? count : 10));
    // a state less: the number stands in the header
    Bytes bytes = whole;
    std::int64_t states = sys.states - 1;
    std::memcpy(&bytes[16 + 5 * 8], &states, 8);
    CHECK(cw_size(bytes.data(), std::int64_t(bytes.size())) < 0);
    survive(bytes);
  }
}

/// Signals set again and again without taking the events: the buffer says that it is full.
void untaken_events() {
  Model m;
  const int a = m.shaft(1), b = m.shaft(1);
  const int pressure = m.signal({}, 0);
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {1}, {pressure}, {1, 1});
  Run r(m);
  int full = 0;
  for (int i = 0; i < 1000; ++i) {
    cw_set_input(r.run, pressure, i % 2 == 0 ? 5.0 : 0.0);
    full += r.advance(0.001 * i) == int(Status::events_full);
  }
  CHECK(full > 0);
  CHECK(int(r.events().size()) >= 256 * event_size);
  CHECK(r.advance(2) == 0);
}

/// Room for less than a step's rows is refused, not overrun.
void little_room() {
  Run r(three_shafts());
  double times[2];
  Numbers rows(std::size_t(2 * r.at.size));
  for (int n = 0; n <= 2; ++n) {
    std::int64_t filled = 7;
    Numbers exact(rows.begin(), rows.begin() + n * r.at.size);
    CHECK(cw_advance(r.run, 1, times, exact.data(), n, 1, &filled) == int(Status::rows_full));
    CHECK(filled <= n);
  }
  CHECK(cw_set_input(r.run, 0, 1) == 1 && cw_set_input(r.run, -1, 1) == 0 && cw_set_input(r.run, 99, 1) == 0);
  CHECK(cw_set_param(r.run, -1, 1) == 0 && cw_set_param(r.run, 9999, 1) == 0);
  CHECK(cw_set_option(r.run, "rtol", NAN) == 0 && cw_set_option(r.run, "no such", 1) == 0);
}

}  // namespace

int test_corruption() {
  untaken_events();
  little_room();
  corrupt(three_shafts(), 3, check::part(6000));
  corrupt(chain(), 4, check::part(1500));
  corrupt(bristles(), 5, check::part(800));
  corrupt(hysteresis(), 6, check::part(600));
  corrupt(warm(), 7, check::part(600));
  corrupt(long_row(), 8, check::part(2000));
  odd_parameters(bristles());
  odd_parameters(hysteresis());
  odd_parameters(warm());
  few_states();
  CHECK(refused > 500 && ran > 500);
  std::printf("%d refused, %d ran\n", refused, ran);
  return check::result();
}
