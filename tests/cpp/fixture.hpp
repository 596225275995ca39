#pragma once
#include <clutchwork/c_api.h>
#include <clutchwork/components/input.hpp>

#include <array>
#include <clutchwork/registry.gen.hpp>
#include <initializer_list>
#include <vector>

/// Builds the bytes of a System from shafts, elements, contacts and signals; speeds are those of the free shafts.
namespace fixture {

using namespace clutchwork;
using Bytes = std::vector<unsigned char>;
using Numbers = std::vector<double>;
using Indices = std::vector<std::int32_t>;
inline constexpr int housing = -1;

/// Number of a kind in the registry.
template <class E>
int torque_kind() {
  int kind = 0;
  while (!visit_torque(kind, [](auto tag) { return std::is_same_v<typename decltype(tag)::type, E>; })) ++kind;
  return kind;
}
template <class E>
int contact_kind() {
  int kind = 0;
  while (!visit_contact(kind, [](auto tag) { return std::is_same_v<typename decltype(tag)::type, E>; })) ++kind;
  return kind;
}
template <class E>
int flow_kind() {
  int kind = 0;
  while (!visit_flow(kind, [](auto tag) { return std::is_same_v<typename decltype(tag)::type, E>; })) ++kind;
  return kind;
}
template <class E>
int process_kind() {
  int kind = 0;
  while (!visit_process(kind, [](auto tag) { return std::is_same_v<typename decltype(tag)::type, E>; })) ++kind;
  return kind;
}
template <class L>
int law_kind() {
  int kind = 0;
  while (!visit_law(kind, [](auto tag) { return std::is_same_v<typename decltype(tag)::type, L>; })) ++kind;
  return kind;
}

/// Number of states that a law uses with these parameters.
template <class L>
int law_states(const Numbers& law) {
  if constexpr (Sized<L>) return L::count(*reinterpret_cast<const typename L::template Params<double>*>(law.data()));
  return int(L::states);
}

/// Several lists of numbers as one: parameters with curves among them.
inline Numbers joined(std::initializer_list<Numbers> parts) {
  Numbers all;
  for (const Numbers& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// From `time` on: c0 + c1 s + c2 s^2 + c3 s^3, and amplitude exp(-decay s) sin(omega s + phase) of two waves.
struct Segment {
  double time, coef[segment_size];
};

/// A reference to what is no signal: a shared state, the rate or the heat of an element or a contact.
enum Source : std::int32_t { of_signal, of_shared, of_rate, of_contact_rate, of_heat, of_contact_heat };
constexpr std::int32_t source(Source what, int number) { return std::int32_t(what) * 1000 + number; }

/// A matrix by rows without its zeros.
struct Sparse {
  Indices end, column;
  Numbers value;

  Sparse(const Numbers& dense, int rows, int columns) {
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const double x = dense[std::size_t(i * columns + j)];
        if (x != 0) column.push_back(j), value.push_back(x);
      }
      end.push_back(std::int32_t(column.size()));
    }
  }
};

class Model {
 public:
  int shaft(double inertia, double speed = 0) {
    inertia_.push_back(inertia), speed_.push_back(speed), source_.push_back(-1);
    return int(inertia_.size()) - 1;
  }
  int prescribed(double inertia, int signal) {
    const int n = shaft(inertia);
    source_[n] = signal;
    return n;
  }
  /// A signal of segments; none: set from outside, starting at `value`.
  int signal(const std::vector<Segment>& segments, double value = 0, double period = 0) {
    input_first_.push_back(std::int32_t(segment_time_.size()));
    input_count_.push_back(std::int32_t(segments.size()));
    input_period_.push_back(period), input_value_.push_back(value);
    for (const Segment& s : segments) {
      segment_time_.push_back(s.time);
      segment_coef_.insert(segment_coef_.end(), s.coef, s.coef + segment_size);
    }
    return int(input_first_.size()) - 1;
  }
  int constant(double x) { return signal({{0, {x}}}); }
  /// Points (x, y) of a curve; returns what stands for it among the parameters.
  Numbers curve(const Numbers& x, const Numbers& y) {
    const double first = double(points_.size() / 3), n = double(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t a = i + 1 < x.size() || i == 0 ? i : i - 1, b = a + 1 < x.size() ? a + 1 : a;
      points_.insert(points_.end(), {x[i], y[i], b > a ? (y[b] - y[a]) / (x[b] - x[a]) : 0.0});
    }
    return {first, n};
  }
  template <class E>
  int element(int base, int follower, const Numbers& params, const Indices& signals = {}, const Numbers& state = {}) {
    elements_.push_back({base, follower});
    element_kind_.push_back(torque_kind<E>());
    element_param_.push_back(put(params_, params)), element_input_.push_back(put(refs_, signals));
    Numbers own = state;
    own.resize(E::states);
    element_state_.push_back(put(state_, own)), element_way_.push_back(0);
    return int(elements_.size()) - 1;
  }
  /// An element of several ways, each from a base to a follower; returns the first.
  template <class E>
  int coupled(const std::vector<std::array<int, 2>>& ways, const Numbers& params, const Indices& signals = {},
              const Numbers& state = {}) {
    const int first = element<E>(ways[0][0], ways[0][1], params, signals, state);
    for (int way = 1; way < int(ways.size()); ++way) {
      elements_.push_back({ways[way][0], ways[way][1]});
      for (Indices* numbers : {&element_kind_, &element_param_, &element_input_, &element_state_})
        numbers->push_back(numbers->back());
      element_way_.push_back(way);
    }
    full = true;
    return first;
  }
  bool full = false;  ///< it runs in the full form
  /// `state`: where those of the law start, zero if left out; `tolerance`: slip below which it may lock.
  template <class E, class L>
  int contact(int base, int follower, const Numbers& params, const Indices& signals, const Numbers& law,
              bool locked = false, const Numbers& state = {}, double tolerance = 0, const Indices& law_signals = {}) {
    contacts_.push_back({base, follower});
    contact_kind_.push_back(contact_kind<E>()), contact_law_.push_back(law_kind<L>());
    contact_param_.push_back(put(params_, params)), contact_law_param_.push_back(put(params_, law));
    Numbers own = state;
    own.resize(std::size_t(law_states<L>(law)));
    contact_input_.push_back(put(refs_, signals)), contact_law_input_.push_back(put(refs_, law_signals));
    contact_state_.push_back(put(state_, own));
    contact_tolerance_.push_back(tolerance), contact_initial_.push_back(locked), contact_place_.push_back(-1);
    return int(contacts_.size()) - 1;
  }
  /// A state that any component may read as offset + scale * state.
  int shared(double state, double scale = 1, double offset = 0) {
    shared_.push_back(state), shared_scale_.push_back(scale), shared_offset_.push_back(offset);
    return int(shared_.size()) - 1;
  }
  /// A flow from one shared state to another, -1: none.
  template <class E>
  int flow(int from, int to, const Numbers& params, const Indices& inputs) {
    flow_from_.push_back(from), flow_to_.push_back(to), flow_kind_.push_back(flow_kind<E>());
    flow_param_.push_back(put(params_, params)), flow_input_.push_back(put(refs_, inputs));
    return int(flow_kind_.size()) - 1;
  }
  /// A component of shared states alone; returns the first.
  template <class E>
  int process(const Numbers& params, const Indices& inputs, const Numbers& state, double scale = 1, double offset = 0) {
    process_kind_.push_back(fixture::process_kind<E>()), process_state_.push_back(std::int32_t(shared_.size()));
    process_param_.push_back(put(params_, params)), process_input_.push_back(put(refs_, inputs));
    for (double x : state) shared(x, scale, offset);
    return process_state_.back();
  }
  /// The heat of an element, or of a contact, goes to a shared state.
  void heat(Source what, int number, int to, double share = 1) {
    heats_.push_back({what, number}), heat_to_.push_back(to), heat_share_.push_back(share);
  }

