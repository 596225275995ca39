#pragma once
#include <clutchwork/components/component.hpp>

#include <cstddef>
#include <cstdint>

/// Formulas of friction laws: instructions over registers, evaluated for any scalar. docs/theory/friction-laws.md
namespace clutchwork {

/// Room for the registers, which are set before they are read.
template <class S>
union Registers {
  S at[most_registers];
  Registers() {}
};

/// Inputs of every formula beside its slip.
template <class S>
struct Surroundings {
  const S &temperature, &pressure;
};

/// A power of what is not negative; the least base keeps it finite with its derivative.
template <class S>
CLUTCHWORK_INLINE S power_of(const S& base, const S& exponent) {
  return pow(larger(base, S(1e-12)), exponent);
}
/// A square root, without slope where nothing is under it.
template <class S>
CLUTCHWORK_INLINE S root_of(const S& x) {
  return choose(x > S(1e-24), [&] { return sqrt(x); }, [] { return S(0); });
}
/// -1, 0 or 1.
template <class S>
CLUTCHWORK_INLINE S sign_of(const S& x) {
  return select(x > S(0), S(1), select(x < S(0), S(-1), S(0)));
}
/// exp, which stays where it is far behind the zero of the slip: what a trial step meets there is finite.
template <class S>
CLUTCHWORK_INLINE S exp_behind(const S& x, const S& slip) {
  return exp(select(slip < S(0), smaller(x, S(20)), x));
}

/// The fall of a Stribeck curve.
template <class S>
CLUTCHWORK_INLINE S bell(const S& x) {
  return exp(-(x * x));
}

/// A register that is read: what fits a register of the processor is there at once.
template <class S>
using Operand = std::conditional_t<std::is_floating_point_v<S>, S, const S&>;

/// Functions that take far longer than to find them.
template <class S>
CLUTCHWORK_INLINE S function_of(Operation which, Operand<S> a, Operand<S> b) {
  switch (which) {
    case Operation::power:
      return power_of(a, b);
    case Operation::root:
      return root_of(a);
    case Operation::log:
      return log(a);
    case Operation::tanh:
      return tanh(a);
    case Operation::atan:
      return atan(a);
    case Operation::sin:
      return sin(a);
    case Operation::cos:
      return cos(a);
    default:
      __builtin_unreachable();
  }
}

/// What an instruction computes of the registers `a` and `b`; `word` says which instruction, `r` are all registers.
template <class S>
CLUTCHWORK_HOT S computed(std::size_t word, Operand<S> a, Operand<S> b, const S* r) {
  switch (Operation(word % words_per_operation)) {
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::add_product:
      return r[word / words_per_operation] + a * b;
    case Operation::subtract_product:
      return r[word / words_per_operation] - a * b;
    case Operation::add_quotient:
      return r[word / words_per_operation] + a / b;
    case Operation::subtract_quotient:
      return r[word / words_per_operation] - a / b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::negate:
      return -a;
    case Operation::size:
      return abs(a);
    case Operation::smaller:
      return smaller(a, b);
    case Operation::larger:
      return larger(a, b);
    case Operation::exp:
      return exp(a);
    case Operation::exp_behind:
      return exp_behind(a, b);
    case Operation::fade:
      return exp(-a);
    case Operation::fade_behind:
      return exp_behind(-a, b);
    case Operation::bell:
      return bell(a / b);
    case Operation::sign:
      return sign_of(a);
    case Operation::less:
      return select(a < b, S(1), S(0));
    case Operation::pick:
      return select(value(r[word / words_per_operation]) != 0, a, b);
    default:
      return function_of<S>(Operation(word % words_per_operation), a, b);
  }
}

/// The words of a formula in the pool of points, and the numbers that it names, which stand behind the parameters of
/// its law. A point of `head` has the registers of both coefficients and the instructions that the first one needs; the
/// next one how many numbers and constants there are, and the instructions that rates need.
template <class T, class G>
struct Program {
  const T* own;
  const G* code;
  const G* head;
  const T& words;  ///< constants and instructions

  template <class P>
  CLUTCHWORK_HOT Program(const P& p, const G* points)
      : own(reinterpret_cast<const T*>(&p + 1)),
        code(points + 3 * place(p.expression.first)),
        head(points + 3 * place(p.at_rest.first)),
        words(p.expression.count) {}

  CLUTCHWORK_HOT std::size_t coefficient() const { return place(head[0]); }
  CLUTCHWORK_HOT std::size_t at_rest() const { return place(head[1]); }
  CLUTCHWORK_HOT std::size_t for_coefficient() const { return place(head[2]); }
  CLUTCHWORK_HOT std::size_t for_rates() const { return place(head[5]); }
  CLUTCHWORK_HOT std::size_t for_all() const { return place(words) - place(head[4]); }

  /// Compute the first instructions; states that are not there are zero.
  template <class S>
  [[gnu::noinline]] void run(const At<S>& at, Surroundings<S> in, int states, std::size_t instructions, S* r) const {
    S* next = r;
    *next++ = at.rate, *next++ = in.temperature, *next++ = in.pressure;
    for (int i = 0; i < states; ++i) *next++ = at.state != nullptr ? at.state[i] : S(0);
    const T* number = own;
    for (std::size_t n = place(head[3]); n > 0; one_by_one(n)) *next++ = S(*number++);
    const G* i = code;
    for (std::size_t n = place(head[4]); n > 0; one_by_one(n), i += 3) *next++ = S(*i);
    for (; instructions > 0; --instructions, i += 3)
      *next++ = computed<S>(place(i[0]), r[place(i[1])], r[place(i[2])], r);
  }

 private:
  /// A word as a place, of the width of addresses.
  template <class N>
  static CLUTCHWORK_HOT std::size_t place(const N& word) {
    return std::size_t(std::int64_t(common(word)));
  }
  /// A loop over a few numbers goes on by one: prepared for many, it would take longer.
  static CLUTCHWORK_HOT void one_by_one(std::size_t& left) {
    asm("" : "+r"(left));
    --left;
  }
};

/// Whether a number is whole, from 0 to below n.
inline bool is_whole_below(double x, double n) { return x >= 0 && x < n && x == double(int(x)); }

/// Whether the words of a formula read and write registers that are there.
/// Parameters: room, numbers in the pool behind the parameters of the law; states of the law.
template <class P>
bool is_program(const P& p, const double* points, std::int64_t room, int states) {
  const double *head = points + 3 * int(p.at_rest.first), *code = points + 3 * int(p.expression.first);
  if (p.at_rest.count != 2 || !is_whole_below(head[3], double(room) + 1) ||
      !is_whole_below(head[4], p.expression.count + 1))
    return false;
  const int begin = 3 + states + int(head[3]) + int(head[4]), n = int(p.expression.count) - int(head[4]);
  const bool ordered = is_whole_below(head[2], n + 1) && is_whole_below(head[5], n + 1) && head[2] <= head[5];
  if (begin + n > most_registers || !ordered || !is_whole_below(head[0], begin + head[2]) ||
      !is_whole_below(head[1], begin + n))
    return false;
  for (int i = 0; i < n; ++i) {
    const double* word = code + 3 * (int(head[4]) + i);
    const int known = begin + i;
    if (!is_whole_below(word[0], double(words_per_operation) * known) || !is_whole_below(word[1], known)) return false;
    if (!is_whole_below(word[2], known) || int(word[0]) % words_per_operation >= operations) return false;
  }
  return true;
}

}  // namespace clutchwork
