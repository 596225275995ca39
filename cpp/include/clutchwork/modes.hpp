#pragma once
#include <clutchwork/branch.hpp>
#include <clutchwork/contacts.hpp>

/// Which contacts stick, slip or are open, decided for all of them together: docs/theory/contacts.md.
namespace clutchwork {

/// Rate of a direction at the present speeds.
template <class T>
T rate_of(const Workspace<T>& ws, int d) {
  const System& sys = ws.sys;
  const bool element = d < sys.elements;
  const std::int64_t k = element ? d : d - sys.elements;
  const double* row = (element ? sys.element_rate : sys.contact_rate) + k * sys.speeds;
  const double* given = (element ? sys.element_rate_prescribed : sys.contact_rate_prescribed) + k * sys.prescribed;
  T r = T(0);
  for (int i = 0; i < sys.speeds; ++i) r += T(row[i]) * ws.v[i];
  for (int p = 0; p < sys.prescribed; ++p) r += T(given[p]) * ws.prescribed[p];
  return r;
}

/// Share of prescribed speed p in the rate of a direction.
template <class T>
T prescribed_share(const Workspace<T>& ws, int d, int p) {
  const System& sys = ws.sys;
  if (d < sys.elements) return T(sys.element_rate_prescribed[d * sys.prescribed + p]);
  return T(sys.contact_rate_prescribed[(d - sys.elements) * sys.prescribed + p]);
}

/// The branch of an element, or of a contact that slips with the given sign.
template <class T>
Branch<T> make_branch(const Workspace<T>& ws, int d, int sign) {
  const System& sys = ws.sys;
  Branch<T> b{};
  b.direction = d;
  b.sign = sign;
  b.piece = ws.piece[d];
  b.law_params = nullptr;
  if (d < sys.elements) {
    b.inputs = element_inputs(sys.element_kind[d]);
    b.kind = sys.element_kind[d];
    b.law = -1;
    b.params = ws.params + sys.element_param[d];
    b.state = sys.element_state[d];
    b.input = ws.u + sys.element_input[d];
    b.input_slope = ws.du + sys.element_input[d];
  } else {
    const int c = d - int(sys.elements);
    b.kind = sys.contact_kind[c];
    b.law = sys.contact_law[c];
    b.params = ws.params + sys.contact_param[c];
    b.law_params = ws.params + sys.contact_law_param[c];
    b.state = sys.contact_state[c];
    b.input = ws.u + sys.contact_input[c];
    b.input_slope = ws.du + sys.contact_input[c];
    b.inputs = contact_inputs(b.kind);
    b.law_inputs = law_inputs_of(b.law);
    b.law_input = ws.u + sys.contact_law_input[c];
    b.law_input_slope = ws.du + sys.contact_law_input[c];
    b.shaped = is_shaped(b.kind);
    b.pressed = ws.pressed[c] != 0;
    b.compliant = ws.compliant[c] != 0;
    if (b.compliant) b.sign = forward;
  }
  b.states = states_of(b.kind, b.law, b.law_params);
  return b;
}

/// Load of a contact now, negative included.
template <class T>
T load_of(const Workspace<T>& ws, int c) {
  const System& sys = ws.sys;
  if (ws.fault[c] == cannot_transmit) return T(-1);
  return contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], ws.u + sys.contact_input[c], sys.points);
}

/// Static torque of a contact now that resists slip in a direction [N m].
template <class T>
T static_torque(const Workspace<T>& ws, int c, int direction) {
  return ws.fault[c] == cannot_transmit ? T(0)
                                        : contact_limit(ws.sys, c, ws.params, ws.u + ws.sys.contact_input[c],
                                                        ws.u + ws.sys.contact_law_input[c], direction);
}

/// What a contact can hold now against slip in a direction [N m]: nothing where its law never sticks.
template <class T>
T capacity_of(const Workspace<T>& ws, int c, int direction) {
  if (ws.fault[c] == cannot_unlock) return T(infinity);
  return ws.compliant[c] ? T(0) : static_torque(ws, c, direction);
}

/// The capacity that counts while a contact holds a torque: a positive one resists backward slip.
template <class T>
T capacity_at(const Workspace<T>& ws, int c, T torque) {
  return capacity_of(ws, c, value(torque) > 0 && !contact_one_way(ws, c) ? backward : forward);
}

