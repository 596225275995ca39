#pragma once
#include <clutchwork/components/lanes.hpp>
#include <clutchwork/motion/form.hpp>
#include <clutchwork/motion/reduce.hpp>
#include <clutchwork/workspace.hpp>

/// What a step of eight runs reads and writes: docs/theory/lanes.md.
namespace clutchwork {

/// The signals of the lanes: no cursors, which the runs keep, but the cubic that each lane is on.
template <int R>
struct Signals<Lanes<R>> {
  int n_refs = 0, n_varying = 0;
  int* varying = nullptr;  ///< references that vary in some lane
  Lanes<R>*u = nullptr, *du = nullptr;
  Lanes<R>*start = nullptr, *cubic = nullptr;  ///< of each reference: start of its segment [s], its coefficients
  Mask<R>*varies = nullptr, *linear = nullptr;
  int* waves = nullptr;  ///< of each reference: some lane has a wave
  Lanes<R>*prescribed = nullptr, *prescribed_slope = nullptr;
  Lanes<R>* shared_slope = nullptr;  ///< zeros

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.varying, n.references), a.take(p.u, n.references), a.take(p.du, n.references);
    a.take(p.start, n.references), a.take(p.cubic, 4 * n.references), a.take(p.varies, n.references);
    a.take(p.linear, n.references), a.take(p.waves, n.references), a.take(p.shared_slope, n.references);
  }
};

/// A line guard of all lanes.
template <int R>
struct LaneLine {
  int branch;
  Lanes<R> sign, level;
};

/// A number of a row that lanes have; `from` is null: a signal.
template <int R>
struct ShownNumber {
  const Lanes<R>* from;
  int place;
};

/// What is made of steps in which nothing happens.
template <int R>
struct LaneOutput {
  bool rows = false, motion = false, carried = false;  ///< rows are written; with speeds; with torques of held contacts
  int n_shown = 0, n_seen = 0, n_worked = 0;
  ShownNumber<R>* shown = nullptr;
  int *seen = nullptr, *worked = nullptr;     ///< branches whose torques rows ask for; those whose work is read
  Lanes<R>*power = nullptr, *work = nullptr;  ///< of each of these over a step: as cubics, and its integral
  Lanes<R>* zero = nullptr;

  template <class P, class A>
  static void lay_out(P& p, A& a, const Sizes& n) {
    a.take(p.shown, n.directions + n.states + n.signals), a.take(p.seen, n.directions);
    a.take(p.worked, n.directions), a.take(p.power, 4 * n.directions), a.take(p.work, n.directions);
    a.take(p.zero, 1);
  }
};

/// Numbers of a model that may differ from lane to lane; the others are those of the first one.
template <int R>
struct LaneSystem : System {
  const Lanes<R>* points = nullptr;
};

template <int R>
struct Workspace<Lanes<R>> {
  LaneSystem<R> sys{};
  struct {
    Lanes<R> rtol, atol;
  } options;
  struct {
    Lanes<R> evaluations{0};
    std::int64_t jacobians = 0;
  } statistics;
  Lanes<R>*params = nullptr, *points = nullptr;
  int n_directions = 0, n_branches = 0, n_rates = 0;
  Branch<Lanes<R>>* branch = nullptr;
  Signals<Lanes<R>> in;
  struct {
    int *fault = nullptr, *compliant = nullptr;
    Mask<R>* bends = nullptr;  ///< whether its load bends over time
  } contact;
  struct {
    int n = 0;
    const bool mapped = true;
    int* contact = nullptr;
    Lanes<R>*reach = nullptr, *reach_prescribed = nullptr;
  } held;
  struct {
    int nz = 0;
    Lanes<R>*z_basis = nullptr, *row_z = nullptr, *offset = nullptr;
    Lanes<R>* gross = nullptr;  ///< of each branch with states: what each speed brings into its rate, without sign
    Lanes<R>*span = nullptr, *size = nullptr, *missed = nullptr, *floor = nullptr;
  } reduced;
  Jacobian<Lanes<R>> jacobian;
  Stages<Lanes<R>> stages;
  StepEnd<Lanes<R>> step_start{}, step_end{};
  struct {
    Lanes<R>*rate = nullptr, *torque = nullptr, *drift = nullptr, *carried = nullptr;
  } observed;
  LaneOutput<R> out;
  struct {
    LaneLine<R>* line = nullptr;
    int n_lines = 0, n_undirected = 0;
  } guard;
  Lanes<R> noise;                              ///< round-off of a rate [rad/s]
  const Workspace<double>* run[n_lanes] = {};  ///< of each lane, null: none

  template <class P, class A>
  static void lay_out(P& p, A& a, const System& sys) {
    const Sizes n(sys);
    a.take(p.params, sys.n_params), a.take(p.points, 3 * sys.n_points), a.take(p.branch, n.directions);
    a.take(p.held.reach, n.contacts * n.directions), a.take(p.held.reach_prescribed, n.contacts * n.prescribed);
    a.take(p.reduced.z_basis, n.speeds * n.speeds), a.take(p.reduced.row_z, n.directions * n.speeds);
    a.take(p.reduced.offset, n.directions * n.prescribed), a.take(p.reduced.gross, n.directions * n.speeds);
    a.take(p.reduced.span, n.states), a.take(p.reduced.floor, n.states);
    a.take(p.reduced.size, n.speeds), a.take(p.reduced.missed, n.speeds);
    a.take(p.observed.torque, n.directions), a.take(p.observed.drift, n.directions);
    a.take(p.observed.rate, n.directions), a.take(p.observed.carried, n.contacts);
    a.take(p.guard.line, 3 * n.directions + n.contacts);
    a.take(p.contact.fault, n.contacts), a.take(p.contact.compliant, n.contacts);
    a.take(p.contact.bends, n.contacts), a.take(p.held.contact, n.contacts);
    auto each = [&](auto&... part) { (std::remove_reference_t<decltype(part)>::lay_out(part, a, n), ...); };
    each(p.in, p.jacobian, p.stages, p.step_start, p.step_end, p.out);
  }
};

/// Lay the arrays of the lanes into memory, aligned to 64 bytes; returns the size needed.
template <int R>
std::int64_t carve(Workspace<Lanes<R>>& ws, const System& sys, unsigned char* memory) {
  Arena a(memory);
  Workspace<Lanes<R>>::lay_out(ws, a, sys);
  static_cast<System&>(ws.sys) = sys;
  ws.sys.points = ws.points;
  ws.n_directions = int(sys.elements + sys.contacts);
  ws.in.n_refs = int(sys.n_input_refs + sys.prescribed);
  ws.in.prescribed = ws.in.u + sys.n_input_refs;
  ws.in.prescribed_slope = ws.in.du + sys.n_input_refs;
  return a.size();
}

/// As for one run: the ratios may differ from lane to lane.
template <int R>
CLUTCHWORK_INLINE Lanes<R> rate_size(const Workspace<Lanes<R>>& ws, int k, const Lanes<R>* size) {
  const int nv = int(ws.sys.speeds);
  Lanes<R> sum(0);
  for (int i = 0; i < nv; ++i) sum += ws.reduced.gross[k * nv + i] * size[i];
  return sum;
}

/// The small form of the lanes. NZ, NS: numbers of speeds and of states where the compiler knows them, else -1.
template <int R, int NZ = -1, int NS = -1>
using LaneForm = SmallForm<Lanes<R>, NZ, NS>;

}  // namespace clutchwork
