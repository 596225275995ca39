#pragma once
#include <clutchwork/components/dual.hpp>
#include <clutchwork/workspace/motion.hpp>

/// Transmissions: rates that a varying ratio ties together. docs/theory/varying-ratios.md
namespace clutchwork {

/// What transmissions are at one point of a step, over a scalar S. Ties: transmissions with inertia on both sides, then
/// locked contacts whose directions vary. Rows: both directions of each transmission, then those of these contacts.
template <class S>
struct Tied {
  S *ratio = nullptr, *slope = nullptr, *pull = nullptr;  ///< of each transmission: ratio, its time derivative, (3)
  S* acceleration = nullptr;                              ///< of each row
  S *share = nullptr, *via = nullptr;                     ///< of each tie over the rows, and over the followers
  S *gram = nullptr, *wanted = nullptr;                   ///< of the ties
  S *torque = nullptr, *held = nullptr;                   ///< of each transmission, of each of the locked contacts
  S* push = nullptr;                                      ///< a single torque over the speeds

  template <class P, class A>
  static void lay_out(P& p, A& a, std::int64_t n, std::int64_t contacts, std::int64_t speeds) {
    const auto ties = n + contacts, rows = 2 * n + contacts;
    a.scratch(p.ratio, n), a.scratch(p.slope, n), a.scratch(p.pull, n), a.scratch(p.acceleration, rows);
    a.scratch(p.share, ties * rows), a.scratch(p.via, ties * n), a.scratch(p.gram, ties * ties);
    a.scratch(p.wanted, ties), a.scratch(p.torque, n), a.scratch(p.held, contacts), a.scratch(p.push, speeds);
  }
};

/// Of each transmission a: its row (rate 1) - ratio (rate 2), and what the rows of one instant leave of every
/// direction.
template <class T>
struct Ratios {
  int n = 0;
  T *value = nullptr, *before = nullptr;  ///< its ratio, and that before an event
  T *pull = nullptr, *wanted = nullptr;   ///< what its row must give of the accelerations, and without followers
  T* present = nullptr;                   ///< its ratio at the point of a phase that was evaluated last
  T *turned = nullptr,
    *sorted = nullptr;  ///< that at which redundant contacts were turned last, and that of the phase meanwhile
  T* torque = nullptr;  ///< along its first direction
  T* row = nullptr;     ///< n x speeds

  // the rows that tie speeds with inertia, mass-weighted: row order[k] = sum of triangle[k, j] span[j]
  int rank = 0;
  double blur = 0;  ///< round-off of the span, of a direction
  int* order = nullptr;
  T *span = nullptr, *triangle = nullptr, *share = nullptr;
  T* drawn = nullptr;  ///< part of the acceleration along the span that the rows ask for

  // what they leave of the directions, which stand in the place of those of the geometry while a decision is made
  Compressed<T> mass_weighted;
  T *own = nullptr, *mobility = nullptr;
  T* via = nullptr;     ///< directions x n: share of the row of a transmission that was taken off a direction
  T* whole = nullptr;   ///< mobility of each direction before the span was taken off
  T* missed = nullptr;  ///< length of what is left of a direction and does not count
  T* part = nullptr;    ///< directions x n: parts of a direction along the span
  T* tied = nullptr;    ///< n, scratch: what the rows of a motion miss, or its parts along the span
  bool inside = false;  ///< a decision is made
  int jammed = -1;      ///< transmission that nothing can keep at its ratio, -1: none
  int stopped = -1;     ///< locked contact whose direction varies and that has just stopped what moved, -1: none
  int reversed = -1;    ///< tie that has turned over in the step, -1: none
  int lost = -1;        ///< the same, or one of which nothing is left at its end

  // of a phase
  int more_rows = 0;  ///< of the form, behind those of the rates: locked contacts whose directions vary
  int rows = 0, ties = 0;
  int* place = nullptr;                    ///< of each row among those of the form
  int* tie = nullptr;                      ///< transmission of each tie, -1: a contact
  int* column = nullptr;                   ///< reduced speed that follows from a transmission, -1: none
  T *along = nullptr, *between = nullptr;  ///< M^-1 row' of each row, and their products with the rows
  T* follows = nullptr;                    ///< rows x n: share of the speed that follows from a transmission
  Tied<T> plain;
  Tied<Dual<T, Full<T>::chunk>> some;
  Tied<Dual<T, 1>> drift;

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& s) {
    const auto n = s.transmissions, nv = n > 0 ? s.speeds : 0, nd = n > 0 ? s.directions : 0,
               nc = n > 0 ? s.contacts : 0, rows = 2 * n + nc;
    a.take(p.value, n), a.take(p.before, n), a.take(p.pull, n), a.scratch(p.wanted, n), a.take(p.torque, n);
    a.scratch(p.present, n), a.scratch(p.turned, n), a.scratch(p.sorted, n);
    a.scratch(p.row, n * nv), a.take(p.order, n), a.scratch(p.span, n * nv), a.scratch(p.triangle, n * n);
    a.scratch(p.share, n), a.scratch(p.drawn, n), a.scratch(p.tied, n);
    Compressed<T>::lay_out(p.mass_weighted, a, nd, nd * nv), a.scratch(p.own, nd), a.scratch(p.whole, nd);
    a.scratch(p.missed, nd);
    a.scratch(p.mobility, nc * (nc + 1) / 2), a.scratch(p.via, nd * n), a.scratch(p.part, nd * n);
    a.take(p.place, rows), a.take(p.tie, n + nc), a.take(p.column, n);
    a.scratch(p.along, rows * nv), a.scratch(p.between, rows * rows), a.scratch(p.follows, rows * n);
    Tied<T>::lay_out(p.plain, a, n, nc, nv), Tied<Dual<T, Full<T>::chunk>>::lay_out(p.some, a, n, nc, nv);
    Tied<Dual<T, 1>>::lay_out(p.drift, a, n, nc, nv);
  }
};

}  // namespace clutchwork
