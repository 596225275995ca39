#pragma once
#include <clutchwork/components/bound.hpp>
#include <clutchwork/components/dual.hpp>
#include <clutchwork/declared.gen.hpp>

#include <concepts>
#include <cstdint>
#include <type_traits>

/// What an element or a friction law provides: parameters and pure functions of one rate, own states and inputs.
namespace clutchwork {

inline constexpr int most_inputs = 6;  ///< of one component

/// Whether a component computes with scalar T: all do with plain ones, those with `lanes` also with Lanes.
template <class E, class T>
inline constexpr bool computes_with = !has_lanes<T> || requires { requires E::lanes; };

/// Compile-time name of a component.
template <class E>
struct Tag {
  using type = E;
};

/// Parameter that is a piecewise linear function: a range of the pool of points.
template <class T>
struct Curve {
  T first;  ///< [1] number of the first point
  T count;  ///< [1] number of points
};

/// Parameter that is one of several words: the place of the word in its enum, which stands for it.
template <class T, class Words>
struct Word {
  T number;  ///< [1]
  CLUTCHWORK_HOT operator Words() const { return Words(int(common(number))); }
};

/// Own inputs, by the names of the declaration: `at.input[Input::...]`.
template <class S>
struct OwnInputs {
  const S* first;
  CLUTCHWORK_HOT OwnInputs(const S* inputs) : first(inputs) {}
  template <class Name>
  CLUTCHWORK_HOT const S& operator[](Name name) const {
    static_assert(std::is_enum_v<Name>, "an input is read by its name, as at.input[Input::...]");
    return first[int(name)];
  }
};

/// Rates of the ways of an element, by the names of the declaration: `at.rates[Way::...]`.
template <class S>
struct OwnRates {
  const S* first = nullptr;
  CLUTCHWORK_HOT OwnRates() = default;
  CLUTCHWORK_HOT OwnRates(const S* rates) : first(rates) {}
  template <class Name>
  CLUTCHWORK_HOT const S& operator[](Name name) const {
    static_assert(std::is_enum_v<Name>, "a rate is read by the name of its way, as at.rates[Way::...]");
    return first[int(name)];
  }
};

/// Torques along the ways of an element, by the names of the declaration: `torque[Way::...]`.
template <class S>
struct OwnTorques {
  S* first;
  CLUTCHWORK_HOT OwnTorques(S* torques) : first(torques) {}
  template <class Name>
  CLUTCHWORK_HOT S& operator[](Name name) const {
    static_assert(std::is_enum_v<Name>, "a torque is set by the name of its way, as torque[Way::...]");
    return first[int(name)];
  }
};

/// Where a component is evaluated.
template <class S>
struct At {
  S rate;                  ///< [rad/s] rate of an element; slip of a contact in the direction in which it slips
  const S* state;          ///< own states
  OwnInputs<S> input;      ///< own inputs
  int piece;               ///< number of the smooth piece of the rate
  const Point<S>* points;  ///< pool of curves: x, y, slope to the next point
  OwnRates<S> rates{};     ///< of an element of several ways
};

/// Number of kinks inside a curve, where one linear piece follows another.
template <class T>
CLUTCHWORK_HOT int curve_edges(const Curve<T>& c) {
  const int n = int(common(c.count));
  return n > 2 ? n - 2 : 0;
}

/// Abscissa of kink number i.
template <class T, class G>
CLUTCHWORK_HOT G curve_edge(const Curve<T>& c, const G* points, int i) {
  return points[3 * (int(common(c.first)) + i + 1)];
}

/// Value of a curve on one of its pieces, continued linearly beyond it.
template <class T, class S>
CLUTCHWORK_HOT S curve_value(const Curve<T>& c, const Point<S>* points, S x, int piece) {
  const Point<S>* p = points + 3 * (int(common(c.first)) + piece);
  return (x - S(p[0])) * S(p[2]) + S(p[1]);
}

/// Torque as a function of rate, states and inputs, plus the rates of the states.
template <class E>
concept TorqueElement = requires(const typename E::template Params<double>& p, const At<double>& at, double* rates) {
  { E::torque(p, at) } -> std::same_as<double>;
  { E::state_rates(p, at, rates) } -> std::same_as<void>;
  { E::inputs } -> std::convertible_to<int>;
};

/// Torque element whose torque and the rate of the one state that it may have are linear in its rate and that state,
/// with slopes that inputs do not change; the rate of the state follows from the rate alone.
template <class E>
concept LinearElement = TorqueElement<E> && requires { requires E::linear; };

/// Element of two ways whose rates a ratio of its states and inputs ties together: rate 1 = ratio rate 2.
template <class E>
concept TransmissionElement =
    requires(const typename E::template Params<double>& p, const At<double>& at, double* rates) {
      { E::ratio(p, at) } -> std::same_as<double>;
      { E::state_rates(p, at, rates) } -> std::same_as<void>;
      requires E::ways == 2;
    };

/// The same for an element of several ways: a torque along each, zero along one that it only watches.
template <class E>
concept CoupledElement = requires(const typename E::template Params<double>& p, const At<double>& at, double* rates) {
  { E::torques(p, at, OwnTorques<double>(rates)) } -> std::same_as<void>;
  { E::state_rates(p, at, rates) } -> std::same_as<void>;
  requires E::ways > 1;
};

/// Friction contact: the load that multiplies the coefficient of its law, and whether it is a freewheel.
template <class E>
concept ContactElement = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::load(p, at) } -> std::same_as<double>;
  { E::one_way } -> std::convertible_to<bool>;
  { E::inputs } -> std::convertible_to<int>;
};

