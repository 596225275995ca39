#include <clutchwork/c_api.h>

#include <new>
#include "instances.hpp"

using namespace clutchwork;

/// A run and where it lives; its arrays follow it in the same memory.
struct cw_run {
  Workspace<double> ws;
  const unsigned char* system;
  unsigned char* arrays;
  std::int64_t bytes;
};

namespace {

constexpr std::int64_t head = (std::int64_t(sizeof(cw_run)) + 63) / 64 * 64;

/// Numbers in the pool that a kind reads as its parameters.
template <class E>
constexpr std::int64_t param_count = std::int64_t(sizeof(typename E::template Params<double>) / sizeof(double));

/// Whether the curve that stands at params[at] lies among the points.
bool curve_fits(const System& s, std::int64_t at) {
  const double first = s.params[at], count = s.params[at + 1];
  return first >= 0 && count >= 1 && first + count <= double(s.n_points);
}

/// Whether the segments of a signal stand in order and repeat no faster than a run could follow.
bool signal_fits(const System& s, std::int64_t i) {
  const std::int64_t first = s.input_first[i], count = s.input_count[i];
  if (count < 0 || first < 0 || first + count > s.segments) return false;
  for (std::int64_t k = first; k + 1 < first + count; ++k) {
    if (!(s.segment_time[k] <= s.segment_time[k + 1])) return false;
  }
  const double period = s.input_period[i];
  if (count == 0 || period <= 0) return true;
  const double start = s.segment_time[first], end = s.segment_time[first + count - 1];
  return end - start <= period && start > -1e8 * period && abs(end) < 1e12 * period;
}

/// Whether a parameter tells where a curve stands: it must stay as it was loaded.
bool is_curve_range(const System& s, std::int64_t offset) {
  bool found = false;
  auto covers = [&](std::int64_t first) {
    return [&, first](int at) { found = found || (offset >= first + at && offset < first + at + 2); };
  };
  auto look = [&](std::int64_t n, auto&& visit) {
    for (std::int64_t i = 0; i < n && !found; ++i) visit(i);
  };
  look(s.elements, [&](std::int64_t i) { visit_torque_curves(s.element_kind[i], covers(s.element_param[i])); });
  look(s.contacts, [&](std::int64_t i) { visit_contact_curves(s.contact_kind[i], covers(s.contact_param[i])); });
  look(s.contacts, [&](std::int64_t i) { visit_law_curves(s.contact_law[i], covers(s.contact_law_param[i])); });
  look(s.flows, [&](std::int64_t i) { visit_flow_curves(s.flow_kind[i], covers(s.flow_param[i])); });
  look(s.processes, [&](std::int64_t i) { visit_process_curves(s.process_kind[i], covers(s.process_param[i])); });
  return found;
}

/// Whether the tables of the law of a contact fit each other.
bool tables_fit(const System& s, std::int64_t contact) {
  return visit_law(s.contact_law[contact], [&](auto tag) {
    using L = typename decltype(tag)::type;
    const auto& p =
        *reinterpret_cast<const typename L::template Params<double>*>(s.params + s.contact_law_param[contact]);
    if constexpr (requires { L::fits(p); }) return L::fits(p);
    return true;
  });
}

/// Whether n references from `first` on are to signals and shared states: torques know no rates of others.
bool plain_inputs(const System& s, std::int64_t first, int n) {
  for (int i = 0; i < n && first + n <= s.n_input_refs; ++i) {
    if (s.input_refs[first + i] >= s.inputs + s.shared) return false;
  }
  return true;
}

/// As in_range, for what concerns the shared states.
bool shared_in_range(const System& s) {
  if (s.shared > s.states) return false;
  const std::int64_t first = s.states - s.shared;
  bool good = true;
  for (std::int64_t i = 0; good && i < s.flows; ++i) {
    good = s.flow_kind[i] >= 0 && s.flow_kind[i] < flow_kinds && s.flow_from[i] >= -1 && s.flow_from[i] < s.shared &&
           s.flow_to[i] >= -1 && s.flow_to[i] < s.shared && s.flow_param[i] >= 0 && s.flow_input[i] >= 0;
    if (!good) return false;
    visit_flow(s.flow_kind[i], [&](auto tag) {
      using E = typename decltype(tag)::type;
      good = s.flow_param[i] + param_count<E> <= s.n_params && s.flow_input[i] + E::inputs <= s.n_input_refs;
    });
    visit_flow_curves(s.flow_kind[i], [&](int at) { good = good && curve_fits(s, s.flow_param[i] + at); });
  }
  for (std::int64_t i = 0; good && i < s.processes; ++i) {
    good = s.process_kind[i] >= 0 && s.process_kind[i] < process_kinds && s.process_state[i] >= first &&
           s.process_param[i] >= 0 && s.process_input[i] >= 0;
    if (!good) return false;
    visit_process(s.process_kind[i], [&](auto tag) {
      using E = typename decltype(tag)::type;
      good = s.process_param[i] + param_count<E> <= s.n_params && s.process_input[i] + E::inputs <= s.n_input_refs &&
             s.process_state[i] + E::states <= s.states;
    });
    visit_process_curves(s.process_kind[i], [&](int at) { good = good && curve_fits(s, s.process_param[i] + at); });
  }
  for (std::int64_t h = 0; good && h < s.heats; ++h) {
    good = s.heat_direction[h] >= 0 && s.heat_direction[h] < s.elements + s.contacts && s.heat_to[h] >= 0 &&
           s.heat_to[h] < s.shared;
  }
  return good;
}

/// Offsets and numbers inside the system that the core follows without looking.
bool in_range(const System& s) {
  auto within = [](const std::int32_t* x, std::int64_t n, std::int64_t low, std::int64_t high) {
    for (std::int64_t i = 0; i < n; ++i) {
      if (x[i] < low || x[i] > high) return false;
    }
    return true;
  };
  bool good =
      within(s.element_kind, s.elements, 0, torque_kinds - 1) &&
      within(s.contact_kind, s.contacts, 0, contact_kinds - 1) && within(s.contact_law, s.contacts, 0, law_kinds - 1) &&
      within(s.element_param, s.elements, 0, s.n_params) && within(s.contact_param, s.contacts, 0, s.n_params) &&
      within(s.contact_law_param, s.contacts, 0, s.n_params) && within(s.element_state, s.elements, 0, s.states) &&
      within(s.contact_state, s.contacts, 0, s.states) && within(s.prescribed_input, s.prescribed, 0, s.inputs - 1) &&
      within(s.element_input, s.elements, 0, s.n_input_refs) &&
      within(s.contact_input, s.contacts, 0, s.n_input_refs) &&
      within(s.contact_law_input, s.contacts, 0, s.n_input_refs) &&
      within(s.input_refs, s.n_input_refs, 0, s.inputs + s.shared + 2 * (s.elements + s.contacts) - 1) &&
      shared_in_range(s);
  for (std::int64_t i = 0; good && i < s.inputs; ++i) good = signal_fits(s, i);
  std::int64_t states = 0;
  for (std::int64_t i = 0; good && i < s.elements; ++i) {
    visit_torque(s.element_kind[i], [&](auto tag) {
      using E = typename decltype(tag)::type;
      good = s.element_param[i] + param_count<E> <= s.n_params && s.element_input[i] + E::inputs <= s.n_input_refs &&
             s.element_state[i] + E::states <= s.states - s.shared && plain_inputs(s, s.element_input[i], E::inputs);
      states += E::states;
    });
    visit_torque_curves(s.element_kind[i], [&](int at) { good = good && curve_fits(s, s.element_param[i] + at); });
  }
  for (std::int64_t i = 0; good && i < s.contacts; ++i) {
    visit_contact(s.contact_kind[i], [&](auto tag) {
      using E = typename decltype(tag)::type;
      good = s.contact_param[i] + param_count<E> <= s.n_params && s.contact_input[i] + E::inputs <= s.n_input_refs &&
             plain_inputs(s, s.contact_input[i], E::inputs);
    });
    visit_contact_curves(s.contact_kind[i], [&](int at) { good = good && curve_fits(s, s.contact_param[i] + at); });
    visit_law(s.contact_law[i], [&](auto tag) {
      using L = typename decltype(tag)::type;
      constexpr int inputs = law_inputs<L>();
      good = good && s.contact_law_param[i] + param_count<L> <= s.n_params &&
             s.contact_law_input[i] + inputs <= s.n_input_refs && plain_inputs(s, s.contact_law_input[i], inputs);
    });
    visit_law_curves(s.contact_law[i], [&](int at) { good = good && curve_fits(s, s.contact_law_param[i] + at); });
    if (!good || !tables_fit(s, i)) return false;
    const int own = states_of(s.contact_kind[i], s.contact_law[i], s.params + s.contact_law_param[i]);
    good = s.contact_state[i] + own <= s.states - s.shared;
    states += own;
  }
  // states are nobody's twice
  good = good && states <= s.states - s.shared;
  return good;
}

void point_at(cw_run* run) {
  for (std::int64_t i = 0; i < run->ws.sys.n_input_refs; ++i) run->ws.ref_signal[i] = run->ws.sys.input_refs[i];
  for (std::int64_t p = 0; p < run->ws.sys.prescribed; ++p) {
    run->ws.ref_signal[run->ws.sys.n_input_refs + p] = run->ws.sys.prescribed_input[p];
  }
}

bool same(const char* a, const char* b) { return std::strcmp(a, b) == 0; }

}  // namespace

