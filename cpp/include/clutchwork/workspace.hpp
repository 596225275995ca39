#pragma once
#include <clutchwork/registry.gen.hpp>

/// Everything that changes during a run, carved once from memory of the caller.
namespace clutchwork {

inline constexpr double infinity = __builtin_huge_val();

enum Mode : int { backward = -1, locked = 0, forward = 1, open = 2 };
enum class Cause : int { initial, slip_zero, torque_limit, input, consequence, impulse, restart, passing, fault };
enum class Method : int { automatic, rodas5p, dopri5 };

/// Settings of a run.
struct Options {
  double rtol = 1e-6;  ///< [1] relative tolerance of a step
  double atol = 1e-8;  ///< [SI] absolute tolerance of a step
  Method method = Method::rodas5p;
  double first_step = 0;       ///< [s] 0: found from the slopes
  double max_step = infinity;  ///< [s]
  std::int64_t max_steps = 10'000'000;
  std::int64_t max_events = 100'000;
  bool angles = true;  ///< integrate the angles
  bool work = true;    ///< integrate the work of every component
};

/// Counters of a run.
struct Statistics {
  std::int64_t steps = 0, rejected = 0, evaluations = 0, jacobians = 0, events = 0, phases = 0, locations = 0;
};

/// Cursor of one signal.
struct Signal {
  std::int64_t segment = 0;
  double start = 0;  ///< [s] start of the present segment
  double knot = 0;   ///< [s] start of the next one
  const double* coef = nullptr;
  double held = 0;  ///< value of a signal that is set from outside
  bool varying = false, linear = true, idle = false;
};

/// An active component: one direction, one torque.
template <class T>
struct Branch {
  const T* params;
  const T* law_params;
  const T* input;
  const T* input_slope;
  const T* law_input;
  const T* law_input_slope;
  int inputs, law_inputs;
  int kind, law;      ///< law is -1 for a torque element
  int direction;      ///< number among elements, then contacts
  int state, states;  ///< own states: offset and number
  int piece;          ///< smooth piece of the element or of the law
  int sign;           ///< direction of slip of a contact
  bool pressed;       ///< a contact with a load; a freewheel without one still blocks
  bool compliant;     ///< a contact whose law never sticks: smooth over signed slip
  bool shaped;        ///< a contact whose torque per load is not the coefficient itself
};

/// Value and partial derivatives of one branch.
template <class T>
struct Partial {
  T torque, by_rate, by_time;
};

/// Guard functions that are linear in the state: sign * (rate - level) stays positive.
struct LineGuard {
  enum Kind : int { slip, edge, pass, turn } kind;
  int branch;
  int sign;
  double level;
};

/// What the guards need at one end of a step.
template <class T>
struct Edge {
  T* rate;        ///< rate of each branch
  T* slope;       ///< its time derivative
  T* multiplier;  ///< torque of each locked contact
  T* drift;       ///< its time derivative
  T* capacity;    ///< static torque of each locked contact
  T* swing;       ///< size of its time derivative where its load bends over time, else zero
  T* noise;       ///< round-off of the torque of each locked contact
  T* room;        ///< what each dependent set has left of its limit load, as a share of the load
};

template <class T>
struct Workspace {
  System sys{};
  RowLayout row{System{}};
  Options options;
  Statistics statistics;

  // the state of the run
  double time = 0;
  T *v = nullptr, *state = nullptr, *angle = nullptr, *work = nullptr, *prescribed_work = nullptr;
  int *mode = nullptr, *piece = nullptr, *forced = nullptr;
  int *pressed = nullptr, *loaded = nullptr;     ///< contacts with a load above zero; those that can transmit at all
  int *compliant = nullptr, *heading = nullptr;  ///< contacts with a law that never sticks; sign of a rate
  int *fault = nullptr, *faulty = nullptr;       ///< what has failed in a contact; contacts that can
  int n_faulty = 0, failed = -1;
  double last_step = 0;  ///< [s] last step that was not cut short
  bool started = false, fresh_phase = true, input_changed = false;
  double crowd_time = -infinity, forced_time = -infinity;
  int* crowd = nullptr;  ///< events of each direction, then knots of each signal, within the last microsecond

