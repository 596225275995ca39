#pragma once
#include <clutchwork/components/bound.hpp>
#include <clutchwork/components/single.hpp>
#include <clutchwork/workspace/arena.hpp>
#include <clutchwork/workspace/settings.hpp>

/// Fixed steps: their history, their matrices and their scratch. docs/theory/fixed-steps.md
namespace clutchwork {

/// Whether sums over the steps keep what their own precision loses.
#ifdef CLUTCHWORK_SINGLE
inline constexpr bool sums_keep = true;
#else
inline constexpr bool sums_keep = false;
#endif

/// Up to so many speeds their rows are whole.
inline constexpr int most_whole_speeds = 4;

/// What a contact holds at inputs that it has seen: found again where these, or its fault, are others.
template <class T>
struct Hold {
  T load, torque[2];  ///< load; static torque against slip backward, then forward
  T low, high;        ///< slips between which its present piece is
  int fault;          ///< what had failed in it, -1: nothing is known
};

/// What is linear in its rate and in the one state that it may have: torque without both, slopes, rate of the state.
template <class T>
struct Line {
  T offset, by_rate, by_state, state_by_rate;
};

/// What a step goes through, listed once a run, so that it visits no more than there is.
template <class T>
struct FixedPlan {
  int n_linear = 0, n_bent = 0, n_bounded = 0, n_one_way = 0, n_rigid = 0, n_stops = 0, n_crossing = 0;
  int n_unsteady = 0;
  int *linear = nullptr, *bent = nullptr;  ///< directions whose torques are linear functions; other functions
  int* smooth = nullptr;                   ///< of each direction: its torque is a function of its rate and states
  int* blocks = nullptr;                   ///< of each contact: whether it blocks one way, at times at least
  Line<T>* line = nullptr;                 ///< of each direction that is linear
  Hold<T>* hold = nullptr;                 ///< of each contact
  T* seen = nullptr;                       ///< of each reference: its value where that was found
  // of few models
  int *bounded = nullptr, *rigid = nullptr, *stops = nullptr, *crossing = nullptr;
  int* one_way = nullptr;   ///< contacts that block one way
  int* unsteady = nullptr;  ///< loads whose bounds follow slips or inputs

  template <class P, class A>
  static void lay_out(P& p, A& a, std::int64_t nd, std::int64_t nc, std::int64_t nl, std::int64_t references) {
    a.take(p.crossing, nd), a.take(p.bounded, nc), a.take(p.rigid, nc), a.take(p.stops, nc), a.take(p.one_way, nc);
    a.take(p.unsteady, nl), a.take(p.line, nd), a.take(p.linear, nd), a.take(p.bent, nd), a.take(p.smooth, nd);
    a.take(p.blocks, nc), a.take(p.hold, nc), a.scratch(p.seen, references);
  }
};

template <class T>
struct Fixed {
  // the history, of which saved states have a copy
  double time = -infinity;   ///< [s] end of the last step; where it is not the present time there is no history
  Real<T> before = 0;        ///< [s] length of that step, 0: there was none
  double origin = 0;         ///< [s] where the present grid of steps begins
  std::int64_t count = 0;    ///< steps on it
  std::int64_t impacts = 0;  ///< since the last of them
  std::int64_t fresh = 0;    ///< no step was taken since the modes were decided
  T *gain = nullptr, *state_gain = nullptr;  ///< change of speeds, states
  T* kept = nullptr;    ///< of each direction: slope of its torque that is in the matrix [N m s/rad]
  T* torque = nullptr;  ///< of each direction: mean over the last step
  T* held = nullptr;    ///< of each contact: static torque in it, against slip backward, then forward

