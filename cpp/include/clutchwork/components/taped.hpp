#pragma once
#include <clutchwork/components/dual.hpp>
#include <clutchwork/components/slopes.hpp>

#include <cstdint>

/// A number that notes how it came about, for derivatives of one result by all numbers of its model.
/// docs/theory/gradients.md (9)
namespace clutchwork {

// found without a call where the format of the program knows such places
#if defined(__ELF__)
#define CLUTCHWORK_NEAR __attribute__((tls_model("initial-exec")))
#else
#define CLUTCHWORK_NEAR
#endif

/// What numbers have come from: of each the two before it and its derivatives by them, in memory of the caller. Where
/// that is full the run has to stop.
class Tape {
 public:
  struct Node {
    std::int32_t first, second;
    double by_first, by_second;
  };

  Tape() = default;
  Tape(void* memory, std::int64_t bytes)
      : node_(static_cast<Node*>(memory)), room_(std::int32_t(smaller(bytes / std::int64_t(sizeof(Node)), most))) {}

  /// The number of a new result. One copy for all operations: the core has very many.
  [[gnu::noinline]] std::int32_t note(std::int32_t a, double by_a, std::int32_t b, double by_b) {
    if (n_ >= room_) return full_ = true, 0;
    node_[n_] = {a, b, by_a, by_b};
    return n_++;
  }
  /// The number of a weighted sum of n numbers: nodes one behind the other, each but the first with that before it.
  /// There are n + 1 numbers, of which an even count is used.
  [[gnu::noinline]] std::int32_t sum(int n, const std::int32_t* id, const double* by) {
    if (n_ + n / 2 >= room_) return full_ = true, 0;
    node_[n_++] = {id[0], id[1], by[0], by[1]};
    for (int j = 2; j < n; j += 2) node_[n_++] = {~id[j], id[j + 1], by[j], by[j + 1]};
    return n_ - 1;
  }
  /// Numbers that follow from others in their own way, of which `bytes` are kept; null: the tape is full. `first`: the
  /// first of them.
  void* block(std::int64_t bytes, int results, std::int32_t& first) {
    const auto nodes = std::int32_t((bytes + std::int64_t(sizeof(Node)) - 1) / std::int64_t(sizeof(Node)));
    first = 0;
    if (n_ + nodes + results + 1 >= room_) return full_ = true, nullptr;
    auto* kept = reinterpret_cast<Block*>(node_ + n_);
    *kept = {block_, n_ + 1 + nodes, results, {}};
    block_ = n_, first = kept->first, n_ = first + results;
    return kept + 1;
  }
  bool is_full() const { return full_; }
  std::int32_t size() const { return n_; }

  /// Derivatives of what has been seeded by all numbers, in place. `own`: of a block, from those of its results.
  template <class F>
  void back(double* adjoint, F&& own) const {
    std::int32_t end = n_;
    for (std::int32_t at = block_; at > 0;) {
      const auto* kept = reinterpret_cast<const Block*>(node_ + at);
      back(adjoint, end, kept->first + kept->results);
      own(kept + 1, adjoint + kept->first, adjoint);
      end = at, at = kept->before;
    }
    back(adjoint, end, 1);
  }

  /// The tape on which this thread writes, null: none.
  static CLUTCHWORK_HOT Tape*& current() { return at_work; }

 private:
  /// Before what is kept of a block, in place of a node.
  struct Block {
    std::int32_t before;  ///< the block before, 0: none
    std::int32_t first, results;
    std::int32_t unused[3];
  };
  static_assert(sizeof(Block) == sizeof(Node));

  void back(double* adjoint, std::int32_t end, std::int32_t first) const {
    for (std::int32_t i = end - 1; i >= first; --i) {
      double x = adjoint[i];
      if (x == 0) continue;
      // a sum goes on in the node before it; what a constant gets is not looked at
      for (;;) {
        const Node& node = node_[i];
        const bool goes_on = node.first < 0;
        adjoint[goes_on ? ~node.first : node.first] += x * node.by_first;
        if (node.second != 0) adjoint[node.second] += x * node.by_second;
        if (!goes_on) break;
        x += adjoint[--i];
      }
    }
  }

  static constexpr std::int64_t most = (1ll << 31) - 2;
  static inline thread_local constinit Tape* at_work CLUTCHWORK_NEAR = nullptr;
  Node* node_ = nullptr;
  std::int32_t room_ = 0, n_ = 1;  // number 0 stands for constants
  std::int32_t block_ = 0;         // the last one
  bool full_ = false;
};

struct TapedSum;

/// A value and its number on the tape, 0: a constant; and its derivative in one direction, by which steps are chosen.
struct Taped {
  double v = 0, probe = 0;
  std::int32_t id = 0;
  static constexpr int kept = 1, seen = 1, lanes = 2;
  using Widest = TapedSum;  ///< its derivatives alone

