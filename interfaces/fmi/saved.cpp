#include <cmath>
#include <cstring>
#include "instance.hpp"

/// States of instances, in memory and as bytes.
namespace clutchwork::fmi {

State* Instance::state() {
  if (now_.is_loaded) {
    now_.run.resize(memory_.size());
    const std::int64_t n = cw_copy(run(), now_.run.data(), std::int64_t(now_.run.size()));
    now_.run.resize(std::size_t(n));
  }
  auto* made = new State(now_);
  now_.run.clear();
  return made;
}

Answer Instance::go_to(const State& state) {
  if (state.value.size() != now_.value.size()) return refuse("the state is that of another model");
  const bool is_other = state.is_loaded && (!now_.is_loaded || state.loaded != now_.loaded);
  const State before = now_;
  now_ = state;
  now_.run.clear();
  is_seen_ = false;
  if (is_other && !put(state.loaded)) return now_ = before, Answer::error;
  if (state.is_loaded) cw_expect_inputs(run(), 1);
  if (!state.is_loaded || cw_paste(run(), state.run.data(), std::int64_t(state.run.size())) != 0) return Answer::ok;
  now_ = before;
  now_.is_loaded = false;
  now_.stage = Stage::failed;
  return refuse("the state is that of another model: reset the instance");
}

namespace {

constexpr std::uint64_t state_magic = 0x3345544154534d46u;  // FMSTATE3
constexpr std::int64_t state_words = 10;

std::uint64_t checksum(const unsigned char* bytes, std::int64_t n) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (std::int64_t i = 0; i < n; ++i) h = (h ^ bytes[i]) * 0x100000001b3u;
  return h;
}

void append(std::vector<unsigned char>& to, const void* from, std::size_t n) {
  const auto* bytes = static_cast<const unsigned char*>(from);
  to.insert(to.end(), bytes, bytes + n);
}

}  // namespace

/// magic, checksum of all after it, fingerprint of the token, stage, whether a run follows, t_start, rtol, number of
/// values, time of the importer, whether something was set in event mode; values, loaded values, lines, derivatives,
/// the state of the importer, then the saved state of the core.
std::vector<unsigned char> Instance::serialized(const State& state) {
  std::vector<unsigned char> saved;
  if (state.is_loaded) {
    // a run of its own, so that this one stays
    const State here = *std::unique_ptr<State>(this->state());
    if (go_to(state) == Answer::ok) {
      saved.resize(std::size_t(cw_state_size(run())));
      cw_save(run(), saved.data(), std::int64_t(saved.size()));
    }
    if (go_to(here) != Answer::ok || saved.empty()) return {};
  }
  const auto& token = model_.token;
  const std::uint64_t words[state_words] = {
      state_magic,
      0,
      checksum(reinterpret_cast<const unsigned char*>(token.data()), std::int64_t(token.size())),
      std::uint64_t(state.stage),
      std::uint64_t(state.is_loaded),
      0,
      0,
      std::uint64_t(state.value.size()),
      0,
      std::uint64_t(state.is_anew)};
  std::vector<unsigned char> made;
  append(made, words, sizeof words);
  std::memcpy(made.data() + 40, &state.t_start, 8), std::memcpy(made.data() + 48, &state.rtol, 8);
  std::memcpy(made.data() + 64, &state.time, 8);
  for (const auto* part : {&state.value, &state.loaded, &state.on_line, &state.slopes, &state.past, &state.x})
    append(made, part->data(), 8 * part->size());
  append(made, saved.data(), saved.size());
  const std::uint64_t sum = checksum(made.data() + 16, std::int64_t(made.size()) - 16);
  std::memcpy(made.data() + 8, &sum, 8);
  return made;
}

/// Whether every number of a state, but for those of its run, is one that an instance may have.
bool Instance::is_possible(const State& state) const {
  bool fits = std::isfinite(state.t_start) && std::isfinite(state.time) && state.rtol >= 0 && state.rtol < 1;
  fits = fits && (state.is_loaded || int(state.stage) < int(Stage::step));
  for (const auto* slopes : {&state.slopes, &state.past})
    for (double slope : *slopes) fits = fits && std::isfinite(slope);
  for (double x : state.x) fits = fits && std::isfinite(x);
  for (std::size_t k = 0; k < model_.variables.size(); ++k) {
    const Variable& one = model_.variables[k];
    fits = fits && (state.on_line[k] == 0 || (state.on_line[k] == 1 && one.kind == Kind::input));
    for (double x : {state.loaded[k], state.value[k]})
      fits = fits && (!one.is_given() || one.kind == Kind::slope || (x >= one.least && x <= one.most));
  }
  return fits;
}

State* Instance::deserialized(const unsigned char* bytes, std::int64_t n) {
  const char* damaged = "the serialised state is damaged, or that of another model";
  std::uint64_t words[state_words];
  if (bytes == nullptr || n < std::int64_t(sizeof words)) return refuse(damaged), nullptr;
  std::memcpy(words, bytes, sizeof words);
  const auto& token = model_.token;
  const bool is_own =
      words[0] == state_magic && words[1] == checksum(bytes + 16, n - 16) &&
      words[2] == checksum(reinterpret_cast<const unsigned char*>(token.data()), std::int64_t(token.size())) &&
      words[3] <= std::uint64_t(Stage::failed) && words[4] <= 1 && words[7] == now_.value.size();
  const auto count = std::int64_t(now_.value.size()),
             at = std::int64_t(sizeof words) + 8 * (count * (3 + 2 * orders) + std::int64_t(now_.x.size()));
  if (!is_own || n < at) return refuse(damaged), nullptr;
  auto made = std::make_unique<State>();
  made->stage = Stage(words[3]), made->is_loaded = words[4] == 1, made->is_anew = words[9] != 0;
  std::memcpy(&made->t_start, bytes + 40, 8), std::memcpy(&made->rtol, bytes + 48, 8);
  std::memcpy(&made->time, bytes + 64, 8);
  const unsigned char* from = bytes + sizeof words;
  for (auto* part : {&made->value, &made->loaded, &made->on_line, &made->slopes, &made->past, &made->x}) {
    const bool is_slope = part == &made->slopes || part == &made->past;
    part->resize(part == &made->x ? now_.x.size() : std::size_t(is_slope ? orders * count : count));
    std::memcpy(part->data(), from, 8 * part->size());
    from += 8 * part->size();
  }
  if (!is_possible(*made)) return refuse(damaged), nullptr;
  if (!made->is_loaded) return made.release();
  // read by a run of its own, of which it becomes a copy
  const State here = *std::unique_ptr<State>(state());
  const bool is_read = put(made->loaded) && cw_restore(run(), bytes + at, n - at) != 0;
  if (is_read) {
    made->run.resize(memory_.size());
    made->run.resize(std::size_t(cw_copy(run(), made->run.data(), std::int64_t(made->run.size()))));
  }
  now_.is_loaded = false;
  go_to(here);
  return is_read ? made.release() : (refuse(damaged), nullptr);
}

}  // namespace clutchwork::fmi