  Bytes bytes() const {
    const int n = int(inertia_.size());
    Indices free_of(n, -1), given_of(n, -1), given;
    int nv = 0, np = 0;
    for (int i = 0; i < n; ++i) {
      if (source_[i] < 0)
        free_of[i] = nv++;
      else
        given_of[i] = np++, given.push_back(source_[i]);
    }
    auto rates = [&](const std::vector<Pair>& pairs, const Indices& number, int count) {
      Numbers rows(pairs.size() * count);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (pairs[k].follower >= 0 && number[pairs[k].follower] >= 0) rows[k * count + number[pairs[k].follower]] += 1;
        if (pairs[k].base >= 0 && number[pairs[k].base] >= 0) rows[k * count + number[pairs[k].base]] -= 1;
      }
      return rows;
    };
    std::vector<Pair> all(n);
    for (int i = 0; i < n; ++i) all[i] = {housing, i};
    Numbers mass(nv * nv), start, none(nv * np), angles(n);
    for (int i = 0; i < n; ++i) {
      if (free_of[i] < 0) continue;
      mass[free_of[i] * nv + free_of[i]] = inertia_[i];
      start.push_back(speed_[i]);
    }
    const int ne = int(elements_.size()), nd = ne + int(contacts_.size()), nx = int(shared_.size());
    auto resolve = [&](Indices refs) {
      // what stands before signals, shared states, rates and heats
      const int at[] = {0, int(input_first_.size()), nx, ne, nd - ne, ne};
      for (std::int32_t& ref : refs) {
        int base = 0;
        for (int k = 0; k <= ref / 1000; ++k) base += at[k];
        ref = base + ref % 1000;
      }
      return refs;
    };
    Indices heat_direction;
    for (const Pair& h : heats_) heat_direction.push_back(h.base == of_contact_heat ? ne + h.follower : h.follower);
    Indices process_state = process_state_;
    for (std::int32_t& k : process_state) k += std::int32_t(state_.size());
    Numbers states = state_;
    states.insert(states.end(), shared_.begin(), shared_.end());
    Bytes out;
    auto add = [&](const auto& items) {
      const auto* from = reinterpret_cast<const unsigned char*>(items.data());
      if (!items.empty()) out.insert(out.end(), from, from + items.size() * sizeof(items[0]));
      out.resize((out.size() + 7) / 8 * 8);
    };
    const std::vector<char> magic{'C', 'L', 'U', 'T', 'C', 'H', 'W', 'K'};
    add(magic);
    auto count = [](const auto& items) { return std::int64_t(items.size()); };
    const Sparse basis(rates(all, free_of, nv), n, nv), inertias(mass, nv, nv),
        element_rate(rates(elements_, free_of, nv), ne, nv), contact_rate(rates(contacts_, free_of, nv), nd - ne, nv);
    auto put = [&](const Sparse& m) { add(m.end), add(m.column), add(m.value); };
    // room for whole matrices, whatever the number of speeds
    const std::int64_t half = nv * (nv + 1) / 2, nc = nd - ne;
    add(std::vector<std::int64_t>{schema_hash,
                                  n,
                                  nv,
                                  np,
                                  count(elements_),
                                  count(contacts_),
                                  0,
                                  count(states),
                                  nx,
                                  count(flow_kind_),
                                  count(process_kind_),
                                  count(heats_),
                                  0,
                                  0,
                                  0,
                                  0,
                                  count(input_first_),
                                  count(segment_time_),
                                  count(params_),
                                  count(points_) / 3,
                                  count(refs_),
                                  count(basis.column),
                                  count(inertias.column),
                                  count(element_rate.column),
                                  count(contact_rate.column),
                                  half,
                                  nd * nv,
                                  nc * (nc + 1) / 2,
                                  nv * (nv + 1),
                                  nd * nv,
                                  half,
                                  half,
                                  nc,
                                  nc,
                                  0});
    put(basis), add(rates(all, given_of, np)), add(inertia_), put(inertias), add(none);
    add(Indices(nv));
    put(element_rate), add(rates(elements_, given_of, np));
    add(Indices{full}), add(element_way_), add(element_kind_), add(element_param_), add(element_state_),
        add(element_input_);
    put(contact_rate), add(rates(contacts_, given_of, np));
    add(contact_kind_), add(contact_param_), add(contact_input_), add(contact_law_), add(contact_law_param_);
    add(contact_law_input_), add(contact_state_), add(contact_tolerance_), add(contact_initial_), add(contact_place_);
    add(flow_kind_), add(flow_param_), add(flow_input_), add(flow_from_), add(flow_to_);
    add(process_kind_), add(process_param_), add(process_input_), add(process_state),
        add(Indices(process_kind_.size(), -1));
    add(heat_direction), add(heat_to_), add(heat_share_), add(shared_scale_), add(shared_offset_);
    add(given), add(Indices(np)), add(resolve(refs_)), add(input_first_), add(input_count_), add(input_period_),
        add(input_value_);
    add(segment_time_), add(segment_coef_), add(params_), add(points_), add(start);
    // no start is later than at 0
    add(Numbers(std::size_t(nv * np))), add(angles), add(states);
    return out;
  }

