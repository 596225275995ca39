#pragma once
#include <clutchwork/lanes/exchange.hpp>
#include <clutchwork/run/output.hpp>

/// Rows and work of steps in which nothing happens, from the lanes: docs/theory/lanes.md.
namespace clutchwork {

/// Whether number i of a list of all numbers, or of some, is `place`.
inline bool is_read(const ReadNumbers& read, std::int64_t place) {
  for (std::int64_t i = 0; i < read.n; ++i)
    if (read.place[i] == place) return true;
  return read.n < 0;
}

/// Branches whose work is read.
template <int R>
void list_worked(LaneOutput<R>& out, const Workspace<double>& run) {
  const int ne = int(run.sys.elements);
  out.n_worked = 0;
  for (int k = 0; k < run.n_branches; ++k) {
    const int d = run.branch[k].direction;
    const std::int64_t place = d < ne ? run.row.element_work + d : run.row.contact_work + d - ne;
    if (is_read(run.out.read, place)) out.worked[out.n_worked++] = k;
  }
}

/// Where the torque of a direction is in the lanes.
template <int R>
const Lanes<R>* torque_in_lanes(Workspace<Lanes<R>>& ws, const Workspace<double>& run, int d) {
  const int k = run.branch_of[d];
  if (k >= 0 && k < run.n_branches) return ws.observed.torque + k;
  for (int a = 0; a < run.held.n; ++a) {
    if (int(run.sys.elements) + run.held.contact[a] != d) continue;
    ws.out.carried = true;
    return ws.observed.carried + a;
  }
  return ws.out.zero;
}

/// Where a number of a row is in the lanes. False: in none, or there is no room for it.
template <int R>
bool show_number(Workspace<Lanes<R>>& ws, const Workspace<double>& run, Step<LaneForm<R>>& step, std::int64_t place) {
  const RowLayout& row = run.row;
  LaneOutput<R>& out = ws.out;
  if (place < row.state) {
    out.motion = true;
    return place < row.angle || place >= row.acceleration;
  }
  const bool torque = place >= row.element_torque && place < row.element_work;
  if (out.n_shown >= run.n_directions + run.sys.states + run.sys.inputs) return false;
  if (place >= row.element_torque && !torque && place < row.input) return false;
  const Lanes<R>* from = torque              ? torque_in_lanes(ws, run, int(place - row.element_torque))
                         : place < row.input ? step.point() + run.reduced.nz + (place - row.state)
                                             : nullptr;
  out.shown[out.n_shown++] = {from, int(place)};
  return true;
}

/// What is made of steps in which nothing happens, of runs in the mode of this one.
template <int R>
void list_output(Workspace<Lanes<R>>& ws, const Workspace<double>& run, Step<LaneForm<R>>& step) {
  LaneOutput<R>& out = ws.out;
  const System& sys = run.sys;
  const ReadNumbers& inside = run.out.inside;
  list_worked(out, run);
  out.motion = out.carried = false;
  out.n_shown = out.n_seen = 0;
  // angles and work inside of steps are those of single runs
  out.rows = inside.n >= 0 && sys.prescribed + sys.loads == 0;
  for (std::int64_t i = 0; out.rows && i < inside.n; ++i) out.rows = show_number(ws, run, step, inside.place[i]);
  for (int k = 0; out.rows && k < run.n_branches; ++k) {
    bool seen = out.motion || out.carried;
    for (int i = 0; i < out.n_shown; ++i) seen = seen || out.shown[i].from == ws.observed.torque + k;
    if (seen) out.seen[out.n_seen++] = k;
  }
}

/// Speeds and accelerations of the nodes of lane i, from reduced speeds and their derivatives.
template <int R>
void write_motion(Workspace<double>& run, const Lanes<R>* y, const Lanes<R>* d, int i, double* row) {
  SmallForm<double> form(run);
  double z[small_speeds], dz[small_speeds];
  get(z, y, form.nz(), i), get(dz, d, form.nz(), i);
  expand(form, z, run.out.v), expand(form, dz, run.out.dv, false);
  fill_nodes(run, Snapshot<double>{z, dz, nullptr, run.out.v, run.out.dv}, row);
}

/// What is read of a row of lane i at time t, where the lanes were observed.
template <int R>
CLUTCHWORK_INLINE void write_row(Workspace<double>& run, const LaneOutput<R>& out, Step<LaneForm<R>>& step, int i,
                                 double t, double* row) {
  if (out.motion) write_motion(run, step.point(), step.slope(), i, row);
  for (int j = 0; j < out.n_shown; ++j) {
    const ShownNumber<R>& one = out.shown[j];
    row[one.place] = one.from != nullptr ? (*one.from)[i] : signal_value(run, int(one.place - run.row.input), t);
  }
}

}  // namespace clutchwork