extern "C" {

std::int64_t cw_schema_hash(void) { return schema_hash; }

std::int64_t cw_size(const void* system, std::int64_t bytes) {
  Workspace<double> ws;
  if (bind(ws.sys, static_cast<const unsigned char*>(system), bytes) < 0 || !in_range(ws.sys)) return -1;
  return head + carve(ws, static_cast<unsigned char*>(nullptr));
}

cw_run* cw_load(const void* system, std::int64_t bytes, void* memory, std::int64_t memory_bytes) {
  const std::int64_t size = cw_size(system, bytes);
  if (size < 0 || memory_bytes < size) return nullptr;
  std::memset(memory, 0, std::size_t(size));
  cw_run* run = new (memory) cw_run;
  run->system = static_cast<const unsigned char*>(system);
  run->arrays = static_cast<unsigned char*>(memory) + head;
  run->bytes = size;
  Workspace<double>& ws = run->ws;
  bind(ws.sys, run->system, bytes);
  ws.row = RowLayout(ws.sys);
  carve(ws, run->arrays);
  point_at(run);
  for (std::int64_t i = 0; i < ws.sys.n_params; ++i) ws.params[i] = ws.sys.params[i];
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) {
    ws.signal[i] = Signal{};
    ws.signal[i].held = ws.sys.input_value[i];
  }
  return run;
}