/// Contact whose torque per load is a function of the coefficient and the direction of slip; else it is the
/// coefficient.
template <class E>
concept ShapedContact = requires(const typename E::template Params<double>& p) {
  { E::gain(p, 0.5, 1) } -> std::same_as<double>;
};

/// Contact with a static torque of its own: what resists slip in a direction, for the static coefficient `hold`.
template <class E>
concept LimitedContact = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::limit(p, at, 0.5, 1) } -> std::same_as<double>;
};

/// Contact whose capacity follows the torque of its own gear row: what holds against slip in a direction, over that
/// load; `at.rate` is the size of the slip. `steady`: neither slip nor inputs change it.
template <class E>
concept LoadedContact = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::bound(p, at, 1) } -> std::same_as<Bound<double>>;
  { E::steady(p) } -> std::same_as<bool>;
};

/// Freewheel that gives way at a torque.
template <class E>
concept YieldingContact = requires(const typename E::template Params<double>& p) {
  { E::holding(p) } -> std::same_as<double>;
};

/// Contact that exists where its position is at an end alone: side -1 its lower end, 1 its upper one, not finite: there
/// is none. Speeds return times the restitution, or not at all below the speed of rest.
template <class E>
concept StopContact = requires(const typename E::template Params<double>& p) {
  { E::end(p, 1) } -> std::same_as<double>;
  { E::restitution(p, 1) } -> std::same_as<double>;
  { E::rest_speed(p) } -> std::same_as<double>;
};

/// Contact that can fail: `fault` is above zero when it does, then for good.
template <class E>
concept FaultyContact = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::fault(p, at) } -> std::same_as<double>;
  { E::fault_kind(p) } -> std::same_as<choice::Fault>;
  { E::fault_report(p) } -> std::same_as<choice::Report>;
};
/// What has failed in a contact, as the number that a run keeps.
enum Fault : int {
  sound = int(choice::Fault::none),
  cannot_transmit = int(choice::Fault::cannot_transmit),
  cannot_unlock = int(choice::Fault::cannot_unlock)
};

/// Element that turns only a part of its work into heat.
template <class E>
concept HeatingElement = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::heat(p, at) } -> std::same_as<double>;
};

/// Flow between two shared states, whose values are its first two inputs.
template <class E>
concept FlowElement = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::flow(p, at) } -> std::same_as<double>;
  { E::inputs } -> std::convertible_to<int>;
};

/// Component that has shared states and nothing else.
template <class E>
concept ProcessElement = requires(const typename E::template Params<double>& p, const At<double>& at, double* rates) {
  { E::state_rates(p, at, rates) } -> std::same_as<void>;
  { E::states } -> std::convertible_to<int>;
  { E::inputs } -> std::convertible_to<int>;
};

/// Process, or flow, that changes between smooth pieces by its states and inputs: `margin` is positive inside
/// `at.piece` and tells who is closest to leaving; `cross` gives the next piece and may move states. A margin does not
/// look at heats and supplied powers.
template <class E>
concept SwitchingProcess =
    requires(const typename E::template Params<double>& p, const At<double>& at, double* state, int& who) {
      { E::margin(p, at, who) } -> std::same_as<double>;
      { E::cross(p, at, 0, state) } -> std::same_as<int>;
    };

/// Where a process is whose force jumps at a place: the states that are the place and what jumps there, the input that
/// is the speed, the piece before the place (the one behind it is the next), the place, and what jumps on either side
/// of it.
template <class T>
struct Corner {
  int moves, turns, speed, piece;
  T place, before, behind;
};

/// Process of pieces with corners at which what it follows may come to rest. Two states, a place and what jumps there.
template <class E>
concept CorneredProcess =
    requires(const typename E::template Params<double>& p, const At<double>& at, Corner<double>& found) {
      { E::corner(p, at, found) } -> std::same_as<bool>;
    };