  Taped() = default;
  CLUTCHWORK_HOT Taped(double x) : v(x) {}

  /// f with derivatives by one number, and by two.
  static CLUTCHWORK_HOT Taped chain(const Taped& a, double f, double by_a) {
    Taped r(f);
    if (a.id == 0 || by_a == 0) return r;
    r.id = Tape::current()->note(a.id, by_a, 0, 0), r.probe = a.probe * by_a;
    return r;
  }
  static CLUTCHWORK_HOT Taped chain(const Taped& a, double by_a, const Taped& b, double by_b, double f) {
    Taped r(f);
    const std::int32_t first = by_a != 0 ? a.id : 0, second = by_b != 0 ? b.id : 0;
    if ((first | second) == 0) return r;
    r.id = Tape::current()->note(first, by_a, second, by_b);
    if (first != 0) r.probe += a.probe * by_a;
    if (second != 0) r.probe += b.probe * by_b;
    return r;
  }

  CLUTCHWORK_HOT Taped& operator+=(const Taped& b) { return *this = *this + b; }
  CLUTCHWORK_HOT Taped& operator-=(const Taped& b) { return *this = *this - b; }
  CLUTCHWORK_HOT Taped& operator*=(const Taped& b) { return *this = *this * b; }
  CLUTCHWORK_HOT Taped& operator/=(const Taped& b) { return *this = *this / b; }

  friend CLUTCHWORK_HOT Taped operator-(const Taped& a) { return chain(a, -a.v, -1); }
  // a sum with a constant zero is the other number
  friend CLUTCHWORK_HOT Taped operator+(const Taped& a, const Taped& b) {
    if (b.id == 0 && b.v == 0) return a;
    if (a.id == 0 && a.v == 0) return b;
    return chain(a, 1, b, 1, a.v + b.v);
  }
  friend CLUTCHWORK_HOT Taped operator-(const Taped& a, const Taped& b) {
    if (b.id == 0 && b.v == 0) return a;
    return chain(a, 1, b, -1, a.v - b.v);
  }
  friend CLUTCHWORK_HOT Taped operator*(const Taped& a, const Taped& b) { return chain(a, b.v, b, a.v, a.v * b.v); }
  friend CLUTCHWORK_HOT Taped operator/(const Taped& a, const Taped& b) {
    const double q = a.v / b.v, inverse = 1 / b.v;
    return chain(a, inverse, b, -q * inverse, q);
  }
  friend CLUTCHWORK_HOT Taped operator*(double a, const Taped& b) { return chain(b, a * b.v, a); }
  friend CLUTCHWORK_HOT Taped operator*(const Taped& a, double b) { return chain(a, a.v * b, b); }
  friend CLUTCHWORK_HOT Taped operator/(const Taped& a, double b) { return chain(a, a.v / b, 1 / b); }

  friend CLUTCHWORK_HOT bool operator<(const Taped& a, const Taped& b) { return a.v < b.v; }
  friend CLUTCHWORK_HOT bool operator>(const Taped& a, const Taped& b) { return a.v > b.v; }
  friend CLUTCHWORK_HOT bool operator<=(const Taped& a, const Taped& b) { return a.v <= b.v; }
  friend CLUTCHWORK_HOT bool operator>=(const Taped& a, const Taped& b) { return a.v >= b.v; }
  friend CLUTCHWORK_HOT bool operator==(const Taped& a, const Taped& b) { return a.v == b.v; }
  friend CLUTCHWORK_HOT bool operator!=(const Taped& a, const Taped& b) { return a.v != b.v; }

  double seen_slope(int) const { return probe; }
  /// As of numbers that carry their derivatives.
  template <class F>
  static auto over(int, F&& f) {
    return f(std::type_identity<TapedSum>{});
  }
  friend CLUTCHWORK_HOT double value(const Taped& x) { return x.v; }
  friend CLUTCHWORK_HOT Taped without_value(const Taped& x) { return chain(x, 0, 1); }
  friend CLUTCHWORK_HOT bool is_constant(const Taped& x) { return x.id == 0; }
  friend CLUTCHWORK_HOT bool is_zero(const Taped& x) { return x.v == 0 && x.id == 0; }
  /// y += a x as one number.
  friend CLUTCHWORK_HOT void add_times(double a, const Taped& x, Taped& y) { y = chain(y, 1, x, a, y.v + a * x.v); }
  /// A row keeps the number on the tape.
  friend CLUTCHWORK_HOT void keep(const Taped& x, double* to) { to[0] = x.id; }
  /// Of the one direction beside the tape, but for round-off.
  friend double largest_difference(const Taped& a, const Taped& b) {
    const double apart = abs(a.probe - b.probe);
    return apart > 1e-9 * (abs(a.probe) + abs(b.probe)) ? apart : 0;
  }
};

/// Derivatives that are a weighted sum of numbers on the tape, noted as one where they are used.
struct TapedSum {
  static constexpr int room = 8;
  double probe = 0;
  mutable int n = 0;
  mutable std::int32_t id[room + 1];
  mutable double by[room + 1];

