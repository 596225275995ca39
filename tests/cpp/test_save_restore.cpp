// Saved states continue with the same bits, in the same memory and in another.

#include "check.hpp"
#include "models.hpp"

using namespace fixture;

namespace {

/// Everything a run tells from now to the end: rows on a grid, events, counters.
Numbers story(Run& r, double end) {
  constexpr int n = 50;
  Numbers times(n), told(std::size_t(n * r.at.size));
  for (int i = 0; i < n; ++i) times[i] = cw_time(r.run) + (end - cw_time(r.run)) * (i + 1) / n;
  std::int64_t filled = 0, counts[7];
  CHECK(cw_advance(r.run, end, times.data(), told.data(), n, 0, &filled) == 0);
  CHECK(filled == n);
  for (double x : r.row()) told.push_back(x);
  for (double x : r.events()) told.push_back(x);
  cw_statistics(r.run, counts);
  for (std::int64_t x : counts) told.push_back(double(x));
  return told;
}

void same(const Numbers& a, const Numbers& b) {
  if (!CHECK(a.size() == b.size())) return;
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

/// The same by a copy of the memory, which no pointer of the first run outlives.
void pastes(const Model& model, double middle, double end) {
  Run first(model), used(model), alone(model);
  CHECK(first.advance(middle) == 0);
  first.events();
  Bytes copy(first.memory.size());
  const std::int64_t n = cw_copy(first.run, copy.data(), std::int64_t(copy.size()));
  CHECK(n > 0 && cw_copy(first.run, copy.data(), n - 1) == -1);
  const Numbers told = story(first, end);
  CHECK(cw_paste(first.run, copy.data(), n - 1) == 0);
  CHECK(cw_paste(first.run, copy.data(), n) == 1);
  CHECK(cw_time(first.run) == middle);
  same(told, story(first, end));
  CHECK(used.advance(0.5 * (middle + end)) == 0);
  used.events();
  for (Run* other : {&used, &alone}) {
    CHECK(cw_paste(other->run, copy.data(), n) == 1);
    drop_fences(first.memory.data(), std::int64_t(first.memory.size()));
    std::memset(first.memory.data(), 0xff, first.memory.size());
    std::memset(first.system.data(), 0xff, first.system.size());
    same(told, story(*other, end));
  }
}

/// A run that stops at each event takes them all, at the instants at which the whole run has them.
void stops_at_events(const Model& model, double end) {
  Run whole(model), stepped(model);
  CHECK(whole.advance(end) == 0);
  const Numbers told = whole.events();
  Numbers found;
  int stops = 0;
  for (double before = -1; cw_time(stepped.run) < end && stops < 1000; ++stops) {
    CHECK(cw_advance_to_event(stepped.run, end) == 0);
    CHECK(cw_time(stepped.run) >= before);
    before = cw_time(stepped.run);
    for (double x : stepped.events()) found.push_back(x);
  }
  same(told, found);
}

/// Saved at `middle`, continued there and in other memory, after other things have happened there.
void continues(const Model& model, double middle, double end, double method = 1) {
  Run first(model);
  cw_set_option(first.run, "method", method);
  CHECK(first.advance(middle) == 0);
  first.events();
  const Bytes saved = first.save();
  const Numbers told = story(first, end);
  CHECK(cw_restore(first.run, saved.data(), std::int64_t(saved.size())) == 1);
  CHECK(cw_time(first.run) == middle);
  same(told, story(first, end));
  Run fresh(model), used(model);
  CHECK(used.advance(0.5 * (middle + end)) == 0);
  used.events();
  for (Run* other : {&fresh, &used}) {
    CHECK(cw_restore(other->run, saved.data(), std::int64_t(saved.size())) == 1);
    // the first one is gone: nothing may point there
    drop_fences(first.memory.data(), std::int64_t(first.memory.size()));
    std::memset(first.memory.data(), 0xff, first.memory.size());
    std::memset(first.system.data(), 0xff, first.system.size());
    same(told, story(*other, end));
  }
}

/// Saved when the buffer of events is full: modes are decided, their phase has not begun.
void full_buffer(bool changed) {
  Model m;
  const int a = m.shaft(1, 2), b = m.shaft(1);
  const int pressure = m.signal({}, 0), push = m.signal({}, 0);
  m.element<elements::Torque>(housing, a, {}, {push});
  m.element<elements::SpringDamper>(housing, b, {300, 0.1, 0});
  m.contact<elements::Clutch, laws::Coulomb>(a, b, {1}, {pressure}, {1, 1});
  m.contact<elements::Clutch, laws::Stribeck>(a, b, {1}, {pressure}, {0.4, 0.3, 3, 0, 2, 0});
  Run r(m), other(m);
  int status = 0;
  for (int i = 0; i < 2000 && status == 0; ++i) {
    cw_set_input(r.run, pressure, i % 2 == 0 ? 5.0 : 0.0);
    status = r.advance(0.001 * i);
  }
  if (!CHECK(status == int(Status::events_full))) return;
  if (changed) cw_set_input(r.run, pressure, 2.5), cw_set_input(r.run, push, 3);
  const Bytes saved = r.save();
  CHECK(cw_restore(other.run, saved.data(), std::int64_t(saved.size())) == 1);
  CHECK(other.save() == saved);
  same(r.events(), other.events());
  cw_set_input(r.run, push, -4), cw_set_input(other.run, push, -4);
  same(story(r, 2.5), story(other, 2.5));
}

/// Options, inputs and parameters belong to the state.
void settings_come_back() {
  Run r(driven()), other(driven());
  CHECK(cw_set_option(r.run, "rtol", 1e-9) == 1 && cw_set_input(r.run, 1, 7) == 1);
  CHECK(cw_set_param(r.run, r.sys.contact_param[0], 0.7) == 1);
  const Bytes fresh = r.save();
  CHECK(cw_restore(other.run, fresh.data(), std::int64_t(fresh.size())) == 1);
  CHECK(other.save() == fresh);
  same(story(r, 1.5), story(other, 1.5));
}

/// What a state holds is what it holds again, to the byte.
void stays_the_same(const Model& model) {
  Run r(model), other(model);
  for (double t : {0.0, 0.2, 0.55, 0.9, 1.3, 1.75}) {
    CHECK(r.advance(t) == 0);
    const Bytes saved = r.save();
    CHECK(cw_restore(other.run, saved.data(), std::int64_t(saved.size())) == 1);
    CHECK(other.save() == saved);
    r.events();
  }
}

/// A clutch beside a prescribed speed whose wind-up is full soon: it stays full.
Model full_of_wind(double speed) {
  Model m;
  const int in = m.prescribed(0.3, m.signal({{0, {speed}}, {0.8, {2 * speed}}})), out = m.shaft(0.5);
  m.contact<elements::Clutch, laws::Mykhalevych>(in, out, {1}, {m.constant(0.5)},
                                                 {0.2, 0.15, 0.05, 3, 0.5, double(choice::Reset::saturate), 0.7, 0});
  return m;
}

/// The same without load: it forgets as a phase begins, and winds up in it.
Model full_without_load() {
  Model m;
  const int in = m.shaft(0.3, 3), out = m.shaft(0.5);
  m.contact<elements::Clutch, laws::Mykhalevych>(in, out, {1}, {m.constant(0)},
                                                 {0.2, 0.15, 0.05, 3, 0.5, double(choice::Reset::saturate), 0.7, 0});
  m.element<elements::Torque>(housing, in, {}, {m.signal({{0, {0, 0, 0, 0, 4, 9, 0, 0}}})});
  return m;
}

}  // namespace

int test_save_restore() {
  const Model models[] = {three_shafts(), chain(), bristles(), hysteresis(), warm(), driven(), parallel(), long_row()};
  check::Random g{5};
  for (const Model& model : models) {
    stays_the_same(model);
    for (int i = 0; i < check::part(8); ++i) continues(model, g.between(0, 2), 2.2);
  }
  // the explicit method, and the choice between both
  for (double method : {0.0, 2.0}) {
    for (double middle : {0.0, 0.21, 0.9, 1.4}) {
      continues(three_shafts(), middle, 1.8, method);
      continues(parallel(), middle, 1.8, method);
      continues(chain(), middle, 1.6, method);
    }
  }
  for (bool changed : {false, true}) full_buffer(changed);
  settings_come_back();
  for (double middle : {0.0, 0.7, 1.83}) {
    pastes(three_shafts(), middle, 2.5), pastes(chain(), middle, 2.0), pastes(bristles(), middle, 3.0);
    pastes(hysteresis(), middle, 2.5), pastes(warm(), middle, 3.0), pastes(full_without_load(), middle, 2.0);
  }
  for (const Model& model : {three_shafts(), chain(), parallel(), hysteresis(), warm()}) stops_at_events(model, 1.9);
  for (double middle : {0.0, 0.3, 0.7, 0.95, 1.4, 1.83, 2.2}) continues(three_shafts(), middle, 2.5);
  for (double middle : {0.0, 0.1, 0.35, 0.5, 0.77, 1.3}) continues(chain(), middle, 2.0);
  for (double middle : {0.0, 0.4, 0.8, 1.21, 1.6, 1.9, 2.5}) continues(bristles(), middle, 3.0);
  for (double middle : {0.0, 0.2, 0.7, 1.05, 1.3, 1.61, 2.1}) continues(hysteresis(), middle, 2.5);
  for (double middle : {0.0, 0.3, 0.67, 1.3, 2.3, 2.4, 2.7}) continues(warm(), middle, 3.0);
  for (double speed : {-3.0, 3.0}) {
    for (double middle : {0.001, 0.3, 0.8, 1.3}) continues(full_of_wind(speed), middle, 2.0);
  }
  for (double middle : {0.001, 0.3, 1.3}) continues(full_without_load(), middle, 2.0);
  return check::result();
}
