#pragma once
#include <clutchwork/components/direction.hpp>
#include <clutchwork/workspace.hpp>

/// The active components of the present modes.
namespace clutchwork {

/// Add a branch to the list.
template <class T>
void pack(Workspace<T>& ws, int d, int sign, int& block) {
  const Branch<T> b = make_branch(ws, d, sign);
  ws.branch_of[d] = ws.n_rates;
  ws.jacobian.block[ws.n_rates] = block;
  block += b.states * b.states;
  for (int i = 0; i < b.states; ++i) ws.reduced.span[b.state + i] = state_span(b.kind, b.law, i);
  ws.branch[ws.n_rates++] = b;
}

/// Active components: all elements and slipping contacts.
/// Behind them, without torque, the open contacts: only their rates are followed.
template <class T>
void pack_branches(Workspace<T>& ws) {
  const auto& sys = ws.sys;
  const int ne = int(sys.elements), nc = int(sys.contacts);
  ws.n_rates = 0;
  int block = 0;
  for (int d = 0; d < ne; ++d) pack(ws, d, 0, block);
  for (int c = 0; c < nc; ++c) {
    ws.branch_of[ne + c] = -1;
    // a law that never sticks works beside a freewheel that is locked
    if (ws.contact.loaded[c] && (ws.contact.mode[c] != locked || ws.contact.compliant[c]))
      pack(ws, ne + c, ws.contact.mode[c], block);
  }
  ws.n_branches = ws.n_rates;
  for (int c = 0; c < nc; ++c) {
    // the position of an open stop tells when it closes
    if (ws.contact.loaded[c] || ws.contact.compliant[c] || ws.sys.contact_place[c] >= 0) continue;
    pack(ws, ne + c, ws.contact.mode[c] == open ? 0 : ws.contact.mode[c], block);
  }
  // rows of locked contacts whose directions vary stand behind all rates
  ws.ratios.more_rows = 0;
  for (int a = ws.held.n_fixed; a < ws.held.n; ++a) {
    const int d = ne + ws.held.contact[a];
    if (ws.branch_of[d] < 0) ws.branch[ws.n_rates + ws.ratios.more_rows++] = make_branch(ws, d, 0);
  }
}

}  // namespace clutchwork
