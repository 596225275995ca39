// Every function of every component: dual numbers against plain ones and central differences.

#include <clutchwork/components/branch.hpp>
#include <clutchwork/components/pieces.hpp>
#include <initializer_list>

#include "check.hpp"

/// Every function of every registered component: dual numbers against plain ones and central differences.
using namespace clutchwork;

namespace {

// arguments of a function: rate, states, inputs, parameters
constexpr int most = 40;
using D = Dual<double, most>;
constexpr int longest = 6;

/// A pool of points: x rises by one; y goes up and down; enough for a map over two curves.
struct Points {
  static constexpr int count = 2 + longest * longest;
  double pool[3 * count];
  constexpr Points() : pool{} {
    constexpr double y[] = {1, 1.5, 1.3, 1.2, 1, 0.7, 0.8};
    for (int i = 0; i < count; ++i) {
      pool[3 * i] = i, pool[3 * i + 1] = y[i % 7], pool[3 * i + 2] = y[(i + 1) % 7] - y[i % 7];
    }
  }
};
constexpr Points pool;
constexpr const double* points = pool.pool;
// sizes of states: those of ElastoPlastic come to lie below the elastic limit, beyond it, and beyond the plastic one
constexpr double sizes[4][2] = {{0.1, 0.9}, {1, 3}, {11.9, 12.7}, {13, 20}};

/// What is put into the parameters of a component: plain numbers, words among several, curves.
struct Fields {
  int count = 0, words[most] = {};
  double start[most] = {};
  bool fixed[most] = {};

