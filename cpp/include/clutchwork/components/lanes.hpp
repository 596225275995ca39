#pragma once
#include <clutchwork/components/scalar.hpp>

/// A scalar that is eight numbers, one of each run that steps together: docs/theory/lanes.md. Every operation does in
/// each lane what it does to a double, so that the bits agree. A comparison gives a Mask, which is no bool: a branch
/// that would treat all lanes alike does not compile.
namespace clutchwork {

inline constexpr int n_lanes = 8;

/// One answer per lane. R: lanes in one register of the processor.
template <int R>
struct Mask {
  typedef long long Part __attribute__((vector_size(8 * R)));
  static constexpr int parts = n_lanes / R;
  alignas(8 * n_lanes) Part part[parts];

  Mask() = default;
  CLUTCHWORK_INLINE explicit Mask(bool x) {
    for (Part& p : part) p = Part{} - (long long)(x);
  }
  CLUTCHWORK_INLINE bool operator[](int i) const { return reinterpret_cast<const long long*>(part)[i] != 0; }
  CLUTCHWORK_INLINE void set(int i, bool x) { reinterpret_cast<long long*>(part)[i] = x ? -1 : 0; }

  friend CLUTCHWORK_INLINE Mask operator&&(const Mask& a, const Mask& b) {
    Mask r;
    for (int i = 0; i < parts; ++i) r.part[i] = a.part[i] & b.part[i];
    return r;
  }
  friend CLUTCHWORK_INLINE Mask operator||(const Mask& a, const Mask& b) {
    Mask r;
    for (int i = 0; i < parts; ++i) r.part[i] = a.part[i] | b.part[i];
    return r;
  }
  friend CLUTCHWORK_INLINE Mask operator!(const Mask& a) {
    Mask r;
    for (int i = 0; i < parts; ++i) r.part[i] = ~a.part[i];
    return r;
  }
  friend CLUTCHWORK_INLINE bool any(const Mask& m) {
    Part p = m.part[0];
    for (int i = 1; i < parts; ++i) p |= m.part[i];
    const auto* word = reinterpret_cast<const long long*>(&p);
    long long found = 0;
    for (int i = 0; i < R; ++i) found |= word[i];
    return found != 0;
  }
  friend CLUTCHWORK_INLINE bool none(const Mask& m) { return !any(m); }
  friend CLUTCHWORK_INLINE bool all(const Mask& m) { return !any(!m); }
};

/// Eight numbers.
template <int R>
struct Lanes {
  typedef double Part __attribute__((vector_size(8 * R)));
  using Bits = typename Mask<R>::Part;
  static constexpr int parts = n_lanes / R;
  alignas(8 * n_lanes) Part part[parts];

  Lanes() = default;
  // register by register: what is copied in smaller pieces is slow to read again
  CLUTCHWORK_INLINE Lanes(const Lanes& x) { *this = x; }
  CLUTCHWORK_INLINE Lanes& operator=(const Lanes& x) {
    for (int i = 0; i < parts; ++i) part[i] = x.part[i];
    return *this;
  }
  CLUTCHWORK_INLINE Lanes(double x) {
    // a zero keeps its sign
    for (Part& p : part) p = x - Part{};
  }
  CLUTCHWORK_INLINE double operator[](int i) const { return reinterpret_cast<const double*>(part)[i]; }
  CLUTCHWORK_INLINE double& operator[](int i) { return reinterpret_cast<double*>(part)[i]; }

#define CLUTCHWORK_EACH(RESULT, OPERATOR)                                             \
  friend CLUTCHWORK_INLINE RESULT operator OPERATOR(const Lanes& a, const Lanes& b) { \
    RESULT r;                                                                         \
    for (int i = 0; i < parts; ++i) r.part[i] = a.part[i] OPERATOR b.part[i];         \
    return r;                                                                         \
  }
  CLUTCHWORK_EACH(Lanes, +)
  CLUTCHWORK_EACH(Lanes, -)
  CLUTCHWORK_EACH(Lanes, *)
  CLUTCHWORK_EACH(Lanes, /)
  CLUTCHWORK_EACH(Mask<R>, <)
  CLUTCHWORK_EACH(Mask<R>, >)
  CLUTCHWORK_EACH(Mask<R>, <=)
  CLUTCHWORK_EACH(Mask<R>, >=)
  CLUTCHWORK_EACH(Mask<R>, ==)
  CLUTCHWORK_EACH(Mask<R>, !=)
#undef CLUTCHWORK_EACH