/// Above zero when a contact fails; below for one that cannot.
template <class T>
double fault_trigger(const Workspace<T>& ws, int c) {
  return visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (FaultyContact<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.contact_param[c]);
      return value(E::fault(p, At<T>{T(0), nullptr, ws.u + ws.sys.contact_input[c], 0, ws.sys.points}));
    }
    return -1.0;
  });
}

/// What a failure does to a contact, and how it is reported.
template <class T>
void fault_of(const Workspace<T>& ws, int c, int& kind, int& report) {
  kind = sound, report = 1;
  visit_contact(ws.sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    if constexpr (FaultyContact<E>) {
      const auto& p = *reinterpret_cast<const typename E::template Params<T>*>(ws.params + ws.sys.contact_param[c]);
      kind = E::fault_kind(p), report = E::fault_report(p);
    }
  });
}

/// Whether a contact may stick: its law can, or it is a freewheel.
template <class T>
bool may_stick(const Workspace<T>& ws, int c) {
  return !ws.compliant[c] || contact_one_way(ws, c) || ws.fault[c] == cannot_unlock;
}

/// Time derivative of the load of a contact.
template <class T>
T load_slope(const Workspace<T>& ws, int c) {
  const System& sys = ws.sys;
  return visit_contact(sys.contact_kind[c], [&](auto tag) {
    using E = typename decltype(tag)::type;
    Dual<T, 1> input[E::inputs > 0 ? E::inputs : 1];
    for (int i = 0; i < E::inputs; ++i) {
      const int ref = sys.contact_input[c] + i;
      input[i] = Dual<T, 1>(ws.u[ref]);
      input[i].d[0] = ws.du[ref] + ws.shared_slope[ref];
    }
    return contact_load(sys.contact_kind[c], ws.params + sys.contact_param[c], &input[0], sys.points).d[0];
  });
}

/// Whether the load of a contact bends over time, so that it may dip between two instants.
template <class T>
bool load_bends(const Workspace<T>& ws, int c) {
  const System& sys = ws.sys;
  const int first = sys.contact_input[c];
  for (int i = first; i < first + contact_inputs(sys.contact_kind[c]); ++i) {
    const std::int64_t ref = sys.input_refs[i];
    if (ref >= sys.inputs || !ws.signal[ref].linear) return true;
  }
  return false;
}

/// Whether a contact is pressed: a load now, or one that is about to rise from zero.
template <class T>
bool is_pressed(const Workspace<T>& ws, int c) {
  const double load = value(load_of(ws, c));
  return load != 0 ? load > 0 : value(load_slope(ws, c)) > 0;
}

/// Whether a contact can transmit: it is pressed, blocks one way, or cannot let go.
template <class T>
bool is_closed(const Workspace<T>& ws, int c) {
  return ws.pressed[c] || contact_one_way(ws, c) || (ws.fault[c] == cannot_unlock && ws.mode[c] == locked);
}

/// Static torque that a contact can use in a decision: one that rises from zero counts as it is a nanosecond later.
template <class T>
T usable_capacity(const Workspace<T>& ws, int c, int direction) {
  const System& sys = ws.sys;
  if (ws.compliant[c] || ws.fault[c] == cannot_unlock || value(load_of(ws, c)) > 0)
    return capacity_of(ws, c, direction);
  const T rising = larger(load_slope(ws, c), T(0)) * T(1e-9);
  return rising * law_hold(sys.contact_law[c], ws.params + sys.contact_law_param[c], ws.u + sys.contact_law_input[c],
                           sys.points);
}

/// Tolerance under which a slip counts as zero.
template <class T>
double slip_tolerance(const Workspace<T>& ws) {
  double largest = 0;
  for (int i = 0; i < ws.sys.speeds; ++i) {
    if (abs(value(ws.v[i])) > largest) largest = abs(value(ws.v[i]));
  }
  return 1e-10 * (1 + largest);
}

