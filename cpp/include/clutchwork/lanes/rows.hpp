#pragma once
#include <clutchwork/lanes/exchange.hpp>
#include <clutchwork/run/output.hpp>
#include <clutchwork/run/step_size.hpp>

/// Rows and work of steps in which nothing happens, from the lanes: docs/theory/lanes.md.
namespace clutchwork {

/// Whether the work of a run follows from its branches alone.
inline bool sums_work_along(const Workspace<double>& ws) {
  return ws.sys.prescribed + ws.sys.supplies + ws.sys.meters == 0;
}

/// Whether what is read of the rows of a run inside of steps can be written from a lane.
inline bool writes_along(const Workspace<double>& ws) {
  const bool reads_work = has_work(ws) && ws.out.lacks_work == 0;
  return (ws.out.inside & RowPart::other) == 0 && !reads_work && ws.sys.prescribed + ws.sys.loads == 0;
}

/// Add the work of a lane over its step.
template <int R>
void take_work(Workspace<double>& run, const Workspace<Lanes<R>>& ws, int i) {
  for (int k = 0; k < run.n_branches; ++k) run.work[run.branch[k].direction] += ws.out.work[k][i];
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

/// Torques of all directions.
template <int R>
void write_torques(const Workspace<double>& run, const Workspace<Lanes<R>>& ws, int i, double* row) {
  const int ne = int(run.sys.elements), nc = int(run.sys.contacts);
  for (int d = 0; d < ne + nc; ++d) {
    const int k = run.branch_of[d];
    const double torque = k >= 0 && k < run.n_branches ? ws.observed.torque[k][i] : 0.0;
    row[d < ne ? run.row.element_torque + d : run.row.contact_torque + d - ne] = torque;
  }
  for (int a = 0; a < run.held.n; ++a) row[run.row.contact_torque + run.held.contact[a]] += ws.observed.carried[a][i];
}

/// What is read of a row of lane i at time t, where the lanes were observed.
template <int R>
void write_row(Workspace<double>& run, Workspace<Lanes<R>>& ws, Step<LaneForm<R>>& step, int i, double t, double* row) {
  const unsigned parts = run.out.inside;
  if ((parts & RowPart::motion) != 0) write_motion(run, step.point(), step.slope(), i, row);
  if ((parts & RowPart::state) != 0) get(row + run.row.state, step.point() + run.reduced.nz, int(run.sys.states), i);
  if ((parts & RowPart::torque) != 0) write_torques(run, ws, i, row);
  for (int k = 0; (parts & RowPart::input) != 0 && k < run.sys.inputs; ++k)
    row[run.row.input + k] = signal_value(run, k, t);
}

}  // namespace clutchwork