  // made anew where it is not there
  Real<T> length = 0;         ///< [s] of the steps whose matrices there are, 0: none
  bool ready = false;         ///< the branches are packed; of a run beside one of single precision: that one is placed
  bool has_massless = false;  ///< some speeds have no inertia
  FixedPlan<T> plan;
  int* bends = nullptr;      ///< of each direction: its piece follows from where it is
  int* two_sided = nullptr;  ///< of each contact: it resists both directions differently
  T* factor = nullptr;       ///< Cholesky factor of the matrix of a step, by rows
  T* answer = nullptr;       ///< change of the speeds by a unit impulse of each contact
  T* mobility = nullptr;     ///< of the contacts, by rows: change of slips by unit impulses
  T* rate_rows = nullptr;    ///< of few speeds: rates of directions by them
  T* node_rows = nullptr;    ///< and speeds of nodes

  // scratch of a step
  T *ahead = nullptr, *state_ahead = nullptr;  ///< speeds and states predicted for its middle
  T *change = nullptr, *state_change = nullptr;
  T *force = nullptr, *slope = nullptr;             ///< of each direction: torque at rate zero; its slope by the rate
  T* predicted = nullptr;                           ///< of each direction: rate in the middle
  T *start_rate = nullptr, *rate_change = nullptr;  ///< of each direction
  T* gained = nullptr;                              ///< of each direction: rate that changes of the speeds make
  T* mean = nullptr;                                ///< of each direction: torque
  T *node_end = nullptr, *node_gain = nullptr;      ///< of each node: speed at the end, its change
  T *impulse = nullptr, *gradient = nullptr, *lower = nullptr, *upper = nullptr, *weight = nullptr;
  T *end_slip = nullptr, *solved = nullptr, *free_factor = nullptr;
  T *kinetic = nullptr, *limit = nullptr;  ///< of each contact: what resists slip backward, then forward [N m]
  int *side = nullptr, *list = nullptr, *box = nullptr, *mode = nullptr;
  T* share = nullptr;         ///< of each contact: where in the step it breaks away
  double* instant = nullptr;  ///< [s] of each contact: when its mode changes

  // of each load: its impulse by changes of speeds, of prescribed ones, by impulses of contacts; without these
  T *load_by_speed = nullptr, *load_by_given = nullptr, *load_reach = nullptr, *load_free = nullptr;
  T* load_now = nullptr;                          ///< of each load: its impulse with the present ones of contacts
  T* load_size = nullptr;                         ///< of each load: the sum of the sizes of what it is without these
  Bound<T>* load_bound = nullptr;                 ///< of each load: what holds against slip backward, then forward
  T *load_matrix = nullptr, *load_off = nullptr;  ///< of those at a bound: their system, what they are off
  int *follower = nullptr, *load_line = nullptr;  ///< which these are; lines of all bounds in the last round
  Real<T> load_miss = 0;                          ///< the largest part of itself that an impulse is off its bound

  // what a step of few models reads: states of nonlinear functions, speeds without inertia, prescribed ones
  T *state_force = nullptr, *state_slope = nullptr;  ///< of each own state: change at the predicted rate; by the rate
  T* state_share = nullptr;                          ///< of each own state: part of the step at which it is taken
  int* massless = nullptr;                           ///< of each direction: whether some of these are in its rate
  T *given = nullptr, *given_ahead = nullptr;        ///< prescribed speeds now and in the middle of the step
  T *given_change = nullptr, *given_gain = nullptr;

  // what a step changes beside its results, as it was before it, where it may be taken back
  std::int64_t* segment = nullptr;  ///< of each signal: the segment that it is on
  int *fault = nullptr, failed = -1, events = 0;
  std::int64_t counted = 0;

