#pragma once
#include <clutchwork/workspace/arena.hpp>
#include <clutchwork/workspace/settings.hpp>

/// What guards look at, what is observed and written, and the events that wait for the caller.
namespace clutchwork {

/// Guard functions that are linear in the state: sign * (rate - level) stays positive.
struct LineGuard {
  enum Kind : int { slip, edge, pass, turn } kind;
  int branch;
  int sign;
  double level;
};

/// What the guards need at one end of a step.
template <class T>
struct StepEnd {
  T* rate;               ///< rate of each branch
  T* slope;              ///< its time derivative
  T* multiplier;         ///< torque of each locked contact
  T* drift;              ///< its time derivative
  T* capacity;           ///< static torque of each locked contact
  T* swing;              ///< size of its time derivative where its load bends over time, else zero
  T* noise;              ///< round-off of the torque of each locked contact
  T *load, *load_drift;  ///< each load, and its time derivative
  T *clearance,
      *closing;  ///< of each load whose contact slips: how far its line is above the other; how fast that changes
  T* room;       ///< what each dependent set has left of its limit load, as a share of the load

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.rate, n.directions), a.take(p.slope, n.directions), a.take(p.multiplier, n.contacts);
    a.take(p.drift, n.contacts), a.take(p.capacity, n.contacts), a.take(p.swing, n.contacts);
    a.take(p.noise, n.contacts), a.take(p.room, n.contacts), a.take(p.load, n.loads), a.take(p.load_drift, n.loads),
        a.take(p.clearance, n.loads), a.take(p.closing, n.loads);
  }
};

/// Lists of what must be watched in the present phase.
struct Guards {
  LineGuard* line = nullptr;
  int *switching = nullptr, *chattering = nullptr;  ///< branches with laws that switch, or that jump with the slip
  int *bounded = nullptr, *faulty = nullptr;        ///< contacts whose laws can be left; contacts that can fail
  int *load = nullptr, *near = nullptr;  ///< contacts whose loads may pass zero; those that may in the present step
  int* gap = nullptr;                    ///< stops that are open
  int* bending = nullptr;                ///< locked contacts whose laws have pieces
  int* limit = nullptr;                  ///< independent contacts that may break away: scratch
  int* process = nullptr;                ///< processes that switch between pieces, and flows behind them
  double* load_size = nullptr;           ///< largest size that the load of a contact may have, 0: not known
  double* turned_at = nullptr;           ///< [s] when the load of a contact passed zero last
  int n_lines = 0, n_switching = 0, n_chattering = 0, n_bounded = 0, n_faulty = 0, n_loads = 0, n_near = 0;
  int n_processes = 0, n_gaps = 0, n_bending = 0;
  int n_undirected = 0;  ///< open contacts at rest
  int reversals = 0;     ///< of slips that chatter
  int strained = 0;      ///< explicit steps in a row at the limit of their stability
  std::int64_t reversals_since = 0;
  double folded_at = -infinity;    ///< [s] where balances of speeds without inertia have ended last
  double balanced_at = -infinity;  ///< [s] where speeds without inertia have jumped last, with a decision
  double jumped_at = -infinity;    ///< [s] where something has jumped last: the next step begins with what settles fast
  double parted_at = -infinity;    ///< [s] where prescribed speeds have parted a locked contact last
  int parted = -1;                 ///< which
  bool is_placed = false;          ///< the state is given from outside: the headings of the phase stay
  double zero = 0;                 ///< slip that counts as zero in the steps, by the speeds at the last event

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.line, 3 * n.directions + n.contacts), a.take(p.switching, n.directions), a.take(p.chattering, n.contacts);
    a.take(p.bounded, n.contacts), a.keep(p.faulty, n.contacts, 0, n.contacts - 1);
    a.keep(p.load, n.contacts, 0, n.contacts - 1), a.take(p.near, n.contacts), a.take(p.limit, n.contacts);
    a.take(p.load_size, n.contacts), a.take(p.turned_at, n.contacts), a.take(p.process, n.processes + n.flows);
    a.take(p.gap, n.contacts), a.take(p.bending, n.contacts);
  }
};

/// Rates and torques of the branches where they were observed last.
template <class T>
struct Observed {
  T *rate = nullptr, *torque = nullptr, *drift = nullptr;
  T* carried = nullptr;      ///< torques of the independent contacts
  T* state_rates = nullptr;  ///< scratch of a torque that is asked for alone

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.scratch(p.rate, n.directions), a.take(p.torque, n.directions), a.scratch(p.drift, n.directions);
    a.take(p.carried, n.contacts), a.scratch(p.state_rates, n.states);
  }
};

/// Numbers of a row that somebody reads, in memory of the caller; n = -1: all.
struct ReadNumbers {
  const std::int64_t* place = nullptr;
  std::int64_t n = -1;
};

/// What a row of output is made from.
template <class T>
struct Output {
  T* torque = nullptr;                               ///< of every direction
  T *v = nullptr, *dv = nullptr, *turned = nullptr;  ///< of each speed: value, time derivative, angle since the start
  T *angle = nullptr, *prescribed_angle = nullptr;
  T* power = nullptr;                     ///< of each direction, source, supply and meter, as cubics
  T* since = nullptr;                     ///< work of each of them since the start of the step
  int is_rough = -1;                      ///< whether the cubics miss much inside of the step; -1: not known
  int lacks_angles = 0, lacks_work = 0;   ///< whether rows lack them: 1 inside of steps, 2 everywhere
  ReadNumbers read, inside;               ///< what is read of rows; of those in steps in which nothing happens
  double until = -1;                      ///< share of the step of the last row in it, -1: it has none
  double jumps_at = -1, jumps_from = -1;  ///< shares at which torques jump, and where they are seen as before
  T *whole = nullptr, *halves = nullptr;  ///< work of each branch over a step and its halves
  T* missed = nullptr;                    ///< of each branch: what cubics miss of its power at the ends of a step
  double shown = 0;                       ///< [s] last row in a step
  bool skipped = false;                   ///< the last step was too short for rows

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.torque, n.directions), a.scratch(p.v, n.speeds), a.scratch(p.dv, n.speeds), a.scratch(p.turned, n.speeds);
    a.scratch(p.angle, n.nodes), a.scratch(p.prescribed_angle, n.prescribed);
    a.scratch(p.power, 4 * (n.directions + n.prescribed + n.supplies + n.meters));
    a.scratch(p.since, n.directions + n.prescribed + n.supplies + n.meters), a.scratch(p.whole, n.directions);
    a.scratch(p.halves, n.directions), a.scratch(p.missed, 4 * n.directions);
  }
};

/// Events that wait for the caller.
struct EventBuffer {
  static constexpr int room = 256;
  double* at = nullptr;
  int n = 0;
  int* crowd =
      nullptr;  ///< within the last microsecond: events of each direction, knots of each signal, of processes and flows
  double crowd_time = -infinity;

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.keep(p.crowd, n.directions + n.signals + n.processes + n.flows, 0, 1 << 30),
        a.take(p.at, event_size * (room + 3 * n.contacts));
  }
};

}  // namespace clutchwork