 private:
  struct Pair {
    int base, follower;
  };
  template <class V>
  static std::int32_t put(V& pool, const V& more) {
    pool.insert(pool.end(), more.begin(), more.end());
    return std::int32_t(pool.size() - more.size());
  }
  Numbers inertia_, speed_, params_, points_, state_, input_period_, input_value_, segment_time_, segment_coef_;
  Numbers contact_tolerance_, shared_, shared_scale_, shared_offset_, heat_share_;
  Indices source_, refs_, input_first_, input_count_, element_kind_, element_param_, element_state_, element_input_;
  Indices element_way_, contact_kind_, contact_law_, contact_param_, contact_law_param_, contact_input_, contact_state_;
  Indices contact_law_input_, contact_initial_, contact_place_, flow_kind_, flow_param_, flow_input_, flow_from_,
      flow_to_, heat_to_;
  Indices process_kind_, process_param_, process_input_, process_state_;
  std::vector<Pair> elements_, contacts_, heats_;
};

/// A run in memory of exactly the size it asked for.
struct Run {
  Bytes system, memory;
  cw_run* run;
  System sys{};
  RowLayout at{sys};

  explicit Run(Bytes bytes) : system(std::move(bytes)) {
    const std::int64_t size = cw_size(system.data(), std::int64_t(system.size()));
    memory.resize(std::size_t(size > 0 ? size : 0));
    run = cw_load(system.data(), std::int64_t(system.size()), memory.data(), size);
    bind(sys, system.data(), std::int64_t(system.size()));
    at = RowLayout(sys);
  }
  explicit Run(const Model& model) : Run(model.bytes()) {}
  int advance(double t) { return cw_advance(run, t, nullptr, nullptr, 0, 0, nullptr); }
  Numbers row() {
    Numbers row(std::size_t(at.size));
    cw_row(run, row.data());
    return row;
  }
  Bytes save() const {
    Bytes state(std::size_t(cw_state_size(run)));
    state.resize(std::size_t(cw_save(run, state.data(), std::int64_t(state.size()))));
    return state;
  }
  /// Waiting events, event_size numbers each.
  Numbers events() {
    Numbers events(std::size_t(1000 * event_size));
    events.resize(std::size_t(cw_take_events(run, events.data(), 1000) * event_size));
    return events;
  }
};

}  // namespace fixture
