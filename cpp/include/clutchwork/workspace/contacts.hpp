#pragma once
#include <clutchwork/components/envelope.hpp>
#include <clutchwork/workspace/arena.hpp>
#include <clutchwork/workspace/settings.hpp>

/// Contacts: what each one is and does, which are locked, and the memory of decisions.
namespace clutchwork {

/// Of each contact.
template <class T>
struct Contacts {
  int *mode = nullptr, *forced = nullptr;     ///< forced: the way in which it must slip while time stands
  int *pressed = nullptr, *loaded = nullptr;  ///< contacts with a load above zero; those that can transmit at all
  int* compliant = nullptr;                   ///< contacts with a law that never sticks
  int* fault = nullptr;                       ///< what has failed in it
  int* impulse = nullptr;                     ///< contacts that an impulse has locked at the start
  int* side = nullptr;                        ///< of each stop: the end at which it is closed, -1 or 1, 0: it is open
  int* struck = nullptr;                      ///< stops that have met an end at this instant
  double* met_at = nullptr;                   ///< [s] when a stop met an end last, or another contact was let go last
  int* untried = nullptr;                     ///< its fault, and whether it is loaded and pressed, before a trial
  int failed = -1;                            ///< contact whose fault ends the run
  double forced_time = -infinity;             ///< [s]

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.keep(p.mode, n.contacts, backward, open), a.keep(p.forced, n.contacts, backward, forward);
    a.keep(p.pressed, n.contacts, 0, 1), a.keep(p.loaded, n.contacts, 0, 1);
    a.take(p.compliant, n.contacts), a.keep(p.fault, n.contacts, 0, choice::words<choice::Fault> - 1);
    a.keep(p.impulse, n.contacts, 0, 1), a.keep(p.side, n.contacts, -1, 1), a.take(p.struck, n.contacts);
    a.take(p.met_at, n.contacts), a.take(p.untried, n.contacts);
  }
};

/// What an event leaves to the decision: why, which contact, and how all contacts were right before it.
template <class T>
struct EventContext {
  Cause cause = Cause::initial;
  int contact = -1;                       ///< whose guard was hit; -1: none or several
  int* mode = nullptr;                    ///< of each contact
  T *torque = nullptr, *slope = nullptr;  ///< of each contact [N m]; time derivative of its slip

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.keep(p.mode, n.contacts, backward, open), a.take(p.torque, n.contacts), a.take(p.slope, n.contacts);
  }
};

/// The locked contacts: those that are independent or rigid, and redundant ones, which depend on them and make sets
/// with them: contacts/locked.hpp.
template <class T>
struct Held {
  int n = 0;               ///< number of independent contacts
  int n_fixed = 0;         ///< of those whose directions do not vary, which come first: docs/theory/varying-ratios.md
  int* contact = nullptr;  ///< of each independent contact
  Envelope near;           ///< of the factor
  int* turn = nullptr;     ///< independent contact at each row of the factor
  T* factor = nullptr;     ///< Cholesky factor of the mobility of the independent contacts
  bool mapped = false;     ///< the torques of the independent contacts are a linear map, below
  T *reach = nullptr, *reach_prescribed = nullptr;  ///< torques by those of branches and prescribed accelerations

  int n_redundant = 0, n_sets = 0, n_driven = 0;
  int *redundant = nullptr, *set_first = nullptr, *set_rank = nullptr, *set_member = nullptr, *set_place = nullptr;
  int* in_set = nullptr;  ///< of each independent contact
  int* driven = nullptr;  ///< redundant contacts whose slip the prescribed speeds can move though the independent
                          ///< contacts are locked
  T* tie = nullptr;  ///< n_redundant x contacts: direction of a redundant contact in terms of the independent contacts
  bool too_many = false;       ///< more than there is room for: the system is not what it says
  int rank = 0;                ///< of the directions of the locked contacts where they were sorted
  bool vanished = false;       ///< nothing is left of an independent contact where the sets were looked at last
  double* strength = nullptr;  ///< what each locked contact held where they were sorted, where some follow loads