/// Mass-weighted acceleration without contacts that may stick: L^-1 (forces - M_p du/dt).
/// ws.effort: sum of the sizes of all contributions, what round-off of q is measured against.
template <class T>
void free_motion(Workspace<T>& ws, const int* candidate, T* q) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds);
  for (int i = 0; i < nv; ++i) q[i] = T(0);
  ws.effort = 0;
  auto add = [&](T size, int d) {
    T square = T(0);
    for (int e = ws.white_first[d]; e < ws.white_first[d + 1]; ++e) {
      q[ws.white_col[e]] += size * ws.white[e];
      square += ws.white[e] * ws.white[e];
    }
    ws.effort += abs(value(size)) * sqrt(value(square));
  };
  for (int p = 0; p < sys.prescribed; ++p) axpy(nv, -ws.prescribed_slope[p], ws.prescribed_momentum + p * nv, q);
  for (int d = 0; d < ws.n_directions; ++d) {
    const int c = d - int(sys.elements);
    int sign = 0;
    if (c >= 0 && !ws.loaded[c]) continue;
    if (c >= 0 && !ws.compliant[c]) {
      if (candidate[c]) continue;
      sign = ws.mode[c];
      if (sign != forward && sign != backward) continue;
    }
    const Branch<T> b = make_branch(ws, d, sign);
    T* rates = ws.scratch;
    add(branch_torque(ws, b, rate_of(ws, d), ws.state, rates), d);
  }
}

/// Acceleration of a slip for mass-weighted acceleration q.
template <class T>
T slip_acceleration(const Workspace<T>& ws, int c, const T* q) {
  const int d = int(ws.sys.elements) + c, nv = int(ws.sys.speeds);
  T a = dot(nv, ws.direction + d * nv, q);
  for (int p = 0; p < ws.sys.prescribed; ++p) a += prescribed_share(ws, d, p) * ws.prescribed_slope[p];
  return a;
}

/// Acceleration of a slip that the prescribed speeds give.
template <class T>
T slip_slope(const Workspace<T>& ws, int c) {
  T a = T(0);
  for (int p = 0; p < ws.sys.prescribed; ++p) {
    a += prescribed_share(ws, int(ws.sys.elements) + c, p) * ws.prescribed_slope[p];
  }
  return a;
}

/// Gather the problem of the contacts in list[0..n): matrix and views.
template <class T>
BoundedProblem<T> gather(Workspace<T>& ws, const int* list, int n) {
  const int nc = int(ws.sys.contacts);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) ws.qp_m[a * n + b] = ws.mobility[list[a] * nc + list[b]];
  }
  return {n,       ws.qp_m,      ws.qp_g,          ws.qp_lo, ws.qp_hi,  ws.qp_w,
          ws.qp_x, ws.qp_x + nc, ws.qp_x + 2 * nc, ws.qp_f,  ws.qp_fix, ws.qp_fix + nc};
}

/// A contact without inertia on either side of its slip: prescribed speeds alone decide it.
template <class T>
bool is_rigid(const Workspace<T>& ws, int c) {
  return value(ws.mobility[c * ws.sys.contacts + c]) == 0;
}

/// Let a contact slip; one that still moves within its own tolerance goes on the way it moves.
template <class T>
void release(Workspace<T>& ws, int c, int sign) {
  const int d = int(ws.sys.elements) + c;
  const double slip = value(rate_of(ws, d));
  const bool moving = abs(slip) > slip_tolerance(ws);
  ws.mode[c] = !moving ? sign : slip > 0 ? forward : backward;
  if (moving) ws.forced[c] = ws.mode[c];
  if (!ws.compliant[c]) ws.piece[d] = piece_of(ws, d, moving ? abs(slip) : 0.0);
}

/// A contact that was released and then, others having lost torque too, accelerates the other way (-1: none).
/// It may stick after all; only the first release of a contact is taken back.
template <class T>
int turned_back(const Workspace<T>& ws, const int* list, int n, const T* x, const int* released, T* q) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  for (int a = 0; a < n; ++a) axpy(nv, x[a], ws.direction + (ne + list[a]) * nv, q);
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (released[c] != 1) continue;
    const T* row = ws.direction + (ne + c) * nv;
    const double noise = 1e-12 * ws.effort * value(sqrt(dot(nv, row, row)));
    if (ws.mode[c] * value(slip_acceleration(ws, c, q)) < -noise) return c;
  }
  return -1;
}

/// How a decision ended: all contacts have their mode, none was found, a freewheel gives way first, or prescribed
/// speeds turn one backward.
enum class Settled { yes, no, gives_way, jams };