  /// `visit` calls its first argument with the place of each curve, its second with those of words and their number.
  template <class E, class Visit>
  static Fields of(Tag<E>, Visit&& visit) {
    using P = typename E::template Params<double>;
    static_assert(sizeof(P) < most * sizeof(double));
    Fields f;
    f.count = int(sizeof(P) / sizeof(double));
    for (int k = 0; k < f.count; ++k) f.start[k] = 1.35 + 0.3 * k;
    auto curve = [&](int k) {
      f.start[k] = 1, f.start[k + 1] = longest;
      f.fixed[k] = f.fixed[k + 1] = true;
    };
    auto word = [&](int k, int values) {
      f.words[k] = values, f.fixed[k] = true;
      // any number that says how many states there are: all of them
      if (values > 0) f.start[k] = 0;
    };
    visit(curve, word);
    P p{};
    // counts, whose derivatives nobody asks for
    if constexpr (requires { p.teeth; }) f.fixed[&p.teeth - reinterpret_cast<const double*>(&p)] = true;
    return f;
  }
  /// The next combination of words; false: all were there.
  bool next_words() {
    for (int k = 0; k < count; ++k) {
      if (words[k] == 0) continue;
      if ((start[k] += 1) < words[k]) return true;
      start[k] = 0;
    }
    return false;
  }
};

/// A vector function at x; arguments that are fixed are not differentiated. `lenient`: values may be infinite.
template <class F>
void differentiate(F&& f, const double* x, int n, int outputs, const bool* fixed, bool lenient) {
  D dual[most], r[most];
  // what a component leaves alone is zero
  for (D& x : r) x = D(0.0);
  double moved[most], plain[most] = {}, up[most] = {}, down[most] = {};
  for (int i = 0; i < n; ++i) dual[i] = D::variable(x[i], i), moved[i] = x[i];
  f(static_cast<const D*>(dual), r), f(x, plain);
  for (int o = 0; o < outputs; ++o) CHECK(plain[o] - plain[o] != 0 ? lenient : check::same_bits(r[o].v, plain[o]));
  for (int i = 0; i < n; ++i) {
    if (fixed[i]) continue;
    const double h = 1e-6 * (1 + abs(x[i]));
    moved[i] = x[i] + h, f(static_cast<const double*>(moved), up);
    moved[i] = x[i] - h, f(static_cast<const double*>(moved), down);
    moved[i] = x[i];
    for (int o = 0; o < outputs; ++o) {
      // a parameter of zero may divide: then only the value counts
      if (plain[o] - plain[o] != 0 || (lenient && r[o].d[i] - r[o].d[i] != 0)) continue;
      const double slope = (up[o] - down[o]) / (2 * h);
      CHECK_NEAR(r[o].d[i], slope, 1e-7 * (1 + abs(slope)) + 1e-9 * abs(plain[o]));
    }
  }
}

/// Pieces of a component on which it is smooth: `visit(piece)`.
template <class E, class P, class F>
void over_pieces(const P& p, check::Random& g, F&& visit) {
  if constexpr (Kinked<E>) {
    for (int piece = 0; piece <= E::edges(p); ++piece) visit(piece);
  } else if constexpr (SwitchingLaw<E> && !TorqueElement<E>) {
    int count = 1;
    if constexpr (Sized<E>) count = E::count(p);
    const int all = (1 << count) - 1;
    visit(0), visit(all);
    // elements that slide, and some that are on their way back
    if (count > 1) visit(g.below(all)), visit(g.below(all) | all << most_elements);
    if constexpr (requires { E::behind; }) {
      for (int piece = 2; piece <= E::behind; ++piece) visit(piece);
    }
  } else if constexpr (TorqueElement<E> && requires { E::behind; }) {
    for (int piece = 0; piece <= E::behind; ++piece) visit(piece);
  } else {
    visit(0);
  }
}

/// Rates that a component sees.
template <class E>
constexpr int rates_of = [] {
  if constexpr (requires { E::ways; }) return int(E::ways);
  return 1;
}();

/// Whether a component reads oil, whose density and viscosity are above zero.
template <class E>
constexpr bool reads_oil = requires { E::Input::density; };

/// Run `call(params, at, out)` over rates, states, pieces and parameter sets, one parameter at a time also zero.
template <class E, class F>
void over_arguments(F&& call, Fields fields, int inputs, int states, int outputs) {
  using P = typename E::template Params<double>;
  // of several ways all rates come first
  const int np = fields.count, ways = rates_of<E>, n = ways + states + inputs + np;
  check::Random g{17};
  double x[most] = {};
  auto compare = [&](int zero) {
    bool fixed[most] = {};
    for (int k = 0; k < np; ++k) {
      x[n - np + k] = k == zero ? 0.0 : fields.start[k];
      fixed[n - np + k] = fields.fixed[k] || k == zero;
    }
    over_pieces<E>(*reinterpret_cast<const P*>(x + n - np), g, [&](int piece) {
      auto f = [&](const auto* v, auto* out) {
        using S = std::remove_cvref_t<decltype(*v)>;
        const auto& p = *reinterpret_cast<const typename E::template Params<S>*>(v + n - np);
        call(p, At<S>{v[0], v + ways, v + ways + states, piece, points, v}, out);
      };
      differentiate(f, x, n, outputs, fixed, zero >= 0);
    });
  };
  do {
    for (double rate : {-60.0, -3.1, -0.4, 0.7, 2.9, 60.0}) {
      for (int size = 0; size < (states > 0 ? 4 : 1); ++size) {
        x[0] = rate;
        for (int i = 1; i < ways; ++i) x[i] = (g.below(2) * 2 - 1) * g.between(1, 90);
        for (int i = ways; i < ways + states; ++i)
          x[i] = (g.below(2) * 2 - 1) * g.between(sizes[size][0], sizes[size][1]);
        for (int i = ways + states; i < ways + states + inputs; ++i)
          x[i] = g.between(reads_oil<E> ? 0.1 : -2, longest + 2);
        compare(-1);
        for (int zero = 0; zero < np && size == 0; ++zero) {
          if (!fields.fixed[zero]) compare(zero);
        }
      }
    }
  } while (fields.next_words());
}

/// What says that it is linear has the same slopes everywhere, whatever its inputs are, and no pieces.
template <class E>
void is_a_line(const Fields& fields) {
  static_assert(E::ways == 1 && E::states <= 1 && !Kinked<E> && !SwitchingLaw<E>);
  using S = Dual<double, 2>;
  const auto& p = *reinterpret_cast<const typename E::template Params<double>*>(fields.start);
  check::Random g{23};
  S first[2] = {};
  for (int round = 0; round < 20; ++round) {
    S state[1] = {S::variable(g.between(-9, 9), 1)}, input[most_inputs], found[2] = {};
    for (S& x : input) x = S(g.between(-9, 9));
    const At<S> at{S::variable(round == 0 ? 0.0 : g.between(-90, 90), 0), state, input, 0, points};
    found[0] = E::torque(p, at), E::state_rates(p, at, found + 1);
    for (int o = 0; o < 2 && round > 0; ++o) CHECK(found[o].d[0] == first[o].d[0] && found[o].d[1] == first[o].d[1]);
    // the rate of the state is a multiple of the rate, with nothing beside it
    CHECK(found[1].d[1] == 0 && found[1].v == found[1].d[0] * at.rate.v);
    for (int o = 0; o < 2; ++o) first[o] = found[o];
  }
}

void torque_kinds_all() {
  for (int kind = 0; kind < torque_kinds; ++kind) {
    visit_torque(kind, [kind](auto tag) {
      using E = typename decltype(tag)::type;
      const Fields fields = Fields::of(tag, [kind](auto&&... f) { visit_torque_fixed(kind, f...); });
      auto call = [](const auto& p, const auto& at, auto* out) {
        using S = std::remove_cvref_t<decltype(*out)>;
        if constexpr (TorqueElement<E>) out[0] = E::torque(p, at);
        if constexpr (CoupledElement<E>) E::torques(p, at, OwnTorques<S>(out));
        if constexpr (TransmissionElement<E>) out[0] = out[1] = E::ratio(p, at);
        // a state that is not in use has no rate
        for (int i = 0; i < E::states; ++i) out[E::ways + i] = S(0);
        E::state_rates(p, at, out + E::ways);
        if constexpr (HeatingElement<E>) out[E::ways + E::states] = E::heat(p, at);
      };
      over_arguments<E>(call, fields, E::inputs, E::states, E::ways + E::states + HeatingElement<E>);
      if constexpr (LinearElement<E>) is_a_line<E>(fields);
    });
  }
}

void contact_kinds_all() {
  for (int kind = 0; kind < contact_kinds; ++kind) {
    visit_contact(kind, [kind](auto tag) {
      using E = typename decltype(tag)::type;
      const Fields fields = Fields::of(tag, [kind](auto&&... f) { visit_contact_fixed(kind, f...); });
      auto call = [](const auto& p, const auto& at, auto* out) {
        using S = std::remove_cvref_t<decltype(*out)>;
        *out++ = E::load(p, at);
        for (int way : {-1, 1}) {
          // a coefficient; the rate is not used otherwise
          if constexpr (ShapedContact<E>) *out++ = E::gain(p, S(0.3) + at.rate * S(1e-3), way);
          if constexpr (LimitedContact<E>) *out++ = E::limit(p, at, S(0.3) + at.rate * S(1e-3), way);
        }
        if constexpr (YieldingContact<E>) *out++ = E::holding(p);
        if constexpr (FaultyContact<E>) *out++ = E::fault(p, at);
      };
      constexpr int outputs = 1 + 2 * ShapedContact<E> + 2 * LimitedContact<E> + YieldingContact<E> + FaultyContact<E>;
      over_arguments<E>(call, fields, E::inputs, E::states, outputs);
    });
  }
}

void flow_kinds_all() {
  for (int kind = 0; kind < flow_kinds; ++kind) {
    visit_flow(kind, [kind](auto tag) {
      using E = typename decltype(tag)::type;
      const Fields fields = Fields::of(tag, [kind](auto&&... f) { visit_flow_fixed(kind, f...); });
      auto call = [](const auto& p, const auto& at, auto* out) { out[0] = E::flow(p, at); };
      over_arguments<E>(call, fields, E::inputs, 0, 1);
    });
  }
}

void process_kinds_all() {
  for (int kind = 0; kind < process_kinds; ++kind) {
    visit_process(kind, [kind](auto tag) {
      using E = typename decltype(tag)::type;
      const Fields fields = Fields::of(tag, [kind](auto&&... f) { visit_process_fixed(kind, f...); });
      auto call = [](const auto& p, const auto& at, auto* out) { E::state_rates(p, at, out); };
      over_arguments<E>(call, fields, E::inputs, E::states, E::states);
    });
  }
}

/// All functions of a law: hold and slide of one that sticks; hold, coefficient, rates and margin of a compliant one.
template <class L, class P, class S>
int law_values(const P& p, const At<S>& at, S* out) {
  int n = 0;
  out[n++] = L::hold(p, at);
  if constexpr (StickingLaw<L>) {
    out[n++] = L::slide(p, at);
  } else {
    out[n++] = L::coefficient(p, at);
    if constexpr (SwitchingLaw<L>) {
      int who = turned;
      out[n++] = L::margin(p, at, who);
    }
    if constexpr (L::states > 0) L::state_rates(p, at, out + n);
    n += L::states;
  }
  return n;
}

/// States that a law has in use with the parameters of the test.
template <class L>
int states_in_use(const Fields& fields) {
  using P = typename L::template Params<double>;
  if constexpr (Sized<L>) return L::count(*reinterpret_cast<const P*>(fields.start));
  return L::states;
}

/// Whether the equations of a law are words of the model: test_formula.cpp.
bool is_written(int law) {
  return visit_law(law, [](auto tag) { return ProgrammedLaw<typename decltype(tag)::type>; });
}

void law_kinds_all() {
  for (int kind = 0; kind < law_kinds; ++kind) {
    if (is_written(kind)) continue;
    visit_law(kind, [kind](auto tag) {
      using L = typename decltype(tag)::type;
      const Fields fields = Fields::of(tag, [kind](auto&&... f) { visit_law_fixed(kind, f...); });
      auto call = [](const auto& p, const auto& at, auto* out) { law_values<L>(p, at, out); };
      const int states = states_in_use<L>(fields);
      const int outputs = 2 + states + (CompliantLaw<L> && SwitchingLaw<L>);
      over_arguments<L>(call, fields, L::inputs, states, outputs);
    });
  }
}

/// Parameters with which a law switches: bristles of Dahl are full within a finite slip with an exponent below 1 alone.
template <class L>
Fields switching(Fields fields) {
  using P = typename L::template Params<double>;
  if constexpr (std::is_same_v<L, laws::Dahl>) reinterpret_cast<P*>(fields.start)->exponent = 0.6;
  return fields;
}

/// From the edge of a piece, found by loading along the slip, a law comes into a piece whose edge it is not beyond.
template <class L>
void crosses(Fields fields) {
  // bristles of Dahl that are as good as full are full from there on; elements stay where they are
  constexpr double moved = std::is_same_v<L, laws::Dahl> ? 1.01e-10 : 1e-13;
  using P = typename L::template Params<double>;
  const int n = states_in_use<L>(fields);
  check::Random g{29};
  int found = 0;
  do {
    const P& p = *reinterpret_cast<const P*>(fields.start);
    for (int round = 0; round < 40; ++round) {
      double ray[most], state[most];
      int who = turned;
      double input[most_inputs];
      for (double& x : input) x = g.between(0.5, 2);
      At<double> at{g.between(-2, 2), state, input, 0, points};
      for (int i = 0; i < n; ++i) ray[i] = at.rate < 0 ? -g.unit() : g.unit();
      auto margin = [&](double length) {
        for (int i = 0; i < n; ++i) state[i] = length * ray[i];
        return L::margin(p, at, who);
      };
      double low = 0, high = 100;
      if (margin(high) > 0) continue;
      ++found;
      while (high - low > 1e-15 * high) {
        const double middle = 0.5 * (low + high);
        (margin(middle) > 0 ? low : high) = middle;
      }
      margin(high);
      if (!CHECK(who >= 0 && who < n)) continue;
      const double before = state[who];
      at.piece = L::cross(p, at, who, state);
      CHECK(at.piece == 1 << who);
      CHECK_NEAR(state[who], before, moved * abs(before));
      int next = turned;
      CHECK(L::margin(p, at, next) >= -1e-13);
      CHECK(L::turns(p, at.piece));
      at.rate = -at.rate, at.piece = L::cross(p, at, turned, state);
      CHECK(at.piece == 0);
      CHECK(L::margin(p, at, next) >= -1e-13);
    }
  } while (fields.next_words());
  CHECK(found > 20);
}

void switching_laws() {
  for (int kind = 0; kind < law_kinds; ++kind) {
    visit_law(kind, [kind](auto tag) {
      using L = typename decltype(tag)::type;
      Branch<double> b{};
      b.law = kind, b.ways = 1;
      CHECK(is_switching(b) == SwitchingLaw<L>);
      CHECK(is_compliant_law(kind) == CompliantLaw<L>);
      if constexpr (SwitchingLaw<L> && CompliantLaw<L>)
        crosses<L>(switching<L>(Fields::of(tag, [kind](auto&&... f) { visit_law_fixed(kind, f...); })));
    });
  }
}

/// A branch and all that it looks at.
struct Probe {
  Workspace<double> ws;
  // parameters of the component, then those of its law
  double params[2 * most] = {}, *const law = params + most, state[most], rates[most], moved_rates[most];
  // inputs of the component, then those of its law
  double input[2 * most_inputs], slope[2 * most_inputs], by_input[2 * most_inputs];
  double f_state[most], g_rate[most], g_time[most], g_state[most * most];
  std::int32_t zero = 0, law_at = most, law_input = most_inputs, contact_kind = 0, contact_law = 0;
  Branch<double> b{};