/// Process whose inputs draw: `flow[i]` is what it takes from the process that gives input i. A flow looks at states,
/// signals and rates alone.
template <class E>
concept DrawingProcess = requires(const typename E::template Params<double>& p, const At<double>& at, double* flow) {
  { E::drawn(p, at, flow) } -> std::same_as<void>;
};

/// Law that sticks exactly: kinetic coefficient over slip (slip >= 0, continued smoothly below), static at rest.
template <class L>
concept StickingLaw = requires(const typename L::template Params<double>& p, const At<double>& at) {
  { L::slide(p, at) } -> std::same_as<double>;
  { L::hold(p, at) } -> std::same_as<double>;
};

/// Law that never sticks: coefficient over signed slip and own states, which are coefficients themselves.
template <class L>
concept CompliantLaw = requires(const typename L::template Params<double>& p, const At<double>& at) {
  { L::coefficient(p, at) } -> std::same_as<double>;
  { L::hold(p, at) } -> std::same_as<double>;
};

template <class L>
concept FrictionLaw = (StickingLaw<L> != CompliantLaw<L>) && requires {
  { L::states } -> std::convertible_to<int>;
  { L::inputs } -> std::convertible_to<int>;
};

/// Law that jumps with the sign of the slip and has no state of rest.
template <class L>
concept ChatteringLaw = requires {
  { L::chatters } -> std::convertible_to<bool>;
};

/// Law, or torque element, that changes between smooth pieces by its own states or inputs; a law that sticks settles on
/// one wherever it starts to slip. `margin` is positive inside `at.piece` and tells who is closest to leaving; `cross`
/// gives the next piece and may move states (who = turned: the slip changed sign, watched where `turns`, or the motion
/// that was decided has just entered `at.piece` at a kink).
template <class L>
concept SwitchingLaw =
    requires(const typename L::template Params<double>& p, const At<double>& at, double* state, int& who) {
      { L::margin(p, at, who) } -> std::same_as<double>;
      { L::cross(p, at, 0, state) } -> std::same_as<int>;
      { L::turns(p, 0) } -> std::same_as<bool>;
    };
inline constexpr int turned = -1;

/// Who a guard is asked for that shall see those alone that rest on their borders.
inline constexpr int resting = -2;

/// Switching torque element that lets stored energy go where it leaves a piece: how much of it becomes heat at once
/// [J].
template <class E>
concept Freeing = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::freed(p, at, 0) } -> std::same_as<double>;
};

/// Switching law or torque element whose piece follows from where it is, and from the present one: after a jump too.
template <class E>
concept Settling = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::settle(p, at) } -> std::same_as<int>;
};

/// Switching law that may leave a piece on the way back: whether a state that has just crossed goes on.
template <class L>
concept RunningOn = requires {
  { L::runs_on(0, 0) } -> std::same_as<bool>;
};

/// Law that is not known everywhere: `outside` is below zero where a table is left; `seen` is what left it.
template <class L>
concept BoundedLaw = requires(const typename L::template Params<double>& p, const At<double>& at, double& seen) {
  { L::outside(p, at, seen) } -> std::same_as<double>;
};

/// Law whose equations are words of the model: whether they read what is there, of so many numbers behind its
/// parameters.
template <class L>
concept ProgrammedLaw = requires(const typename L::template Params<double>& p, const double* points) {
  { L::is_sound(p, points, std::int64_t(0)) } -> std::same_as<bool>;
};

/// Law or element whose tables have sizes that must belong together.
template <class L>
concept FittedLaw = requires(const typename L::template Params<double>& p) {
  { L::fits(p) } -> std::same_as<bool>;
};

/// Law or torque element whose number of states depends on parameters that stay fixed; `states` is the most.
template <class C>
concept Sized = requires(const typename C::template Params<double>& p) {
  { C::count(p) } -> std::same_as<int>;
};

/// Switching torque element that oscillates by itself: the rate of that [1/s], as no error estimate may feel it.
template <class E>
concept Paced = requires(const typename E::template Params<double>& p, const At<double>& at) {
  { E::pace(p, at) } -> std::same_as<double>;
};

/// A component whose function of the rate has kinks. Where it switches too, its pieces are numbered by the interval
/// between kinks first: interval + (edges + 1) mode.
template <class E, class T = double>
concept Kinked = requires(const typename E::template Params<T>& p, const double* points) {
  { E::edges(p) } -> std::same_as<int>;
  { E::edge(p, points, 0) } -> std::same_as<double>;
};

}  // namespace clutchwork
