#pragma once
#include <clutchwork/components/dual.hpp>
#include <clutchwork/components/envelope.hpp>
#include <clutchwork/workspace/signals.hpp>

/// The motion of one mode: geometry, reduced coordinates, derivatives, shared states.
namespace clutchwork {

/// Rows of a matrix without their zeros. What they multiply may have derivatives where they are plain.
template <class T>
struct Compressed {
  int *first = nullptr, *col = nullptr;
  T* val = nullptr;

  /// Product of row i and x.
  template <class X>
  CLUTCHWORK_HOT X times(int i, const X* x) const {
    X s = X(0);
    for (int e = first[i]; e < first[i + 1]; ++e) add_times(val[e], x[col[e]], s);
    return s;
  }
  /// Size of what the product of row i and x is made of.
  double size(int i, const T* x) const {
    double s = 0;
    for (int e = first[i]; e < first[i + 1]; ++e) s += abs(value(val[e] * x[col[e]]));
    return s;
  }
  /// x += factor times row i.
  template <class X>
  CLUTCHWORK_HOT void add(int i, const X& factor, X* x) const {
    for (int e = first[i]; e < first[i + 1]; ++e) add_times(val[e], factor, x[col[e]]);
  }

  template <class P, class A>
  static void lay_out(P& p, A& a, std::int64_t rows, std::int64_t entries) {
    a.take(p.first, rows + 1), a.take(p.col, entries), a.scratch(p.val, entries);
  }
};

/// Of the whole run, in mass-weighted coordinates x = L' v.
template <class T>
struct Geometry {
  Envelope inertia;                                     ///< of the factor
  T *factor = nullptr, *prescribed_momentum = nullptr;  ///< of the mass matrix
  Compressed<T> mass_weighted;                          ///< the directions
  T* own = nullptr;                                     ///< mobility of each direction, the square of its length
  Envelope near;                                        ///< of the mobility
  T* mobility = nullptr;                                ///< of the contacts, in an order in which neighbours are close
  int *place = nullptr, *at = nullptr;  ///< of each contact in that order, and the contact at each place
  int* last = nullptr;                  ///< last place that a place has mobility in common with
  bool redundant = false;               ///< contacts can depend on each other
  T* column = nullptr;                  ///< scratch, of each speed
  int* rest = nullptr;                  ///< scratch, of each speed

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.inertia.low, n.speeds), a.take(p.inertia.sky, n.speeds), a.scratch(p.factor, n.factor);
    a.scratch(p.prescribed_momentum, n.prescribed * n.speeds);
    Compressed<T>::lay_out(p.mass_weighted, a, n.directions, n.mass_weighted), a.scratch(p.own, n.directions);
    a.take(p.near.low, n.contacts), a.take(p.near.sky, n.contacts), a.scratch(p.mobility, n.mobility);
    a.take(p.place, n.contacts), a.take(p.at, n.contacts), a.take(p.last, n.contacts);
    a.scratch(p.column, n.speeds), a.take(p.rest, n.speeds + 2);
  }
};

/// Forms of the motion that are compiled, as bits: 1 the small ones, 2 sparse, 4 full. A program of one model needs
/// few.
#ifndef CLUTCHWORK_FORMS
#define CLUTCHWORK_FORMS 7
#endif
inline constexpr bool has_small_forms = (CLUTCHWORK_FORMS & 1) != 0, has_sparse_form = (CLUTCHWORK_FORMS & 2) != 0,
                      has_full_form = (CLUTCHWORK_FORMS & 4) != 0;

/// Sizes of the small forms: one speed to small_speeds, no state to small_states.
inline constexpr int small_speeds = 4, small_states = 2;