/// Give every contact at zero slip its torque or its direction of slip. `located`: the contact whose guard was hit, or
/// the freewheel that gives way.
template <class T>
Settled settle_contacts(Workspace<T>& ws, int& located) {
  const System& sys = ws.sys;
  const int nc = int(sys.contacts);
  const double tolerance = slip_tolerance(ws);
  int* candidate = ws.iscratch;
  int* list = ws.iscratch + nc;
  T* q = ws.scratch + ws.sys.states + 1;
  T* capacity = ws.qp_g + nc;
  int* released = ws.iscratch + 3 * nc;

  // who may stick
  for (int c = 0; c < nc; ++c) {
    const bool still = ws.mode[c] == locked && !is_rigid(ws, c);
    const double slip = still ? 0.0 : value(rate_of(ws, int(sys.elements) + c));
    released[c] = candidate[c] = 0;
    if (!may_stick(ws, c)) {
      ws.mode[c] = forward;
      continue;
    }
    const bool arrived = c == located && ws.cause != Cause::input;
    candidate[c] = ws.loaded[c] && (still || abs(slip) <= tolerance || (arrived && !is_rigid(ws, c)));
    if (!ws.loaded[c]) {
      if (abs(slip) > tolerance)
        ws.mode[c] = slip > 0 ? forward : backward;
      else if (ws.mode[c] == locked)
        ws.mode[c] = open;
    } else if (c == located && ws.cause == Cause::torque_limit && is_rigid(ws, c)) {
      // prescribed speeds have parted: there is no choice
      const double parting = slip != 0 ? slip : value(slip_slope(ws, c));
      if (parting < 0 && contact_one_way(ws, c)) {
        located = c;
        return Settled::jams;
      }
      candidate[c] = 0;
      ws.mode[c] = parting < 0 ? backward : forward;
      ws.forced[c] = ws.mode[c];
    } else if (candidate[c] && ws.forced[c] != 0) {
      candidate[c] = 0;
      ws.mode[c] = ws.forced[c];
    } else if (!candidate[c]) {
      ws.mode[c] = slip > 0 ? forward : backward;
    }
    if (!candidate[c] && ws.loaded[c] && !ws.compliant[c]) {
      const int d = int(sys.elements) + c;
      ws.piece[d] = piece_of(ws, d, abs(slip) > tolerance ? abs(slip) : 0.0);
    }
  }

  // rounds: those at a bound that accelerate start to slip with their kinetic torque
  for (int round = 0; round <= 4 * nc + 4; ++round) {
    int n = 0;
    for (int c = 0; c < nc; ++c) {
      if (candidate[c]) list[n++] = c;
    }
    free_motion(ws, candidate, q);
    BoundedProblem<T> p = gather(ws, list, n);
    for (int a = 0; a < n; ++a) {
      const int c = list[a];
      const T resists_forward = usable_capacity(ws, c, forward), resists_backward = usable_capacity(ws, c, backward);
      const bool one_way = contact_one_way(ws, c);
      p.gradient[a] = slip_acceleration(ws, c, q);
      p.lower[a] = -resists_forward;
      p.upper[a] = one_way ? freewheel_limit(ws, c) : resists_backward;
      capacity[a] = larger(resists_forward, p.upper[a]);
      p.x[a] = T(0);
      if (is_rigid(ws, c)) p.matrix[a * n + a] = T(1e-300);
    }
    capacity_weights(p, capacity);
    for (int a = 0; a < n; ++a) {
      if (is_rigid(ws, list[a])) p.lower[a] = p.upper[a] = T(0);
    }
    if (!solve(p)) return Settled::no;

    // of the bound torques that cannot hold, the one that gives way most starts to slip
    int first = -1;
    double most = 0;
    for (int a = 0; a < n; ++a) {
      const int c = list[a];
      ws.mode[c] = locked;
      const double mobility = value(sqrt(p.matrix[a * n + a]));
      double scale = abs(value(p.gradient[a]));
      for (int b = 0; b < n; ++b) scale = larger(scale, abs(value(p.matrix[a * n + b] * p.x[b])));
      const double acceleration = value(p.slope[a]), size = abs(acceleration) / mobility;
      // between prescribed speeds only what leaves zero within a microsecond is a departure; for one that has just come
      // to rest, what leaves it within a millisecond
      const bool arrived = c == located && ws.cause == Cause::slip_zero;
      const double round_off = larger(1e-10 * scale, 1e-12 * ws.effort * mobility);
      const double small = is_rigid(ws, c) ? 1e6 * tolerance : arrived ? larger(round_off, 1e3 * tolerance) : round_off;
      const bool noise = abs(acceleration) <= small;
      if (p.bound[a] == 0 || noise) continue;
      if (contact_one_way(ws, c) && acceleration < 0) {
        located = c;
        return is_rigid(ws, c) ? Settled::jams : Settled::gives_way;
      }
      if (size > most) first = a, most = size;
    }
    if (first >= 0) {
      const int c = list[first];
      release(ws, c, value(p.slope[first]) > 0 ? forward : backward);
      candidate[c] = 0;
      released[c] = released[c] == 0 ? 1 : 2;
      continue;
    }

    for (int a = 0; a < n; ++a) {
      ws.torque[sys.elements + list[a]] = p.x[a];
      // no torque holds what prescribed speeds turn against freewheels alone
      const double left = abs(value(p.slope[a])), most = 1e6 * tolerance + 1e-6 * abs(value(p.gradient[a]));
      if (p.bound[a] != 0 || is_rigid(ws, list[a]) || !(left > most)) continue;
      located = list[a];
      return Settled::jams;
    }
    const int back = turned_back(ws, list, n, p.x, released, q);
    if (back < 0) return Settled::yes;
    released[back] = -1;
    candidate[back] = 1;
  }
  return Settled::no;
}

