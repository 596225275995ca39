#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/components/pieces.hpp>
#include <clutchwork/contacts/sticking.hpp>
#include <clutchwork/workspace.hpp>

/// Lists of what the guards must watch in the present modes: docs/theory/events.md.
namespace clutchwork {

/// The sign of the slip of a law whose torque jumps with it: an event may have turned it. Where the slip is zero, the
/// sign is that from before, none at a start at rest.
template <class T>
void head_where_it_slips(Workspace<T>& ws, int direction) {
  const double rate = value(rate_of(ws, direction));
  int& heading = ws.heading[direction];
  if (ws.guard.is_placed) return;
  if (abs(rate) > slip_tolerance(ws))
    heading = rate > 0 ? forward : backward;
  else if (ws.statistics.steps == 0)
    heading = 0;
}

/// Branches whose laws jump with the slip, and open contacts at rest.
template <class T>
void list_laws(Workspace<T>& ws) {
  ws.guard.n_chattering = ws.guard.n_undirected = 0;
  for (int k = 0; k < ws.n_branches; ++k) {
    const int law = ws.branch[k].law;
    if (law < 0 || !is_chattering_law(law)) continue;
    ws.guard.chattering[ws.guard.n_chattering++] = k;
    head_where_it_slips(ws, ws.branch[k].direction);
  }
  for (int k = ws.n_branches; k < ws.n_rates; ++k) ws.guard.n_undirected += ws.branch[k].sign == 0;
  // what closes at rest has not slipped either way
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const int d = int(ws.sys.elements) + c, law = int(ws.sys.contact_law[c]);
    if (ws.branch_of[d] < 0 && law >= 0 && is_chattering_law(law)) ws.heading[d] = 0;
  }
}

/// Guard of the slip of a contact: where it may lock.
template <class T>
void list_slip(Workspace<T>& ws, int k) {
  const Branch<T>& b = ws.branch[k];
  const int c = b.direction - int(ws.sys.elements);
  const double slip = value(rate_of(ws, b.direction));
  if (may_stick(ws, c) && ws.contact.mode[c] != locked) {
    // what prescribed speeds drive cannot be stopped
    const bool driven = is_rigid(ws, c) || (ws.ratios.n > 0 && value(ws.ratios.own[b.direction]) == 0);
    const double level = ws.contact.forced[c] == 0 && !driven ? value(ws.sys.contact_tolerance[c]) : 0.0;
    const bool outside = abs(slip) >= level * (1 - 1e-9);
    LineGuard& line = ws.guard.line[ws.guard.n_lines++];
    // it is watched as it was where the phase has begun
    const bool known = ws.guard.is_placed && line.kind == LineGuard::slip && line.branch == k;
    line = {LineGuard::slip, k, ws.contact.mode[c], known ? line.level : outside ? level * ws.contact.mode[c] : 0.0};
  }
}

/// Guard of a rate whose change of sign matters to the law or the element behind it.
template <class T>
void list_turn(Workspace<T>& ws, int k) {
  const Branch<T>& b = ws.branch[k];
  if ((b.law >= 0 && !b.compliant) || !law_turns(b)) return;
  const double rate = value(rate_of(ws, b.direction));
  int& heading = ws.heading[b.direction];
  if (!ws.guard.is_placed && abs(rate) > slip_tolerance(ws)) heading = rate > 0 ? forward : backward;
  ws.guard.line[ws.guard.n_lines++] = {LineGuard::turn, k, heading, 0.0};
}

/// Guards that are linear in the state.
template <class T>
void list_lines(Workspace<T>& ws) {
  ws.guard.n_lines = 0;
  for (int k = 0; k < ws.n_branches; ++k) {
    const Branch<T>& b = ws.branch[k];
    const bool contact = b.law >= 0;
    if (contact) list_slip(ws, k);
    list_turn(ws, k);
    const int edges = edge_count(ws, b.direction), sign = contact ? b.sign : 1, interval = b.piece % (edges + 1);
    if (interval < edges)
      ws.guard.line[ws.guard.n_lines++] = {LineGuard::edge, k, -sign, sign * value(edge_at(ws, b.direction, interval))};
    if (interval > 0)
      ws.guard.line[ws.guard.n_lines++] = {LineGuard::edge, k, sign,
                                           sign * value(edge_at(ws, b.direction, interval - 1))};
  }
  for (int k = ws.n_branches; k < ws.n_rates; ++k) {
    // an open contact has passed zero when it is clear of it on the other side
    const int sign = ws.branch[k].sign;
    if (sign != 0) ws.guard.line[ws.guard.n_lines++] = {LineGuard::pass, k, sign, -sign * slip_tolerance(ws)};
  }
}

}  // namespace clutchwork