  TapedSum() = default;
  explicit TapedSum(double) {}
  explicit TapedSum(const Taped& x) : probe(x.probe), n(x.id != 0) { id[0] = x.id, by[0] = 1; }
  TapedSum(const TapedSum& b) { *this = b; }
  TapedSum& operator=(const TapedSum& b) {
    b.settle();
    probe = b.probe, n = b.n;
    if (n > 0) id[0] = b.id[0], by[0] = b.by[0];
    return *this;
  }

  /// One number is left, or none.
  void settle() const {
    if (n < 2) return;
    id[n] = 0, by[n] = 0;
    set_number(Tape::current()->sum(n, id, by));
  }
  /// Its number, 0: a constant.
  std::int32_t number() const {
    settle();
    if (n > 0 && by[0] != 1) set_number(Tape::current()->note(id[0], by[0], 0, 0));
    return n > 0 ? id[0] : 0;
  }

  TapedSum& operator+=(const TapedSum& b) {
    add_times(1, b, *this);
    return *this;
  }
  friend TapedSum operator+(const TapedSum& a, const TapedSum& b) {
    TapedSum r = a;
    r += b;
    return r;
  }
  friend TapedSum operator*(const TapedSum& a, double b) {
    TapedSum r;
    add_times(b, a, r);
    return r;
  }
  friend TapedSum operator*(double a, const TapedSum& b) { return b * a; }
  friend CLUTCHWORK_HOT void add_times(double a, const TapedSum& x, TapedSum& y) {
    if (x.n != 1 || y.n == room) make_room(x, y);
    if (x.n == 0) return;
    y.probe += a * x.probe;
    y.id[y.n] = x.id[0], y.by[y.n++] = a * x.by[0];
  }

 private:
  [[gnu::noinline]] static void make_room(const TapedSum& x, TapedSum& y) {
    x.settle();
    if (y.n == room) y.settle();
  }
  void set_number(std::int32_t found) const { n = found != 0, id[0] = found, by[0] = 1; }
};

template <>
struct SlopesAs<Taped, TapedSum> {
  using Seen = double;
  static constexpr int count = 1;
  static TapedSum of(const Taped& x) { return TapedSum(x); }
  static Taped number(double v, const TapedSum& slopes) {
    Taped x(v);
    x.id = slopes.number(), x.probe = slopes.probe;
    return x;
  }
  static double seen(const TapedSum& slopes) { return slopes.probe; }
  static double seen_of(const Taped& x) { return x.probe; }
  static double at(double seen, int) { return seen; }
};

template <>
struct NumberOf<Taped> : NumberOf<double> {
  static constexpr bool tangents = true;
  using Given = Taped;
  using Point = Taped;
};

#define CLUTCHWORK_CHAIN(NAME, F, SLOPE)      \
  CLUTCHWORK_HOT Taped NAME(const Taped& x) { \
    const double f = F;                       \
    return Taped::chain(x, f, SLOPE);         \
  }
CLUTCHWORK_CHAIN(exp, exp(x.v), f)
CLUTCHWORK_CHAIN(log, log(x.v), 1 / x.v)
CLUTCHWORK_CHAIN(sqrt, sqrt(x.v), f > 0 ? 0.5 / f : 0.0)
CLUTCHWORK_CHAIN(cbrt, cbrt(x.v), f > 0 ? 1 / (3 * f * f) : 0.0)
CLUTCHWORK_CHAIN(sin, sin(x.v), cos(x.v))
CLUTCHWORK_CHAIN(cos, cos(x.v), -sin(x.v))
CLUTCHWORK_CHAIN(atan, atan(x.v), 1 / (1 + x.v * x.v))
CLUTCHWORK_CHAIN(tanh, tanh(x.v), 1 - f * f)
#undef CLUTCHWORK_CHAIN

CLUTCHWORK_HOT Taped abs(const Taped& x) { return x.v < 0 ? -x : x; }
/// Power of a positive base.
CLUTCHWORK_HOT Taped pow(const Taped& a, const Taped& b) {
  const double p = pow(a.v, b.v);
  return Taped::chain(a, b.v * pow(a.v, b.v - 1), b, a.v > 0 ? p * log(a.v) : 0.0, p);
}

}  // namespace clutchwork