  // scratch
  T *rhs = nullptr,
    *solved = nullptr;   ///< of each independent contact: right-hand side of its mobility, and the solution
  T* carried = nullptr;  ///< torques of the independent contacts
  T* motion = nullptr;   ///< mass-weighted acceleration, of each speed
  T* turned = nullptr;   ///< a right-hand side in the order of the factor
  T *rows = nullptr, *basis = nullptr, *norms = nullptr, *share = nullptr;  ///< of a split of directions
  int *order = nullptr, *all = nullptr, *number = nullptr;                  ///< of the same
  int *at = nullptr,
      *row = nullptr;  ///< independent contact at each place of the mobility, -1: none; its row in the factor

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    const auto nc = n.contacts, most = n.spares, nv = n.few ? n.speeds : 0;
    a.take(p.contact, nc), a.take(p.near.low, nc), a.take(p.near.sky, nc), a.take(p.turn, nc);
    a.scratch(p.factor, n.mobility), a.take(p.reach, n.few ? nc * n.directions : 0);
    a.take(p.reach_prescribed, n.few ? nc * n.prescribed : 0);
    a.take(p.redundant, most), a.take(p.set_first, most + 1), a.take(p.set_rank, most), a.take(p.set_member, nc);
    a.take(p.set_place, nc), a.take(p.in_set, nc), a.take(p.driven, most), a.scratch(p.tie, most * nc);
    a.take(p.strength, n.loads > 0 ? nc : 0);
    a.scratch(p.rhs, nc), a.scratch(p.solved, nc), a.scratch(p.carried, nc), a.scratch(p.motion, n.speeds);
    a.scratch(p.turned, nc), a.scratch(p.rows, nc * nv), a.scratch(p.basis, nv * nv);
    a.scratch(p.norms, nc), a.scratch(p.share, nc);
    a.take(p.order, nc), a.take(p.all, nc), a.take(p.number, nc), a.take(p.at, nc), a.take(p.row, nc);
  }
};

/// Memory of one dependent set, its limit load and its shares: contacts/dependent.hpp.
template <class T>
struct SetMemory {
  T *column = nullptr, *load = nullptr, *lower = nullptr, *upper = nullptr, *x = nullptr;
  T *tableau = nullptr, *limit_x = nullptr, *price = nullptr;
  T *deflection = nullptr, *step = nullptr, *residual = nullptr, *matrix = nullptr;
  int *basis = nullptr, *place = nullptr;
  T *low = nullptr, *high = nullptr;                               ///< where members follow loads: bounds
  int *follower = nullptr, *line = nullptr, *best_line = nullptr;  ///< and which they are, and their lines

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    const auto m = n.set, more = 2 * n.loads, wide = m + more + 1;
    a.scratch(p.column, m * m), a.scratch(p.load, m), a.scratch(p.lower, m), a.scratch(p.upper, m), a.scratch(p.x, m);
    a.scratch(p.tableau, (m + more) * wide), a.scratch(p.limit_x, wide), a.scratch(p.price, wide);
    a.scratch(p.deflection, m), a.scratch(p.step, m), a.scratch(p.residual, m), a.scratch(p.matrix, m * m);
    a.take(p.basis, m + more), a.take(p.place, wide);
    a.scratch(p.low, more > 0 ? wide : 0), a.scratch(p.high, more > 0 ? wide : 0), a.take(p.follower, n.loads);
    a.take(p.line, more), a.take(p.best_line, more);
  }
};

/// Memory of the convex problem: contacts/problem.hpp.
template <class T>
struct ProblemMemory {
  T *diagonal = nullptr, *gradient = nullptr, *lower = nullptr, *upper = nullptr, *weight = nullptr,
    *capacity = nullptr;
  T *x = nullptr, *slope = nullptr, *trial = nullptr, *factor = nullptr;
  int *bound = nullptr, *free = nullptr;
  Envelope near;        ///< of the factor
  int* slot = nullptr;  ///< number in the problem of the contact at each place, -1: none
  int* row = nullptr;   ///< row in the factor of the contact at each place

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    const auto nc = n.contacts;
    a.scratch(p.diagonal, nc), a.scratch(p.gradient, nc), a.scratch(p.lower, nc), a.scratch(p.upper, nc);
    a.scratch(p.weight, nc), a.scratch(p.capacity, nc), a.scratch(p.x, nc), a.scratch(p.slope, nc);
    a.scratch(p.trial, nc), a.scratch(p.factor, n.mobility), a.take(p.bound, nc), a.take(p.free, nc);
    a.take(p.near.low, nc), a.take(p.near.sky, nc), a.take(p.slot, nc), a.take(p.row, nc);
  }
};

/// Scratch of a decision, and the torques that it gives.
template <class T>
struct Decision {
  int* candidate = nullptr;   ///< of each contact: it may stick
  int* released = nullptr;    ///< of each contact: 1 released, -1 taken back, 2 released for good
  int* list = nullptr;        ///< contacts of the problem
  int* before = nullptr;      ///< of each contact: its mode before all are tried together
  T* motion = nullptr;        ///< mass-weighted acceleration, of each speed
  double effort = 0;          ///< sum of the sizes of what makes it, against which its round-off is measured
  double pull = 0;            ///< the same of the torques alone
  double missed = 0;          ///< the same of what does not make it, for next to nothing is left of its direction
  T* torque = nullptr;        ///< of each contact that is locked [N m]
  T* acceleration = nullptr;  ///< of each slip, after it
  T* speed = nullptr;         ///< change of each speed by impulses

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.candidate, n.contacts), a.take(p.released, n.contacts), a.take(p.list, n.contacts);
    a.take(p.before, n.contacts), a.scratch(p.motion, n.speeds), a.scratch(p.torque, n.contacts),
        a.scratch(p.acceleration, n.contacts);
    a.scratch(p.speed, n.speeds);
  }
};

}  // namespace clutchwork