  Probe(int kind, check::Random& g) {
    b.params = params, b.law_params = law, b.kind = kind, b.law = -1;
    b.input = input, b.law_input = input + most_inputs, b.input_slope = slope, b.law_input_slope = slope + most_inputs;
    for (int i = 0; i < 2 * most_inputs; ++i) input[i] = g.between(0.5, 2), slope[i] = g.between(-1, 1);
    for (int i = 0; i < most; ++i) state[i] = g.between(-1, 1);
    const int contact = kind - torque_kinds;
    if (contact < 0) {
      visit_torque(kind, [&](auto tag) { fill(tag, params, [&](auto&&... f) { visit_torque_fixed(kind, f...); }); });
      b.inputs = element_inputs(kind);
    } else {
      b.kind = contact / law_kinds, b.law = contact % law_kinds;
      visit_contact(b.kind,
                    [&](auto tag) { fill(tag, params, [&](auto&&... f) { visit_contact_fixed(b.kind, f...); }); });
      visit_law(b.law, [&](auto tag) { fill(tag, law, [&](auto&&... f) { visit_law_fixed(b.law, f...); }); });
      b.compliant = is_compliant_law(b.law);
      b.sign = b.compliant || kind % 2 == 0 ? 1 : -1, b.pressed = true;
      b.inputs = contact_inputs(b.kind), b.law_inputs = law_inputs_of(b.law), b.shaped = is_shaped(b.kind);
    }
    // a driveline of this contact alone
    ws.sys.points = points, ws.params = params, ws.in.u = input;
    ws.sys.contact_param = ws.sys.contact_input = &zero, ws.sys.contact_law_input = &law_input;
    ws.sys.contact_kind = &contact_kind, ws.sys.contact_law = &contact_law, ws.sys.contact_law_param = &law_at;
    contact_kind = b.kind, contact_law = b.law;
    b.states = states_of<double>(b.kind, b.law, b.law < 0 ? params : law);
  }
  template <class E, class Visit>
  void fill(Tag<E> tag, double* out, Visit&& visit) {
    const Fields fields = Fields::of(tag, visit);
    for (int k = 0; k < fields.count; ++k) out[k] = fields.start[k];
  }
  double torque(double rate) { return branch_torque(ws, b, rate, state, moved_rates); }

