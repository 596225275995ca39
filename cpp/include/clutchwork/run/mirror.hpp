#pragma once
#include <clutchwork/workspace.hpp>

#include <cstring>

/// The plain image of a run with derivatives, in which its steps are taken. docs/theory/gradients.md
namespace clutchwork {

/// An array of a workspace.
struct Laid {
  void* at;
  std::int64_t n;
  int size;  ///< of an entry
};

/// Lists the arrays of a part of a workspace, in order.
struct LaidList {
  static constexpr int room = 160;
  Laid list[room];
  int count = 0;

  template <class P>
  void take(P*& p, std::int64_t n) {
    if (count == room) __builtin_trap();
    list[count++] = {p, n, int(sizeof(P))};
  }
  template <class P>
  void scratch(P*& p, std::int64_t n) {
    take(p, n);
  }
  void keep(int*& p, std::int64_t n, std::int64_t, std::int64_t) { take(p, n); }
};

/// Numbers without their derivatives.
template <class T>
void take_values(const T* from, std::int64_t n, double* to) {
  for (std::int64_t i = 0; i < n; ++i) to[i] = value(from[i]);
}

/// Gives a part its own arrays back, whose places another part has overwritten, with the numbers of that one.
template <class T>
struct Reflector {
  const Workspace<T>& from;
  Workspace<double>& to;
  const LaidList &own, &other;
  bool filled;  ///< with the numbers too
  int i = 0;

  template <class P>
  void take(P*& p, std::int64_t n) {
    const Laid& source = other.list[i];
    p = static_cast<P*>(own.list[i++].at);
    if (!filled) return;
    n = smaller(n, source.n);
    if constexpr (std::is_same_v<P, double>) {
      if (source.size == int(sizeof(T)))
        take_values(static_cast<const T*>(source.at), n, p);
      else
        std::memcpy(p, source.at, std::size_t(n) * sizeof(P));
    } else if constexpr (std::is_same_v<P, SignalOf<double>>) {
      for (std::int64_t k = 0; k < n; ++k) p[k] = plain(static_cast<const SignalOf<T>*>(source.at)[k]);
    } else if constexpr (std::is_same_v<P, int> || std::is_same_v<P, LineGuard>) {
      std::memcpy(p, source.at, std::size_t(n) * sizeof(P));
    }
  }
  template <class P>
  void scratch(P*& p, std::int64_t n) {
    take(p, n);
  }
  void keep(int*& p, std::int64_t n, std::int64_t, std::int64_t) { take(p, n); }

  SignalOf<double> plain(const SignalOf<T>& s) const {
    SignalOf<double> made;
    made.segment = s.segment, made.start = value(s.start), made.knot = value(s.knot), made.held = value(s.held);
    made.varying = s.varying, made.linear = s.linear, made.idle = s.idle;
    made.given = s.given, made.set = s.set, made.fresh = s.fresh;
    if (s.coef == nullptr) return made;
    made.coef = s.set > 0 ? to.in.set_coef + (s.coef - from.in.set_coef)
                          : to.sys.segment_coef + (s.coef - from.sys.segment_coef);
    return made;
  }
};

/// One part of a workspace, with the numbers in its arrays where `filled`.
template <template <class> class Part, class T>
void reflect_part(const Workspace<T>& from, Workspace<double>& to, Part<T>& source, Part<double>& image, bool filled) {
  // a part is places of arrays and plain numbers
  static_assert(sizeof(Part<T>) == sizeof(Part<double>) && std::is_trivially_copyable_v<Part<T>>);
  const Sizes n(to.sys);
  LaidList own, other;
  Part<double>::lay_out(image, own, n), Part<T>::lay_out(source, other, n);
  std::memcpy(static_cast<void*>(&image), &source, sizeof(image));
  Reflector<T> back{from, to, own, other, filled};
  Part<double>::lay_out(image, back, n);
}

/// The guards, which are no template.
template <class T>
void reflect_guards(Workspace<T>& from, Workspace<double>& to) {
  const Sizes n(to.sys);
  LaidList own, other;
  Guards::lay_out(to.guard, own, n), Guards::lay_out(from.guard, other, n);
  to.guard = from.guard;
  Reflector<T> back{from, to, own, other, true};
  Guards::lay_out(to.guard, back, n);
}

/// The branches over the arrays of the image.
template <class T>
void reflect_branches(const Workspace<T>& from, Workspace<double>& to) {
  auto moved = [](const auto* at, const auto* base, auto* image) {
    return at == nullptr ? nullptr : image + (at - base);
  };
  for (int k = 0; k < from.n_rates; ++k) {
    const Branch<T>& b = from.branch[k];
    to.branch[k] = {moved(b.params, from.params, to.params),
                    moved(b.law_params, from.params, to.params),
                    moved(b.input, from.in.u, to.in.u),
                    moved(b.input_slope, from.in.du, to.in.du),
                    moved(b.law_input, from.in.u, to.in.u),
                    moved(b.law_input_slope, from.in.du, to.in.du),
                    b.inputs,
                    b.law_inputs,
                    b.kind,
                    b.law,
                    b.direction,
                    b.state,
                    b.states,
                    b.ways,
                    b.piece,
                    b.sign,
                    b.pressed,
                    b.compliant,
                    b.follows,
                    b.shaped};
  }
}

/// The run as it stands, without derivatives; `first`: with what stays the same over the run too.
template <class T>
void reflect(Workspace<T>& from, Workspace<double>& to, bool first) {
  const auto& sys = from.sys;
  const std::int64_t nd = from.n_directions;
  to.options = from.options, to.time = from.time, to.last_step = from.last_step;
  to.n_branches = from.n_branches, to.n_rates = from.n_rates;
  if (first) take_values(from.params, sys.n_params, to.params);
  take_values(from.v, sys.speeds, to.v), take_values(from.state, sys.states, to.state);
  take_values(from.work, nd, to.work);
  std::memcpy(to.piece, from.piece, std::size_t(nd) * sizeof(int));
  std::memcpy(to.heading, from.heading, std::size_t(nd) * sizeof(int));
  std::memcpy(to.branch_of, from.branch_of, std::size_t(nd) * sizeof(int));
  reflect_part<Signals>(from, to, from.in, to.in, true);
  to.in.prescribed = to.in.u + sys.n_input_refs, to.in.prescribed_slope = to.in.du + sys.n_input_refs;
  reflect_part<Contacts>(from, to, from.contact, to.contact, true);
  reflect_part<Held>(from, to, from.held, to.held, true);
  reflect_part<Loads>(from, to, from.loads, to.loads, true);
  reflect_part<Geometry>(from, to, from.geometry, to.geometry, first);
  reflect_part<Reduced>(from, to, from.reduced, to.reduced, true);
  reflect_part<SparseRows>(from, to, from.rows, to.rows, true);
  reflect_part<Jacobian>(from, to, from.jacobian, to.jacobian, true);
  reflect_part<Shared>(from, to, from.shared, to.shared, sys.shared > 0);
  reflect_part<Ratios>(from, to, from.ratios, to.ratios, sys.transmissions > 0);
  reflect_guards(from, to);
  reflect_branches(from, to);
  to.in.time = -infinity;
}

}  // namespace clutchwork