/// Heat of an impulse goes where the heat of its direction goes.
template <class T>
void take_heat(Workspace<T>& ws, int direction, T heat) {
  const System& sys = ws.sys;
  T* shared = ws.state + sys.states - sys.shared;
  for (int h = 0; h < sys.heats; ++h) {
    if (sys.heat_direction[h] == direction) shared[sys.heat_to[h]] += T(sys.heat_share[h]) * heat;
  }
}

/// Apply the impulses of a solved problem over speeds: new speeds, and the work of each contact.
template <class T>
void apply_impulses(Workspace<T>& ws, const BoundedProblem<T>& p, const int* list) {
  const int nv = int(ws.sys.speeds), ne = int(ws.sys.elements);
  T* x = ws.scratch;
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int a = 0; a < p.n; ++a) {
    axpy(nv, p.x[a], ws.direction + (ne + list[a]) * nv, x);
    // work of an impulse: impulse times mean slip
    const T work = p.x[a] * (p.gradient[a] + p.slope[a]) * T(0.5);
    ws.work[ne + list[a]] += work;
    take_heat(ws, ne + list[a], -work);
  }
  backward_solve(nv, ws.factor, nv, x);
  for (int i = 0; i < nv; ++i) ws.v[i] += x[i];
  // the sources behind prescribed speeds take their share
  for (int k = 0; k < ws.sys.prescribed; ++k) {
    T impulse = T(0);
    for (int i = 0; i < nv; ++i) impulse += T(ws.sys.mass_prescribed[i * ws.sys.prescribed + k]) * x[i];
    for (int a = 0; a < p.n; ++a) impulse -= p.x[a] * prescribed_share(ws, ne + list[a], k);
    ws.prescribed_work[k] += impulse * ws.prescribed[k];
  }
  // friction transmits no impulse: what was locked and is moved now slips
  for (int c = 0; c < ws.sys.contacts; ++c) {
    const double slip = value(rate_of(ws, ne + c));
    if (ws.mode[c] == locked && abs(slip) > slip_tolerance(ws)) ws.mode[c] = slip > 0 ? forward : backward;
  }
}

/// Contacts that an impulse must bring to rest, and all freewheels, which it must not turn backward.
template <class T, class Stops>
int impulse_contacts(const Workspace<T>& ws, Stops&& stops, int* list) {
  int n = 0;
  for (int c = 0; c < ws.sys.contacts; ++c) {
    if (is_rigid(ws, c)) continue;
    if (stops(c) || (contact_one_way(ws, c) && ws.loaded[c])) list[n++] = c;
  }
  return n;
}