  // signals, read through references; the prescribed speeds come last
  Signal* signal = nullptr;
  int n_refs = 0, n_varying = 0, n_directions = 0;
  int *ref_signal = nullptr, *varying = nullptr;
  T *u = nullptr, *du = nullptr;
  double input_time = -infinity, next_knot = infinity;
  T *params = nullptr, *prescribed = nullptr, *prescribed_slope = nullptr, *prescribed_before = nullptr;

  // references that are no signals: shared states first, then rates and heats of directions
  int *shared_ref = nullptr, *direction_ref = nullptr;
  int n_shared_refs = 0, n_direction_refs = 0;
  T* shared_slope = nullptr;  ///< time derivative of each reference to a shared state, else zero
  T *heat = nullptr, *heat_rate = nullptr, *heat_time = nullptr;  ///< of each branch [W], by its rate, by time
  T* heat_share = nullptr;                                        ///< of each branch, by its torque
  T *stage_rate = nullptr, *stage_torque = nullptr;               ///< of each branch at the present stage
  T* by_shared = nullptr;                                         ///< torque of each branch by the shared states
  T *shared_by_rate = nullptr, *shared_by_state = nullptr, *shared_by_shared = nullptr;  ///< of the shared rates
  T *shared_reach = nullptr, *shared_inverse = nullptr;  ///< answer of the motion to a shared state; Schur complement

  // geometry in mass-weighted coordinates x = L' v
  T *factor = nullptr, *direction = nullptr, *prescribed_momentum = nullptr, *white = nullptr;
  int *white_first = nullptr, *white_col = nullptr;

  // the present mode
  int n_locked = 0, rank = 0, nz = 0, n_branches = 0, n_rates = 0, n_lines = 0, n_watch = 0, n_undirected = 0;
  int* locked = nullptr;  ///< contacts that are locked: carriers, which are independent, and rigid ones

  // locked contacts that depend on the carriers, and the sets that they make with them: locked.hpp
  int n_spare = 0, n_sets = 0, n_driven = 0;
  int *spare = nullptr, *set_first = nullptr, *set_rank = nullptr, *set_member = nullptr, *set_place = nullptr;
  int* in_set = nullptr;     ///< of each locked contact
  int* driven = nullptr;     ///< spares whose slip the prescribed speeds can move though the carriers are locked
  T* tie = nullptr;          ///< n_spare x contacts: direction of a spare in terms of the carriers
  T* set_memory = nullptr;   ///< one set at a time
  int* set_basis = nullptr;  ///< of the same
  bool sparse = false, is_explicit = false, redundant = false;
  T *z_basis = nullptr, *y_basis = nullptr, *mobility = nullptr, *mobility_factor = nullptr;
  T *row_z = nullptr, *offset = nullptr, *reach = nullptr, *reach_prescribed = nullptr;
  Branch<T>* branch = nullptr;
  int* branch_of = nullptr;
  LineGuard* line = nullptr;
  Partial<T>* partial = nullptr;
  T *f_state = nullptr, *g_rate = nullptr, *g_time = nullptr, *g_state = nullptr, *a_state = nullptr;
  int* block = nullptr;
  Edge<T> here{}, there{};
  T *torque = nullptr, *output_torque = nullptr, *slip_slope = nullptr, *torque_before = nullptr;
  double* load_size = nullptr;  ///< largest size that the load of a watched contact may have, 0: not known
  double* turned_at = nullptr;  ///< [s] when the load of a contact passed zero last
  int *watch = nullptr, *mode_before = nullptr, *impulse = nullptr;
  int *switching = nullptr, *chattering = nullptr;  ///< branches with laws that switch, or that jump with the slip
  int* bounded = nullptr;                           ///< branches whose laws can be left
  int n_switching = 0, n_chattering = 0, n_bounded = 0, reversals = 0;
  std::int64_t reversals_since = 0;

  // sparse form
  int *sp_first = nullptr, *sp_col = nullptr, *m_first = nullptr, *m_col = nullptr, *sky = nullptr, *pivot_of = nullptr;
  int *exp_first = nullptr, *exp_col = nullptr;
  T *sp_val = nullptr, *m_val = nullptr, *envelope = nullptr, *exp_val = nullptr;

  // scratch
  T *y = nullptr, *stages = nullptr, *scratch = nullptr, *dense_v = nullptr;
  int* iscratch = nullptr;
  T *qp_g = nullptr, *qp_m = nullptr, *qp_x = nullptr, *qp_lo = nullptr, *qp_hi = nullptr, *qp_w = nullptr,
    *qp_f = nullptr;
  int* qp_fix = nullptr;
  T* power = nullptr;

