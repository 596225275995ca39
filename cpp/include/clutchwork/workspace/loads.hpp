#pragma once
#include <clutchwork/components/bound.hpp>
#include <clutchwork/workspace/arena.hpp>
#include <clutchwork/workspace/settings.hpp>

/// Contacts whose capacity follows the torque of a gear row, their load: docs/theory/load-dependent.md.
namespace clutchwork {

/// Of each load.
template <class T>
struct Loads {
  int* of = nullptr;                            ///< of each contact: the number of its load, -1: none
  int* line = nullptr;                          ///< of the bound with which its contact slips
  T *by_torque = nullptr, *by_slope = nullptr;  ///< by the torques of all directions, prescribed accelerations
  T *by_branch = nullptr,
    *by_prescribed = nullptr;          ///< the same in the present mode, torques of held contacts included
  T* by_held = nullptr;                ///< by the torques of locked contacts whose directions vary
  T* outer = nullptr;                  ///< without the torques of the locked contacts
  T *now = nullptr, *drift = nullptr;  ///< where torques were looked at last; its time derivative
  T* momentum = nullptr;               ///< of the virtual motion of each, mass-weighted
  // beside transmissions, in the place of by_torque and by_slope while a decision is made: what they carry is in it
  T *beside_torque = nullptr, *beside_slope = nullptr;
  T* by_drawn = nullptr;  ///< by the accelerations that transmissions give along their span
  int n_sliding = 0;
  int jammed = -1;                            ///< contact that is to stop at once
  int *sliding = nullptr, *branch = nullptr;  ///< loads whose contacts slip, and the branches of those

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.of, n.contacts), a.keep(p.line, n.loads, 0, 1), a.take(p.now, n.loads);
    a.scratch(p.by_torque, n.loads * n.directions);
    a.scratch(p.by_slope, n.loads * n.prescribed), a.scratch(p.by_branch, n.loads * n.directions);
    a.scratch(p.by_prescribed, n.loads * n.prescribed), a.scratch(p.outer, n.loads), a.scratch(p.drift, n.loads);
    a.take(p.sliding, n.loads), a.take(p.branch, n.loads), a.scratch(p.momentum, n.loads * n.speeds);
    const auto beside = n.transmissions > 0 ? n.loads : 0;
    a.scratch(p.by_held, beside * n.contacts), a.scratch(p.beside_torque, beside * n.directions);
    a.scratch(p.beside_slope, beside * n.prescribed), a.scratch(p.by_drawn, beside * n.transmissions);
  }
};

/// Memory of the decision where contacts follow loads: contacts/coupled.hpp. Of n contacts, and of the loads.
template <class T>
struct CoupledMemory {
  T* mobility = nullptr;  ///< n x n: slip accelerations by torques
  T* gradient = nullptr;  ///< n: slip accelerations without these torques
  T* weight = nullptr;    ///< n: a little mobility of its own, so that torques of dependent contacts are unique
  T *lower = nullptr, *upper = nullptr;  ///< n, of those without load
  int* load = nullptr;                   ///< n: number of its load, -1: none
  int* sliding = nullptr;                ///< n: 1 forward, -1 backward: it slips already, 0: it may stick
  int* starts = nullptr;                 ///< n: it is let go the way it slides and must move so
  T* reach = nullptr;                    ///< loads x n: load by the torques
  T* given = nullptr;                    ///< loads: without these torques
  Bound<T>* bound = nullptr;             ///< loads x 2: against slip backward, then forward

  // the solution
  T* x = nullptr;        ///< n: torques
  T* slope = nullptr;    ///< n: slip accelerations
  T* now = nullptr;      ///< loads
  int* state = nullptr;  ///< n: 0 sticks, 1 slips forward, -1 backward
  int* line = nullptr;   ///< n: of the bound that it slips with

  // scratch
  T* matrix = nullptr;   ///< n x n
  T* trial = nullptr;    ///< n
  int* pivot = nullptr;  ///< n
  int* next = nullptr;   ///< 2 n: what state and line change to

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    const auto nc = n.loads > 0 ? n.contacts : 0, m = n.loads;
    a.scratch(p.mobility, nc * nc), a.scratch(p.gradient, nc), a.scratch(p.weight, nc), a.scratch(p.lower, nc);
    a.scratch(p.upper, nc), a.scratch(p.reach, m * nc), a.scratch(p.given, m), a.scratch(p.x, nc);
    a.scratch(p.slope, nc), a.scratch(p.now, m), a.scratch(p.matrix, nc * nc), a.scratch(p.trial, nc);
    a.take(p.bound, 2 * m), a.take(p.load, nc), a.take(p.sliding, nc), a.take(p.starts, nc), a.take(p.state, nc),
        a.take(p.line, nc);
    a.take(p.pivot, nc), a.take(p.next, 2 * nc);
  }
};

}  // namespace clutchwork