  void compare(double rate) {
    const double turn = 0.3, h = 1e-6;
    const Partial<double> p = branch_partial(ws, b, rate, turn, state, rates, {f_state, g_rate, g_time, g_state});
    CHECK(check::same_bits(torque(rate), p.torque));
    for (int i = 0; i < b.states; ++i) CHECK(check::same_bits(moved_rates[i], rates[i]));
    // central differences along `move`, which returns the rate: of the torque against `by`, of state rates against `g`
    auto compare_along = [&](auto&& move, double by, const double* g, int stride) {
      double ahead[most];
      const double up = torque(move(h));
      for (int i = 0; i < b.states; ++i) ahead[i] = moved_rates[i];
      const double down = torque(move(-h));
      CHECK_NEAR(by, (up - down) / (2 * h), 1e-8 * (1 + abs(by)));
      for (int i = 0; i < b.states; ++i) {
        CHECK_NEAR(g[i * stride], (ahead[i] - moved_rates[i]) / (2 * h), 1e-8 * (1 + abs(g[i * stride])));
      }
      move(0);
    };
    compare_along([&](double dx) { return rate + dx; }, p.by_rate, g_rate, 1);
    for (int j = 0; j < b.states; ++j) {
      const double keep = state[j];
      compare_along([&](double dx) { return state[j] = keep + dx, rate; }, f_state[j], g_state + j, b.states);
    }
    double keep[2 * most_inputs];
    for (int i = 0; i < 2 * most_inputs; ++i) keep[i] = input[i];
    auto in_time = [&](double dt) {
      for (int i = 0; i < 2 * most_inputs; ++i) input[i] = keep[i] + dt * slope[i];
      return rate + dt * turn;
    };
    compare_along(in_time, p.by_time, g_time, 1);
    compare_inputs(rate), compare_heat(rate, p);
  }
  /// What shared states do to the torque.
  void compare_inputs(double rate) {
    const double h = 1e-6;
    branch_by_input(ws, b, rate, state, by_input);
    for (int i = 0; i < b.inputs + b.law_inputs; ++i) {
      double& x = i < b.inputs ? input[i] : input[most_inputs + i - b.inputs];
      const double keep = x;
      x = keep + h;
      const double up = torque(rate);
      x = keep - h;
      const double down = torque(rate);
      x = keep;
      CHECK_NEAR(by_input[i], (up - down) / (2 * h), 1e-8 * (1 + abs(by_input[i])));
    }
  }
  /// Heat of the branch and its derivative by the rate.
  void compare_heat(double rate, const Partial<double>& p) {
    const double h = 1e-6;
    Dual<double, 1> f(p.torque);
    f.d[0] = p.by_rate;
    const Dual<double, 1> heat = branch_heat(ws, b, rate, state, f);
    auto at = [&](double r) { return branch_heat(ws, b, r, state, Dual<double, 1>(torque(r))).v; };
    CHECK_NEAR(heat.d[0], (at(rate + h) - at(rate - h)) / (2 * h), 1e-8 * (1 + abs(heat.d[0])));
  }
};

/// The partial derivatives that the integrators use: by rate, by own states, by time through rate and inputs.
void branches() {
  check::Random g{23};
  int compliant = 0, with_states = 0;
  for (int kind = 0; kind < torque_kinds + contact_kinds * law_kinds; ++kind) {
    if (kind < torque_kinds ? ways_of(kind) > 1 : is_written((kind - torque_kinds) % law_kinds)) continue;
    Probe probe(kind, g);
    const bool sticks = kind >= torque_kinds && !probe.b.compliant;
    compliant += probe.b.compliant, with_states += probe.b.states > 0;
    probe.compare(0.8 * (probe.b.sign < 0 ? -1 : 1));
    if (!sticks) probe.compare(-0.6);
    if (is_switching(probe.b)) probe.b.piece = 1, probe.compare(0.7);
  }
  CHECK(compliant > 0 && with_states > 0);
}

/// A law that could have many states and has one.
void one_element() {
  check::Random g{31};
  for (int law = 0; law < law_kinds; ++law) {
    visit_law(law, [&](auto tag) {
      using L = typename decltype(tag)::type;
      if constexpr (Sized<L> && !ProgrammedLaw<L>) {
        Probe probe(torque_kinds + law, g);
        visit_law_curves(law, [&](int k) { probe.law[k + 1] = 1; });
        probe.b.states = states_of<double>(probe.b.kind, law, probe.law);
        CHECK(probe.b.states == 1);
        probe.compare(0.8), probe.compare(-0.6);
      }
    });
  }
}

}  // namespace

int test_registry() {
  torque_kinds_all();
  contact_kinds_all();
  flow_kinds_all();
  process_kinds_all();
  law_kinds_all();
  switching_laws();
  branches();
  one_element();
  return check::result();
}