  // events waiting for the caller
  static constexpr int event_room = 256;
  double* events = nullptr;
  int n_events = 0;

  // what the phase that just ended leaves to the switch
  int located = -1;
  double effort = 0;  ///< size of the mass-weighted forces
  Cause cause = Cause::initial;

  // where a failure happened
  int detail_component = -1;
  double detail_value = 0;
  int detail_row = -1;  ///< number in a row that is not finite

  // asked once per step and row, of the caller; other than zero: stop
  int (*poll)(void*) = nullptr;
  void* poll_context = nullptr;
};

/// Whether the caller wants the run to stop.
template <class T>
CLUTCHWORK_INLINE bool stop_asked(const Workspace<T>& ws) {
  return ws.poll != nullptr && ws.poll(ws.poll_context) != 0;
}

/// Hands out pieces of a block of memory, or only counts them when the block is null.
class Arena {
 public:
  explicit Arena(unsigned char* base) : base_(base) {}
  template <class P>
  void take(P*& p, std::int64_t n) {
    at_ = (at_ + 15) / 16 * 16;
    p = base_ ? reinterpret_cast<P*>(base_ + at_) : nullptr;
    at_ += (n > 0 ? n : 1) * std::int64_t(sizeof(P));
  }
  template <class P>
  void scratch(P*& p, std::int64_t n) {
    take(p, n);
  }
  void keep(int*& p, std::int64_t n, std::int64_t, std::int64_t) { take(p, n); }
  std::int64_t size() const { return at_ + 16; }