/// The impulses that change the kinetic energy least: some contacts come to rest, no freewheel turns backward; those
/// that had to stop lock. docs/theory/contacts.md (15)
template <class T, class Stops>
bool least_impulses(Workspace<T>& ws, Stops&& stops) {
  const int nc = int(ws.sys.contacts), ne = int(ws.sys.elements);
  const double tolerance = slip_tolerance(ws);
  int* list = ws.iscratch;
  const int n = impulse_contacts(ws, stops, list);
  bool needed = false;
  for (int a = 0; a < n; ++a) {
    const double slip = value(rate_of(ws, ne + list[a]));
    needed = needed || slip < -tolerance || (stops(list[a]) && slip > tolerance);
  }
  if (!needed) return true;
  BoundedProblem<T> p = gather(ws, list, n);
  T* capacity = ws.qp_g + nc;
  for (int a = 0; a < n; ++a) {
    p.gradient[a] = rate_of(ws, ne + list[a]);
    p.lower[a] = stops(list[a]) ? T(-infinity) : T(0);
    p.upper[a] = capacity[a] = T(infinity);
    p.x[a] = T(0);
  }
  capacity_weights(p, capacity);
  if (!solve(p)) return false;
  apply_impulses(ws, p, list);
  for (int a = 0; a < n; ++a) {
    // a freewheel that an impulse has closed is locked, one that it has left behind overruns
    const bool stopped = abs(value(p.slope[a])) <= tolerance;
    if (stopped && (stops(list[a]) || value(p.x[a]) > 0)) ws.mode[list[a]] = locked;
  }
  return true;
}

/// Impulses at a decision: contacts declared locked, at the start, and freewheels that would run backward.
template <class T>
bool settle_impulses(Workspace<T>& ws, bool at_start) {
  return least_impulses(ws, [&](int c) { return at_start && ws.sys.contact_initial[c] == 1; });
}

/// Whether a contact has locked while it still slips within its own tolerance.
template <class T>
bool stops_short(const Workspace<T>& ws, int located) {
  return located >= 0 && ws.mode[located] == locked && ws.sys.contact_tolerance[located] > 0;
}

/// A contact that may lock below a slip of its own is stopped by an impulse; the others that are locked stay so, but
/// for freewheels, which transmit no impulse that pulls.
template <class T>
bool stop_within_tolerance(Workspace<T>& ws, int located) {
  return least_impulses(ws, [&](int c) { return ws.mode[c] == locked && (c == located || !contact_one_way(ws, c)); });
}

/// A jump of prescribed speeds: friction transmits no impulse, rigid parts follow.
template <class T>
void prescribed_jump(Workspace<T>& ws) {
  const System& sys = ws.sys;
  const int nv = int(sys.speeds), np = int(sys.prescribed);
  bool any = false;
  T* x = ws.scratch;
  for (int i = 0; i < nv; ++i) x[i] = T(0);
  for (int p = 0; p < np; ++p) {
    const T jump = ws.prescribed[p] - ws.prescribed_before[p];
    if (value(jump) == 0) continue;
    any = true;
    axpy(nv, -jump, ws.prescribed_momentum + p * nv, x);
  }
  if (!any) return;
  backward_solve(nv, ws.factor, nv, x);
  // impulse of each source: its column of inertia times the jumps of all node speeds
  for (int n = 0; n < sys.nodes; ++n) {
    T jump = T(0);
    for (int i = 0; i < nv; ++i) jump += T(sys.basis[n * nv + i]) * x[i];
    for (int p = 0; p < np; ++p) {
      jump += T(sys.basis_prescribed[n * np + p]) * (ws.prescribed[p] - ws.prescribed_before[p]);
    }
    for (int p = 0; p < np; ++p) {
      const T impulse = T(sys.basis_prescribed[n * np + p] * sys.inertia[n]) * jump;
      ws.prescribed_work[p] += impulse * (ws.prescribed[p] + ws.prescribed_before[p]) * T(0.5);
    }
  }
  for (int i = 0; i < nv; ++i) ws.v[i] += x[i];
  for (int c = 0; c < sys.contacts; ++c) {
    const double slip = value(rate_of(ws, int(sys.elements) + c));
    if (abs(slip) > slip_tolerance(ws)) ws.mode[c] = slip > 0 ? forward : backward;
  }
}

}  // namespace clutchwork