int cw_set_option(cw_run* run, const char* name, double value) {
  Options& o = run->ws.options;
  if (!(value >= 0)) return 0;
  if (same(name, "rtol") && value > 0) return o.rtol = value, 1;
  if (same(name, "atol") && value > 0) return o.atol = value, 1;
  if (same(name, "method") && value <= 2) return o.method = Method(int(value)), 1;
  if (same(name, "first_step")) return o.first_step = value, 1;
  if (same(name, "max_step") && value > 0) return o.max_step = value, 1;
  if (same(name, "max_steps") && value < 9e18) return o.max_steps = std::int64_t(value), 1;
  if (same(name, "max_events") && value < 9e18) return o.max_events = std::int64_t(value), 1;
  if (same(name, "angles")) return o.angles = value != 0, 1;
  if (same(name, "work")) return o.work = value != 0, 1;
  return 0;
}

int cw_set_input(cw_run* run, std::int64_t input, double value) {
  Workspace<double>& ws = run->ws;
  if (input < 0 || input >= ws.sys.inputs || ws.sys.input_count[input] != 0) return 0;
  // what the other signals do at this instant has waited for it
  if (ws.signal[input].held == value && ws.next_knot > ws.time) return 1;
  ws.signal[input].held = value;
  // a step is a knot
  ws.next_knot = -infinity;
  // before the first step the value belongs to the start, which is decided anew
  if (ws.statistics.steps + ws.statistics.rejected == 0) ws.started = false;
  return 1;
}

int cw_set_param(cw_run* run, std::int64_t offset, double value) {
  Workspace<double>& ws = run->ws;
  if (offset < 0 || offset >= ws.sys.n_params || is_curve_range(ws.sys, offset)) return 0;
  ws.params[offset] = value;
  ws.input_changed = true;
  return 1;
}

int cw_advance(cw_run* run, double t_end, double* times, double* rows, std::int64_t n, int steps,
               std::int64_t* filled) {
  Sink sink{times, rows, n, 0, steps != 0};
  // a step fills up to three rows
  if (steps != 0 && n < 3) {
    if (filled != nullptr) *filled = 0;
    return int(Status::rows_full);
  }
  const Status status = advance(run->ws, t_end, sink);
  if (filled != nullptr) *filled = sink.at;
  return int(status);
}