/// v = Z z + Y u, and the rates of the branches in it.
template <class T>
struct Reduced {
  int rank = 0, nz = 0;
  bool is_sparse = false;
  Method method = Method::rodas5p;
  T* y = nullptr;  ///< z and the states at the start of a phase
  T *z_basis = nullptr, *y_basis = nullptr;
  T *row_z = nullptr, *offset = nullptr;                     ///< of each branch
  T *momentum = nullptr, *column = nullptr, *row = nullptr;  ///< scratch, of each speed
  Real<T>* span = nullptr;                                   ///< of each state [s]
  Real<T>*size = nullptr, *missed = nullptr;                 ///< scratch, of each speed: its size in a step, its error
  Real<T>* floor = nullptr;                                  ///< scratch, of each state: its absolute tolerance

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.y, n.speeds + n.states), a.take(p.z_basis, n.speeds * small_speeds),
        a.take(p.y_basis, n.speeds * n.prescribed);
    a.take(p.row_z, n.directions * small_speeds), a.take(p.offset, n.directions * n.prescribed);
    a.scratch(p.momentum, n.speeds), a.scratch(p.column, n.speeds);
    a.scratch(p.row, n.speeds), a.scratch(p.size, n.speeds), a.scratch(p.missed, n.speeds);
    a.take(p.span, n.states), a.scratch(p.floor, n.states);
  }
};

/// The sparse form: rates, mass and expansion of reduced coordinates, and the envelope in which they are factored.
template <class T>
struct SparseRows {
  Compressed<T> rate, expansion;
  Compressed<T> mass;                     ///< lower half
  Compressed<T> solved;                   ///< each eliminated speed over those left then, in the order of elimination
  Compressed<T> spread;                   ///< speeds over those that are kept, `spread_at` tells the row of a speed
  int *pivot = nullptr, *step = nullptr;  ///< speed of each elimination; elimination of each speed, -1: it is kept
  int* spread_at = nullptr;
  int* number = nullptr;               ///< of each speed among those that are kept, or -1
  int *low = nullptr, *sky = nullptr;  ///< of each row: first column in the envelope; place of column 0
  T *envelope = nullptr, *mass_envelope = nullptr;

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    Compressed<T>::lay_out(p.rate, a, n.directions, n.rate), Compressed<T>::lay_out(p.mass, a, n.speeds, n.mass);
    Compressed<T>::lay_out(p.expansion, a, n.speeds, n.expansion);
    Compressed<T>::lay_out(p.solved, a, n.speeds, n.expansion);
    Compressed<T>::lay_out(p.spread, a, n.speeds, n.expansion);
    a.take(p.pivot, n.speeds), a.take(p.step, n.speeds), a.take(p.spread_at, n.speeds);
    a.take(p.number, n.speeds), a.take(p.low, n.speeds), a.take(p.sky, n.speeds);
    a.scratch(p.envelope, n.envelope), a.scratch(p.mass_envelope, n.envelope);
  }
};

/// Partial derivatives of the branches and of their own states.
template <class T>
struct Jacobian {
  Partial<T>* partial = nullptr;
  T *f_state = nullptr, *g_rate = nullptr, *g_time = nullptr;
  T* g_state = nullptr;                                             ///< blocks of the branches
  int* block = nullptr;                                             ///< of each branch: place of its block
  T* torque_by = nullptr;                                           ///< torque of each branch by the shared states
  T *by_rate = nullptr, *by_state = nullptr, *by_shared = nullptr;  ///< of the rates of the shared states

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.partial, n.directions), a.take(p.f_state, n.states), a.take(p.g_rate, n.states),
        a.take(p.g_time, n.states);
    a.take(p.g_state, n.blocks), a.take(p.block, n.directions);
    const auto nx = n.shared, nd = nx > 0 ? n.directions : 0;
    a.take(p.torque_by, nd * nx), a.take(p.by_rate, nd * nx);
    a.take(p.by_state, n.states * nx), a.take(p.by_shared, nx * nx);
  }
};

