// Saved states with damage of every kind: refused, or run on to a status, while the sanitizers watch.

#include <cstdlib>
#include <fingerprint.hpp>

#include "check.hpp"
#include "models.hpp"

using namespace fixture;

/// Saved states with damage of every kind: each is refused and leaves the run as it is, or the run goes on to a status.
/// The sanitizers watch. CLUTCHWORK_CASES sets how many are tried.
namespace {

int refused = 0, accepted = 0;

void seal(Bytes& state) {
  const std::uint64_t sum = state_head::checksum_of(state.data(), std::int64_t(state.size()));
  std::memcpy(&state[8 * state_head::checksum], &sum, 8);
}

bool restore(Run& r, const Bytes& state) { return cw_restore(r.run, state.data(), std::int64_t(state.size())) == 1; }

/// Runs a little, whatever the budgets in the state are.
void go_on(Run& r) {
  int left = 400;
  auto poll = [](void* count) { return int(--*static_cast<int*>(count) < 0); };
  cw_set_poll(r.run, poll, &left);
  std::int64_t counts[7], filled = 0;
  cw_statistics(r.run, counts);
  cw_set_option(r.run, "max_steps", double(counts[0] + counts[1]) + 40);
  const double from = cw_time(r.run);
  double times[4] = {from, from + 0.02, from + 0.3, from + 0.3};
  Numbers rows(std::size_t(4 * r.at.size));
  for (int steps = 0; steps < 2; ++steps) {
    const double end = cw_time(r.run) + 0.3;
    const int status = cw_advance(r.run, end, times, rows.data(), 4, steps, &filled);
    CHECK(status >= 0 && status < int(Status::running) && filled <= 4);
    for (std::int64_t i = 0; i < filled * r.at.size; ++i) CHECK(std::isfinite(rows[std::size_t(i)]));
    r.events();
    cw_set_input(r.run, 1, 2.5);
    cw_set_param(r.run, 0, 3.0);
  }
  CHECK(restore(r, r.save()));
  cw_set_poll(r.run, nullptr, nullptr);
}

/// A state goes into a run that stands elsewhere; refused, it changes nothing.
void survive(Run& r, const Bytes& elsewhere, const Bytes& damaged) {
  CHECK(restore(r, elsewhere));
  const Bytes exact(damaged.begin(), damaged.end());
  if (restore(r, exact)) {
    ++accepted;
    go_on(r);
    return;
  }
  ++refused;
  CHECK(r.save() == elsewhere);
}

std::uint64_t odd_word(check::Random& g) {
  constexpr double reals[] = {0, -0.0, -1, 1e300, -1e300, NAN, INFINITY, -INFINITY, 1e-300, 1, 0.1, 1e17, 0.7};
  constexpr std::int64_t wholes[] = {
      -1, 0, 1, 2, 3, 4, 5, 7, 8, 9, 40, 1 << 20, 1ll << 31, 1ll << 52, 1ll << 60, ~(1ll << 63), 1ll << 63, -2};
  std::uint64_t word;
  if (g.below(2) == 0) {
    std::memcpy(&word, &reals[g.below(13)], 8);
  } else {
    std::memcpy(&word, &wholes[g.below(18)], 8);
  }
  return word;
}

/// One change behind the head, or in it.
void damage(Bytes& state, const Bytes& other, check::Random& g) {
  // one of them may be longer, by the segments that were set
  const int words = int((state.size() < other.size() ? state : other).size() / 8);
  // what is first are counts, flags and cursors
  const int word = g.below(5) < 3 ? g.below(words < 400 ? words : 400) : g.below(words);
  unsigned char* at = &state[std::size_t(8 * word)];
  std::uint64_t x;
  std::memcpy(&x, at, 8);
  switch (g.below(6)) {
    case 0:
      at[g.below(8)] ^= static_cast<unsigned char>(1 << g.below(8));
      return;
    case 1:
      at[g.below(8)] = static_cast<unsigned char>(g.below(256));
      return;
    case 2:
      x = odd_word(g);
      break;
    case 3:
      x += g.below(2) == 0 ? 1u : ~0ull;
      break;
    case 4:
      std::memcpy(&x, &state[std::size_t(8 * g.below(words))], 8);
      break;
    default: {
      const int n = 1 + g.below(words - word);
      std::memcpy(at, &other[std::size_t(8 * word)], std::size_t(8 * n));
      return;
    }
  }
  std::memcpy(at, &x, 8);
}

void corrupt(const Model& model, std::uint64_t seed, int cases) {
  check::Random g{seed};
  Run r(model);
  std::vector<Bytes> states{r.save()};
  for (double t : {0.0, 0.13, 0.3, 0.51, 0.83, 1.25, 1.7}) {
    CHECK(r.advance(t) == 0);
    states.push_back(r.save());
    r.events();
    states.push_back(r.save());
    cw_set_input(r.run, 1, 4 + t);
    states.push_back(r.save());
    if (t < 0.3 || r.sys.input_count[0] == 0) continue;
    const std::int64_t n = r.sys.input_count[0], first = r.sys.input_first[0];
    Numbers other(r.sys.segment_coef + segment_size * first, r.sys.segment_coef + segment_size * (first + n));
    for (double& c : other) c *= 1 - 0.1 * t;
    CHECK(cw_set_segments(r.run, 0, r.sys.segment_time + first, other.data(), n) == 1);
    states.push_back(r.save());
  }
  const int n = int(states.size());
  for (int i = 0; i < cases; ++i) {
    Bytes state = states[std::size_t(g.below(n))];
    const Bytes& other = states[std::size_t(g.below(n))];
    const Bytes whole = state;
    const bool sealed = g.below(4) != 0;
    for (int k = 1 + g.below(3); k > 0; --k) damage(state, other, g);
    if (sealed) seal(state);
    if (g.below(20) == 0) state.resize(std::size_t(g.below(int(state.size()))));
    if (g.below(40) == 0) state.resize(state.size() + 8);
    const int before = accepted;
    survive(r, states[0], state);
    // without a new checksum only what is whole is taken
    CHECK(sealed || accepted == before || state == whole || state == other);
  }
}

/// A state says to which core, system and size it belongs.
void belongs() {
  Run r(three_shafts()), other(chain());
  CHECK(r.advance(0.5) == 0);
  const Bytes state = r.save(), before = other.save();
  CHECK(!restore(other, state));
  CHECK(other.save() == before);
  // what stands where, and of which system
  for (std::int64_t word : {state_head::layout, state_head::system, state_head::size}) {
    CHECK(std::memcmp(&state[std::size_t(8 * word)], &before[std::size_t(8 * word)], 8) != 0);
  }
  for (std::int64_t word : {0, 1, 2, 3, 4, 5}) {
    Bytes bytes = state;
    bytes[std::size_t(8 * word)] ^= 1;
    if (word != state_head::checksum) seal(bytes);
    CHECK(!restore(r, bytes));
  }
  // the same layout with another number in it
  Bytes system = r.system;
  double inertia = 0.25;
  System sys{};
  bind(sys, system.data(), std::int64_t(system.size()));
  std::memcpy(&system[std::size_t(reinterpret_cast<const unsigned char*>(sys.inertia) - system.data())], &inertia, 8);
  Run heavier(system);
  CHECK(!restore(heavier, state));
  CHECK(restore(r, state));
}

/// Calls that make no sense are refused, and nothing else happens.
void refused_calls() {
  Run r(driven());
  CHECK(r.advance(0.2) == 0);
  const Bytes before = r.save();
  double times[3] = {0.3, 0.4, 0.5};
  Numbers rows(std::size_t(3 * r.at.size));
  for (double t : {double(NAN), double(INFINITY), -double(INFINITY), 0.1, -1.0}) {
    std::int64_t filled = 7;
    CHECK(cw_advance(r.run, t, times, rows.data(), 3, 0, &filled) == -1);
    CHECK(filled == 0);
  }
  CHECK(cw_advance(r.run, 0.5, times, rows.data(), -1, 0, nullptr) == -1);
  CHECK(cw_advance(r.run, 0.5, nullptr, rows.data(), 3, 0, nullptr) == -1);
  CHECK(cw_advance(r.run, 0.5, times, nullptr, 3, 1, nullptr) == -1);
  CHECK(cw_advance(nullptr, 0.5, times, rows.data(), 3, 0, nullptr) == -1);
  CHECK(cw_row(r.run, nullptr) == -1 && cw_row(nullptr, rows.data()) == -1);
  CHECK(cw_take_events(r.run, rows.data(), -1) == -1 && cw_take_events(r.run, nullptr, 3) == -1);
  CHECK(cw_take_events(nullptr, rows.data(), 1) == -1 && cw_take_events(r.run, nullptr, 0) == 0);
  for (double x : {double(NAN), double(INFINITY), -double(INFINITY)}) {
    CHECK(cw_set_param(r.run, 0, x) == 0 && cw_set_input(r.run, 1, x) == 0);
    CHECK(cw_set_option(r.run, "rtol", x) == 0 && cw_set_option(r.run, "max_steps", x) == 0);
  }
  for (double x : {-1.0, 2.5, 4.0}) CHECK(cw_set_option(r.run, "method", x) == 0);
  CHECK(cw_set_option(r.run, "max_steps", 2.5) == 0 && cw_set_option(r.run, nullptr, 1) == 0);
  CHECK(cw_set_option(nullptr, "rtol", 1) == 0 && cw_set_input(nullptr, 1, 1) == 0 && cw_set_param(nullptr, 0, 1) == 0);
  CHECK(cw_save(r.run, rows.data(), 8) == -1 && cw_save(r.run, nullptr, 1 << 20) == -1);
  CHECK(cw_save(nullptr, rows.data(), 8) == -1 && cw_state_size(nullptr) == -1);
  CHECK(cw_restore(r.run, nullptr, 8) == 0 && cw_restore(nullptr, before.data(), 8) == 0);
  for (std::int64_t n : {std::int64_t(-1), std::int64_t(0), std::int64_t(40), std::int64_t(1) << 62})
    CHECK(cw_restore(r.run, before.data(), n) == 0);
  CHECK(cw_size(nullptr, 100) == -1 && cw_load(nullptr, 100, nullptr, 100) == nullptr);
  CHECK(cw_load(r.system.data(), std::int64_t(r.system.size()), nullptr, 1 << 20) == nullptr);
  CHECK(std::isnan(cw_time(nullptr)) && cw_row_size(nullptr) == -1 && cw_detail(nullptr, nullptr) == -1);
  CHECK(cw_detail_row(nullptr) == -1 && cw_set_poll(nullptr, nullptr, nullptr) == 0);
  CHECK(cw_read(nullptr, nullptr, 0, nullptr, 0) == 0);
  cw_statistics(nullptr, nullptr), cw_statistics(r.run, nullptr);
  CHECK(r.save() == before);
}

/// Where the parameter of a run stands in its states: the word that follows it when it is set.
std::size_t place_of(Run& r, std::int64_t param) {
  const double value = 0.123456789;
  const Bytes before = r.save();
  if (!CHECK(cw_set_param(r.run, param, value) == 1)) return 0;
  const Bytes state = r.save();
  std::size_t at = 8 * state_head::words;
  for (; at < state.size(); at += 8) {
    if (std::memcmp(&state[at], &value, 8) == 0) break;
  }
  CHECK(restore(r, before));
  return at;
}

/// Whichever of a few kinds is meant stays, and where curves stand; numbers may be set, and come back from a state.
void fixed_parameters() {
  for (const Model& model : {warm(), hysteresis(), three_shafts(), driven()}) {
    Run r(model);
    CHECK(r.advance(0.3) == 0);
    const std::int64_t settable = r.sys.contact_param[0];
    const Bytes state = r.save();
    const std::size_t first = place_of(r, settable) - std::size_t(8 * settable);
    auto stays = [&](std::int64_t param) {
      for (double x : {0.0, 1.0, 2.0, 5.0, -1.0, 1e9, 0.5, double(NAN)}) {
        if (x == r.sys.params[param]) continue;
        CHECK(cw_set_param(r.run, param, x) == 0);
        Bytes other = state;
        std::memcpy(&other[first + std::size_t(8 * param)], &x, 8);
        seal(other);
        CHECK(!restore(r, other));
      }
    };
    for (std::int64_t c = 0; c < r.sys.contacts; ++c) {
      const std::int64_t at = r.sys.contact_law_param[c];
      visit_law_curves(r.sys.contact_law[c], [&](int k) { stays(at + k), stays(at + k + 1); });
    }
    for (std::int64_t c = 0; c < r.sys.contacts; ++c) {
      auto choice = [&](int first) { return [&, first](int at, int) { stays(first + at); }; };
      visit_law_choices(r.sys.contact_law[c], choice(r.sys.contact_law_param[c]));
      visit_contact_choices(r.sys.contact_kind[c], choice(r.sys.contact_param[c]));
    }
  }
  Run r(driven());
  CHECK(cw_set_param(r.run, r.sys.contact_param[0], 0.5) == 1);
}

/// A signal stands where the time of the run says, and nowhere else.
void cursors() {
  constexpr double held = 0.123456789;
  for (double t : {0.1, 1.0}) {
    Run r(driven());
    cw_set_input(r.run, 1, held);
    CHECK(r.advance(t) == 0);
    const Bytes state = r.save();
    std::size_t at = 8 * state_head::words;
    while (std::memcmp(&state[at], &held, 8) != 0) at += 8;
    auto put = [&](std::ptrdiff_t word, std::int64_t x) {
      Bytes other = state;
      std::memcpy(&other[std::size_t(std::ptrdiff_t(at) + 8 * word)], &x, 8);
      seal(other);
      return restore(r, other);
    };
    // segment, whether it waits, value, whether it was set, segments that were set, whether they are fresh of: the
    // speed, that input, the wave
    std::int64_t segment;
    std::memcpy(&segment, &state[at + 32], 8);
    CHECK(put(4, segment) && put(5, t < 0.2));
    CHECK(!put(5, t >= 0.2) && !put(5, 2) && !put(5, -1));
    // it waits only before its start
    Bytes waiting = state;
    const std::int64_t words[] = {0, 1};
    std::memcpy(&waiting[at + 32], words, 16);
    seal(waiting);
    CHECK(restore(r, waiting) == (t < 0.2));
    for (std::int64_t k : {-1, 1, 2, 3}) CHECK(!put(4, segment + k));
    for (std::int64_t k : {1ll << 31, 1ll << 51, 1ll << 53, 1ll << 62, 1ll << 63}) CHECK(!put(4, k));
    CHECK(!put(-8, 1) && !put(-8, -1) && !put(-7, 1) && !put(-2, 1) && !put(-1, 1));
    // no segments follow that were set
    for (std::int64_t n : {1ll, -1ll, 1ll << 31, 1ll << 60}) CHECK(!put(2, n) && !put(8, n));
    CHECK(!put(9, 2) && !put(9, -1));
    // what comes from outside alone is never set over its segments
    CHECK(put(7, 0) && !put(7, 2) && !put(7, -1) && !put(1, 1) && !put(1, -1));
    // one that is held may stand where it was left, and nowhere ahead
    Bytes behind = state;
    const std::int64_t one = 1;
    std::memcpy(&behind[at + 56], &one, 8);
    seal(behind);
    CHECK(restore(r, behind));
    std::memset(&behind[at + 32], 0, 8);
    seal(behind);
    CHECK(restore(r, behind));
    const std::int64_t ahead = segment + 1;
    std::memcpy(&behind[at + 32], &ahead, 8);
    seal(behind);
    CHECK(!restore(r, behind));
  }
}

/// Numbers that leave the range of double end the run with not_finite; a row is finite or is not told.
void not_finite() {
  const int status = int(Status::not_finite);
  Run clutch(three_shafts());
  CHECK(clutch.advance(0.2) == 0);
  CHECK(cw_set_param(clutch.run, clutch.sys.contact_param[0], 1e308) == 1);
  double times[5] = {0.2, 0.4, 0.6, 0.8, 1};
  Numbers rows(std::size_t(5 * clutch.at.size));
  std::int64_t filled = 0;
  CHECK(cw_advance(clutch.run, 1, times, rows.data(), 5, 0, &filled) == status);
  for (std::int64_t i = 0; i < filled * clutch.at.size; ++i) CHECK(std::isfinite(rows[std::size_t(i)]));
  CHECK(cw_detail(clutch.run, nullptr) >= 0 || cw_detail_row(clutch.run) >= 0);
}

/// A state that leaves the range of double does so without rows too.
void state_not_finite() {
  for (double method : {1.0, 2.0}) {
    Model m;
    m.element<elements::Torque>(housing, m.shaft(1), {}, {m.constant(1e308)});
    Run r(m);
    CHECK(cw_set_option(r.run, "method", method) == 1);
    CHECK(cw_set_option(r.run, "angles", 0) == 1 && cw_set_option(r.run, "work", 0) == 1);
    CHECK(r.advance(10) == int(Status::not_finite));
    CHECK(cw_time(r.run) < 2);
  }
}

/// The poll ends a run after a step, and after a row of a long grid; the rest comes later.
void stops_when_asked() {
  Run r(chain()), whole(chain());
  int left = 25;
  auto poll = [](void* count) { return int(--*static_cast<int*>(count) < 0); };
  cw_set_poll(r.run, poll, &left);
  CHECK(r.advance(2) == int(Status::interrupted));
  CHECK(cw_time(r.run) > 0 && cw_time(r.run) < 2);
  constexpr int n = 2000;
  Numbers times(n), rows(std::size_t(n * r.at.size)), others(std::size_t(n * r.at.size));
  for (int i = 0; i < n; ++i) times[i] = 2 + 1e-6 * i;
  std::int64_t done = 0, filled = 0;
  int status, calls = 0;
  do {
    left = 300;
    status = cw_advance(r.run, 2.5, &times[done], &rows[std::size_t(done * r.at.size)], n - done, 0, &filled);
    done += filled;
    r.events();
  } while ((status == int(Status::interrupted) || status == int(Status::events_full)) && ++calls < 100);
  CHECK(status == 0 && done == n && calls > 5);
  whole.advance(0.5), whole.advance(2);
  CHECK(cw_advance(whole.run, 2.5, times.data(), others.data(), n, 0, &filled) == 0 && filled == n);
  for (std::size_t i = 0; i < rows.size(); ++i) CHECK_NEAR(rows[i], others[i], 2e-3 * (1 + std::fabs(others[i])));
}

}  // namespace

int test_damaged_states() {
  const char* asked = std::getenv("CLUTCHWORK_CASES");
  const int cases = asked != nullptr ? std::atoi(asked) : check::part(600);
  belongs();
  refused_calls();
  fixed_parameters();
  cursors();
  not_finite();
  state_not_finite();
  stops_when_asked();
  const Model models[] = {three_shafts(), chain(), bristles(), hysteresis(), warm(), driven(), parallel(), long_row()};
  std::uint64_t seed = 11;
  for (const Model& model : models) corrupt(model, seed++, (cases + 7) / 8);
  CHECK(refused > cases / 20 && accepted > cases / 20);
  std::printf("%d refused, %d went on\n", refused, accepted);
  return check::result();
}
