#pragma once
#include <clutchwork/components/single.hpp>

/// Numbers two at a time, of which the compiler makes what the processor has: each has the bits that it has alone.
namespace clutchwork::fixed {

/// Whether few speeds and few contacts are compiled for each number of them, and numbers go in pairs; a build that must
/// be small has one loop for all, to the same bits, and single numbers have no pairs.
#if defined(CLUTCHWORK_ONE_SIZE) || defined(CLUTCHWORK_SINGLE)
inline constexpr bool has_few_sizes = false;
#else
inline constexpr bool has_few_sizes = true;
#endif
/// Whether an odd last number may go with its neighbour: arrays of a run end at whole pairs. Behind a part of an array,
/// such as a column, the neighbour is the first number of the next part; what is made of it goes into the padding of
/// the result. Fences between arrays forbid it.
#ifdef __SANITIZE_ADDRESS__
inline constexpr bool has_whole_pairs = false;
#else
inline constexpr bool has_whole_pairs = has_few_sizes;
#endif

typedef double Two __attribute__((vector_size(16)));
/// V, wherever a number may stand.
template <class V>
struct __attribute__((packed, may_alias)) Anywhere {
  V x;
};

/// V: one number, or two.
template <class V>
CLUTCHWORK_HOT V take(const real* from) {
  if constexpr (std::is_same_v<V, Single>)
    return *from;
  else
    return reinterpret_cast<const Anywhere<V>*>(from)->x;
}
template <class V>
CLUTCHWORK_HOT void put(real* to, const V& x) {
  if constexpr (std::is_same_v<V, Single>)
    *to = x;
  else
    reinterpret_cast<Anywhere<V>*>(to)->x = x;
}

/// Calls f(i, V()) for all of n numbers and no other.
template <class F>
CLUTCHWORK_HOT void in_pairs_alone(int n, F&& f) {
  int i = 0;
  if constexpr (has_few_sizes) {
    for (; i + 2 <= n; i += 2) f(i, Two());
    if (i < n) f(i, real());
  } else {
    for (; i < n; ++i) f(i, real());
  }
}
/// The same for whole arrays of a run, of which a pair may reach behind the last number.
template <class F>
CLUTCHWORK_HOT void in_pairs(int n, F&& f) {
  if constexpr (has_whole_pairs) {
    for (int i = 0; i < n; i += 2) f(i, Two());
  } else {
    in_pairs_alone(n, f);
  }
}

}  // namespace clutchwork::fixed