  // single precision: what the sums of speeds, states, angles and energies have not taken yet; where matrices are made
  // and impulses are looked for; where the run is; one row, where that of the caller is of another precision
  T *speed_low = nullptr, *state_low = nullptr, *angle_low = nullptr, *energy_low = nullptr;
  Twofold *wide_factor = nullptr, *wide_answer = nullptr, *wide_mobility = nullptr, *wide_impulse = nullptr;
  Twofold *wide_slip = nullptr, *wide_solved = nullptr, *wide_free = nullptr;
  void* image = nullptr;
  T* row = nullptr;

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    const bool has = !has_tangents<T> && n.fixed;
    const auto nv = has ? n.speeds : 0, ns = has ? n.states : 0, nd = has ? n.directions : 0;
    const auto nc = has ? n.contacts : 0, np = has ? n.prescribed : 0;
    a.take(p.gain, nv), a.take(p.state_gain, ns), a.take(p.given_gain, np), a.take(p.given, np);
    a.take(p.kept, nd), a.take(p.torque, nd), a.take(p.held, 2 * nc);
    FixedPlan<T>::lay_out(p.plan, a, nd, nc, has ? n.loads : 0, has ? n.references : 0);
    if constexpr (NumberOf<T>::single || (sums_keep && !has_tangents<T>)) {
      a.take(p.speed_low, nv), a.take(p.state_low, ns), a.take(p.angle_low, has ? n.nodes : 0);
      a.take(p.energy_low, has ? n.directions + n.prescribed + n.supplies + n.meters : 0);
      if constexpr (NumberOf<T>::single) {
        a.scratch(p.row, n.row), a.scratch(p.wide_factor, nv * nv), a.scratch(p.wide_answer, nc * nv);
        a.scratch(p.wide_mobility, nc * nc), a.scratch(p.wide_impulse, nc), a.scratch(p.wide_slip, nc);
        a.scratch(p.wide_solved, nc), a.scratch(p.wide_free, nc * nc);
      }
    }
    a.take(p.massless, nd), a.take(p.bends, nd), a.take(p.two_sided, nc);
    a.scratch(p.factor, nv * nv), a.scratch(p.answer, nc * nv), a.scratch(p.mobility, nc * nc);
    const auto nn = has ? n.nodes : 0, whole = nv <= most_whole_speeds ? nv : 0;
    a.scratch(p.rate_rows, nd * whole), a.scratch(p.node_rows, nn * whole);
    a.scratch(p.gained, nd), a.scratch(p.node_end, nn), a.scratch(p.node_gain, nn);
    a.scratch(p.ahead, nv), a.scratch(p.state_ahead, ns), a.scratch(p.change, nv), a.scratch(p.state_change, ns);
    a.scratch(p.force, nd), a.scratch(p.slope, nd), a.scratch(p.predicted, nd);
    a.scratch(p.start_rate, nd), a.scratch(p.rate_change, nd), a.scratch(p.mean, nd);
    a.scratch(p.impulse, nc), a.scratch(p.gradient, nc), a.scratch(p.lower, nc), a.scratch(p.upper, nc);
    a.scratch(p.end_slip, nc), a.scratch(p.kinetic, 2 * nc), a.scratch(p.limit, 2 * nc);
    a.take(p.side, nc), a.take(p.box, nc), a.take(p.mode, nc);
    const auto nl = has ? n.loads : 0;
    a.scratch(p.load_by_speed, nl * nv), a.scratch(p.load_reach, nl * nc);
    a.scratch(p.load_free, nl), a.scratch(p.load_now, nl), a.scratch(p.load_size, nl), a.scratch(p.load_bound, 2 * nl);
    // what a step of few models reads, or one in which contacts stick or change
    a.take(p.list, nc), a.scratch(p.weight, nc), a.scratch(p.solved, nc), a.scratch(p.free_factor, nc * nc);
    a.scratch(p.load_matrix, nl * nl), a.scratch(p.load_off, nl), a.take(p.follower, nl), a.take(p.load_line, 2 * nl);
    a.scratch(p.share, nc), a.scratch(p.instant, nc), a.scratch(p.load_by_given, nl * np);
    a.scratch(p.given_change, np), a.scratch(p.given_ahead, np);
    a.scratch(p.state_force, ns), a.scratch(p.state_slope, ns), a.scratch(p.state_share, ns);
    a.take(p.segment, has ? n.signals : 0), a.take(p.fault, nc);
  }
};

}  // namespace clutchwork