/// Shared states: heats, and the border that they put around the motion.
template <class T>
struct Shared {
  T *heat = nullptr, *heat_rate = nullptr, *heat_time = nullptr;  ///< of each branch [W], by its rate, by time
  T* heat_share = nullptr;                                        ///< of each branch, by its torque
  T* supply = nullptr;                                            ///< work and heat of each branch [W]
  T *stage_rate = nullptr, *stage_torque = nullptr;               ///< of each branch at the present stage
  T *reach = nullptr, *inverse = nullptr, *rhs = nullptr;  ///< answer of the motion to a shared state; Schur complement
  int* pivot = nullptr;                                    ///< of its inversion
  int* piece = nullptr;                                    ///< smooth piece of each process, then of each flow

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.keep(p.piece, n.processes + n.flows, 0, (1ll << 31) - 1);
    const auto nx = n.shared, nd = nx > 0 ? n.directions : 0;
    a.take(p.heat, nd), a.take(p.heat_rate, nd), a.take(p.heat_time, nd), a.take(p.heat_share, nd);
    a.take(p.supply, nd);
    a.take(p.stage_rate, nd), a.take(p.stage_torque, nd), a.take(p.reach, (n.speeds + n.states) * nx);
    a.take(p.inverse, nx * nx), a.scratch(p.rhs, nx), a.take(p.pivot, nx);
  }
};

/// Scratch of the integrators.
template <class T>
struct Stages {
  T* rows = nullptr;     ///< of a step
  T* stiff = nullptr;    ///< effective damping of each branch
  T* inverse = nullptr;  ///< of the blocks of the own states
  int* pivot = nullptr;  ///< of the inversion of a block

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.scratch(p.rows, step_rows * (n.speeds + n.states)), a.scratch(p.stiff, n.directions);
    a.take(p.inverse, n.blocks), a.take(p.pivot, n.states);
  }
  static constexpr int step_rows = 20;
};

/// What one evaluation of the whole motion reads and makes, over a scalar S.
template <class S>
struct Whole {
  S *y = nullptr, *d = nullptr;                           ///< speeds and states; what `evaluate` gives
  S* input = nullptr;                                     ///< of each reference
  S *rate = nullptr, *torque = nullptr, *heat = nullptr;  ///< of each branch
  int time = -1;                                          ///< column of the derivatives that is time, -1: none
  S *coupling = nullptr, *followed = nullptr;             ///< of contacts that follow loads: matrix, torques
  S* steepness = nullptr;                                 ///< of their lines, towards their slip
  int* pivot = nullptr;                                   ///< of the factor of the matrix

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    const auto unknowns = n.full ? n.speeds + n.states : 0, nd = n.full ? n.directions : 0;
    a.scratch(p.y, unknowns), a.scratch(p.d, unknowns), a.scratch(p.input, n.full ? n.references : 0);
    a.scratch(p.rate, nd), a.scratch(p.torque, nd), a.scratch(p.heat, nd);
    a.scratch(p.coupling, n.loads * n.loads), a.scratch(p.followed, n.loads), a.scratch(p.steepness, n.loads);
    a.take(p.pivot, n.loads);
  }
};

/// The full form: docs/theory/coupled.md.
template <class T>
struct Full {
  static constexpr int chunk = 8;  ///< columns of the Jacobian at a time
  Whole<T> plain;
  Whole<Dual<T, chunk>> some;
  Whole<Dual<T, 1>> along;
  T *jacobian = nullptr, *factor = nullptr;  ///< by rows, of all unknowns
  int* pivot = nullptr;
  // the factor without its zeros: of each row what stands before the diagonal, then what stands behind it
  T* part = nullptr;
  int *column = nullptr, *first = nullptr;

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    const auto unknowns = n.full ? n.speeds + n.states : 0;
    Whole<T>::lay_out(p.plain, a, n), Whole<Dual<T, chunk>>::lay_out(p.some, a, n);
    Whole<Dual<T, 1>>::lay_out(p.along, a, n);
    a.scratch(p.jacobian, unknowns * unknowns), a.scratch(p.factor, unknowns * unknowns), a.take(p.pivot, unknowns);
    a.scratch(p.part, unknowns * unknowns), a.take(p.column, unknowns * unknowns);
    a.take(p.first, n.full ? 2 * unknowns + 1 : 0);
  }
};

}  // namespace clutchwork