 private:
  unsigned char* base_;
  std::int64_t at_ = 0;
};

/// The arrays of a workspace, for the memory and for saved states: numbers that are taken are saved, indices are made
/// anew from the modes; what is kept are integers that a saved state holds too, within bounds; scratch is never saved.
template <class W, class A>
void lay_out(W& ws, A& a) {
  const System& s = ws.sys;
  const auto nv = s.speeds, np = s.prescribed, ns = s.states, nc = s.contacts, nd = s.elements + s.contacts;
  const auto nx = s.shared, nr = s.n_input_refs + np;
  a.take(ws.v, nv), a.take(ws.state, ns), a.take(ws.angle, s.nodes), a.take(ws.work, nd),
      a.take(ws.prescribed_work, np);
  a.keep(ws.mode, nc, backward, open), a.keep(ws.piece, nd, -(1ll << 31), (1ll << 31) - 1);
  a.keep(ws.loaded, nc, 0, 1), a.keep(ws.pressed, nc, 0, 1), a.keep(ws.forced, nc, backward, forward);
  a.keep(ws.crowd, nd + s.inputs, 0, 1 << 30);
  a.take(ws.compliant, nc), a.keep(ws.heading, nd, backward, forward), a.take(ws.switching, nd);
  a.take(ws.chattering, nc), a.take(ws.bounded, nc), a.keep(ws.fault, nc, sound, cannot_unlock);
  a.keep(ws.faulty, nc, 0, nc - 1);
  a.take(ws.shared_ref, nr), a.take(ws.direction_ref, nr), a.take(ws.shared_slope, nr);
  a.take(ws.heat, nx > 0 ? nd : 0), a.take(ws.heat_rate, nx > 0 ? nd : 0), a.take(ws.heat_time, nx > 0 ? nd : 0);
  a.take(ws.heat_share, nx > 0 ? nd : 0), a.take(ws.stage_rate, nx > 0 ? nd : 0);
  a.take(ws.stage_torque, nx > 0 ? nd : 0), a.take(ws.by_shared, nd * nx), a.take(ws.shared_by_rate, nd * nx);
  a.take(ws.shared_by_state, ns * nx), a.take(ws.shared_by_shared, nx * nx), a.take(ws.shared_reach, (nv + ns) * nx);
  a.take(ws.shared_inverse, 2 * nx * nx + nx);
  a.take(ws.signal, s.inputs), a.take(ws.ref_signal, nr), a.take(ws.varying, nr);
  a.take(ws.u, nr), a.take(ws.du, nr), a.take(ws.params, s.n_params), a.take(ws.prescribed_before, np);
  a.scratch(ws.factor, nv * nv), a.scratch(ws.direction, nd * nv), a.scratch(ws.prescribed_momentum, np * nv);
  const auto most_spare = nc > 1 ? nc : 0;
  a.take(ws.spare, most_spare), a.take(ws.set_first, most_spare + 1), a.take(ws.set_rank, most_spare);
  a.take(ws.set_member, most_spare), a.take(ws.set_place, most_spare), a.take(ws.in_set, nc),
      a.take(ws.driven, most_spare);
  a.scratch(ws.tie, most_spare * most_spare), a.take(ws.set_basis, 2 * most_spare + 2);
  a.scratch(ws.set_memory, most_spare * (3 * most_spare + 12) + 4);
  a.take(ws.locked, nc), a.take(ws.z_basis, nv * nv), a.take(ws.y_basis, nv * np), a.scratch(ws.mobility, nc * nc);
  a.take(ws.mobility_factor, nc * nc), a.take(ws.white_first, nd + 1), a.take(ws.white_col, nd * nv),
      a.scratch(ws.white, nd * nv);
  a.take(ws.row_z, nd * nv), a.take(ws.offset, nd * np), a.take(ws.reach, nc * nd),
      a.take(ws.reach_prescribed, nc * np);
  a.take(ws.branch, nd), a.take(ws.branch_of, nd), a.take(ws.line, 3 * nd + nc), a.take(ws.partial, nd);
  a.take(ws.f_state, ns), a.take(ws.g_rate, ns), a.take(ws.g_time, ns), a.take(ws.block, nd);
  a.take(ws.g_state, ns * ns), a.take(ws.a_state, ns * ns);
  decltype(&ws.here) edges[] = {&ws.here, &ws.there};
  for (auto* e : edges) {
    a.take(e->rate, nd), a.take(e->slope, nd), a.take(e->multiplier, nc), a.take(e->drift, nc);
    a.take(e->capacity, nc), a.take(e->swing, nc), a.take(e->noise, nc), a.take(e->room, nc);
  }
  a.take(ws.torque, nd), a.take(ws.output_torque, nd), a.scratch(ws.power, 4 * (nd + np));
  a.take(ws.slip_slope, nc), a.take(ws.torque_before, nc), a.keep(ws.watch, nc, 0, nc - 1), a.take(ws.load_size, nc),
      a.take(ws.turned_at, nc);
  a.keep(ws.mode_before, nc, backward, open), a.keep(ws.impulse, nc, 0, 1);
  a.take(ws.sp_first, nd + 1), a.take(ws.sp_col, nd * nv), a.take(ws.sp_val, nd * nv);
  a.take(ws.m_first, nv + 1), a.take(ws.m_col, nv * nv), a.take(ws.m_val, nv * nv);
  a.take(ws.sky, nv + 1), a.take(ws.pivot_of, nv), a.scratch(ws.envelope, 2 * nv * nv);
  a.take(ws.exp_first, nv + 1), a.take(ws.exp_col, nv * nv), a.take(ws.exp_val, nv * nv);
  a.take(ws.y, nv + ns), a.scratch(ws.stages, 20 * (nv + ns)),
      a.scratch(ws.scratch, 8 * (nv + nd + ns) + 3 * nv * nv + nc * (nv + nc));
  a.scratch(ws.dense_v, 4 * nv + 2 * s.nodes + np), a.take(ws.iscratch, 4 * (nv + nd + nc));
  a.scratch(ws.qp_g, 5 * nc), a.scratch(ws.qp_m, nc * nc), a.scratch(ws.qp_x, 3 * nc), a.scratch(ws.qp_lo, nc),
      a.scratch(ws.qp_hi, nc);
  a.scratch(ws.qp_w, nc), a.scratch(ws.qp_f, nc * nc), a.take(ws.qp_fix, 3 * nc);
  a.take(ws.events, event_size * (ws.event_room + 2 * nc));
}

/// Lay the arrays of a workspace into memory; returns the size needed.
template <class T>
std::int64_t carve(Workspace<T>& ws, unsigned char* memory) {
  ws.n_refs = int(ws.sys.n_input_refs + ws.sys.prescribed);
  ws.n_directions = int(ws.sys.elements + ws.sys.contacts);
  Arena a(memory);
  lay_out(ws, a);
  ws.prescribed = ws.u + ws.sys.n_input_refs;
  ws.prescribed_slope = ws.du + ws.sys.n_input_refs;
  return a.size();
}

}  // namespace clutchwork