  friend CLUTCHWORK_INLINE Lanes operator-(const Lanes& a) {
    Lanes r;
    for (int i = 0; i < parts; ++i) r.part[i] = -a.part[i];
    return r;
  }
  CLUTCHWORK_INLINE Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  CLUTCHWORK_INLINE Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
  CLUTCHWORK_INLINE Lanes& operator*=(const Lanes& b) { return *this = *this * b; }

  /// In comparisons and decisions each lane speaks for itself.
  friend CLUTCHWORK_INLINE Lanes value(const Lanes& x) { return x; }
  friend CLUTCHWORK_INLINE double common(const Lanes& x) { return x[0]; }

  friend CLUTCHWORK_INLINE Lanes abs(const Lanes& x) {
    Lanes r;
    for (int i = 0; i < parts; ++i)
      r.part[i] = reinterpret_cast<Part>(reinterpret_cast<Bits>(x.part[i]) & ~(1ll << 63));
    return r;
  }
  friend CLUTCHWORK_INLINE Lanes sqrt(const Lanes& x) {
    return each(x, [](double y) { return sqrt(y); });
  }
  // register by register; what lies outside is seldom
  friend CLUTCHWORK_INLINE Lanes exp(const Lanes& x) {
    Lanes r;
    for (int i = 0; i < parts; ++i) r.part[i] = exp_inside(x.part[i]);
    const Mask<R> inside = x < Lanes(708) && x > Lanes(-708);
    if (all(inside)) [[likely]]
      return r;
    for (int i = 0; i < n_lanes; ++i) r[i] = inside[i] ? r[i] : exp(x[i]);
    return r;
  }
  friend CLUTCHWORK_INLINE Lanes tanh(const Lanes& x) {
    const Lanes size = abs(x);
    Lanes r;
    return choose(
        size < Lanes(0.625),
        [&] {
          for (int i = 0; i < parts; ++i) r.part[i] = tanh_near(x.part[i]);
          return r;
        },
        [&] {
          for (int i = 0; i < parts; ++i) r.part[i] = tanh_far(size.part[i]);
          const Lanes y = select(size > Lanes(20), Lanes(1), r);
          return select(x < Lanes(0), -y, select(x == x, y, x));
        });
  }
  // these are functions of doubles: the same call in each lane
  friend CLUTCHWORK_INLINE Lanes log(const Lanes& x) {
    return each(x, [](double y) { return log(y); });
  }
  friend CLUTCHWORK_INLINE Lanes sin(const Lanes& x) {
    return each(x, [](double y) { return sin(y); });
  }
  friend CLUTCHWORK_INLINE Lanes cos(const Lanes& x) {
    return each(x, [](double y) { return cos(y); });
  }
  friend CLUTCHWORK_INLINE Lanes atan(const Lanes& x) {
    return each(x, [](double y) { return atan(y); });
  }
  friend CLUTCHWORK_INLINE Lanes pow(const Lanes& x, const Lanes& p) {
    Lanes r;
    for (int i = 0; i < n_lanes; ++i) r[i] = pow(x[i], p[i]);
    return r;
  }

 private:
  template <class F>
  static CLUTCHWORK_INLINE Lanes each(const Lanes& x, F&& f) {
    Lanes r;
    for (int i = 0; i < n_lanes; ++i) r[i] = f(x[i]);
    return r;
  }
};

template <int R>
struct NumberOf<Lanes<R>> {
  using Real = Lanes<R>;
  using Truth = Mask<R>;
  static constexpr bool lanes = true;
  static constexpr bool tangents = false;
  static constexpr bool single = false;
  using Given = double;
  using Point = Lanes<R>;
};

template <int R>
CLUTCHWORK_INLINE Lanes<R> select(const Mask<R>& which, const Lanes<R>& a, const Lanes<R>& b) {
  using Bits = typename Lanes<R>::Bits;
  Lanes<R> r;
  for (int i = 0; i < Lanes<R>::parts; ++i) {
    const auto x = reinterpret_cast<Bits>(a.part[i]), y = reinterpret_cast<Bits>(b.part[i]);
    r.part[i] = reinterpret_cast<typename Lanes<R>::Part>((x & which.part[i]) | (y & ~which.part[i]));
  }
  return r;
}
template <int R>
CLUTCHWORK_INLINE Lanes<R> count_where(const Mask<R>& which, int n) {
  return select(which, Lanes<R>(n), Lanes<R>(0));
}

/// a() and b() where some lane asks for each.
template <int R, class A, class B>
CLUTCHWORK_INLINE auto choose(const Mask<R>& which, A&& a, B&& b) {
  if (all(which)) return a();
  if (none(which)) return b();
  return select(which, a(), b());
}

}  // namespace clutchwork