double cw_time(const cw_run* run) { return run->ws.time; }

std::int64_t cw_row_size(const cw_run* run) { return run->ws.row.size; }

int cw_row(cw_run* run, double* row) {
  double t = run->ws.time;
  Sink sink{&t, row, 1, 0, false};
  return int(advance(run->ws, run->ws.time, sink));
}

std::int64_t cw_event_size(void) { return event_size; }

std::int64_t cw_take_events(cw_run* run, double* events, std::int64_t room) {
  Workspace<double>& ws = run->ws;
  const std::int64_t n = ws.n_events < room ? ws.n_events : room;
  std::memcpy(events, ws.events, std::size_t(n * event_size) * sizeof(double));
  std::memmove(ws.events, ws.events + n * event_size, std::size_t((ws.n_events - n) * event_size) * sizeof(double));
  ws.n_events -= int(n);
  return n;
}

void cw_statistics(const cw_run* run, std::int64_t counts[7]) {
  const Statistics& s = run->ws.statistics;
  const std::int64_t values[7] = {s.steps, s.rejected, s.evaluations, s.jacobians, s.events, s.phases, s.locations};
  std::memcpy(counts, values, sizeof values);
}

std::int64_t cw_detail(const cw_run* run, double* value) {
  if (value != nullptr) *value = run->ws.detail_value;
  return run->ws.detail_component;
}

void cw_save(const cw_run* run, void* bytes) { std::memcpy(bytes, run, std::size_t(run->bytes)); }

int cw_restore(cw_run* run, const void* bytes, std::int64_t n) {
  if (n != run->bytes) return 0;
  const unsigned char *system = run->system, *mine = run->arrays;
  std::memcpy(static_cast<void*>(run), bytes, std::size_t(n));
  const unsigned char *old_arrays = run->arrays, *old_system = run->system;
  run->system = system;
  run->arrays = const_cast<unsigned char*>(mine);
  // views into memory that may lie elsewhere now
  Workspace<double>& ws = run->ws;
  const bool swapped = ws.here.rate > ws.there.rate;
  bind(ws.sys, system, std::int64_t(1) << 40);
  carve(ws, run->arrays);
  if (swapped) {
    const Edge<double> edge = ws.here;
    ws.here = ws.there;
    ws.there = edge;
  }
  auto moved = [](auto*& p, const unsigned char* from, const unsigned char* to) {
    using P = std::remove_reference_t<decltype(p)>;
    if (p != nullptr) p = reinterpret_cast<P>(to + (reinterpret_cast<const unsigned char*>(p) - from));
  };
  for (int k = 0; k < ws.n_rates; ++k) {
    moved(ws.branch[k].params, old_arrays, mine);
    moved(ws.branch[k].law_params, old_arrays, mine);
    moved(ws.branch[k].input, old_arrays, mine);
    moved(ws.branch[k].input_slope, old_arrays, mine);
    moved(ws.branch[k].law_input, old_arrays, mine);
    moved(ws.branch[k].law_input_slope, old_arrays, mine);
  }
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) moved(ws.signal[i].coef, old_system, system);
  return 1;
}

int cw_law(int number, const double* params, const double* inputs, const double* points, std::int64_t n_points,
           double slip, double* kinetic, double* hold) {
  if (number < 0 || number >= law_kinds) return 0;
  bool has_curves = false;
  visit_law_curves(number, [&](int) { has_curves = true; });
  visit_law(number, [&](auto tag) {
    using L = typename decltype(tag)::type;
    const auto& p = *reinterpret_cast<const typename L::template Params<double>*>(params);
    int piece = 0;
    if constexpr (Kinked<L, double>) {
      const int edges = n_points > 0 || !has_curves ? L::edges(p) : 0;
      while (piece < edges && L::edge(p, points, piece) <= slip) ++piece;
    }
    const At<double> at{slip, nullptr, inputs, piece, points};
    if constexpr (StickingLaw<L>) *kinetic = L::slide(p, at);
    if constexpr (CompliantLaw<L>) {
      // with states the coefficient depends on what went before
      *kinetic = __builtin_nan("");
      if constexpr (L::states == 0) *kinetic = L::coefficient(p, at);
    }
    *hold = L::hold(p, at);
  });
  return 1;
}

}  // extern "C"
