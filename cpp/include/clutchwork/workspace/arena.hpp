#pragma once
#include <clutchwork/registry.gen.hpp>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>
#endif

/// Memory of a run in one block, and the sizes of its arrays.
namespace clutchwork {

/// Numbers of things in a system, by which arrays are sized.
struct Sizes {
  std::int64_t speeds, prescribed, states, shared, nodes, elements, contacts, directions, references, signals;
  std::int64_t spares;  ///< most locked contacts that can depend on others

  explicit Sizes(const System& s)
      : speeds(s.speeds),
        prescribed(s.prescribed),
        states(s.states),
        shared(s.shared),
        nodes(s.nodes),
        elements(s.elements),
        contacts(s.contacts),
        directions(s.elements + s.contacts),
        references(s.n_input_refs + s.prescribed),
        signals(s.inputs),
        spares(s.contacts > 1 ? s.contacts : 0) {}
};

/// Fences between the arrays, which the address sanitizer watches; none without it.
#ifdef __SANITIZE_ADDRESS__
inline constexpr std::int64_t fence = 64;
inline void raise_fence(unsigned char* at) { __asan_poison_memory_region(at, fence); }
inline void drop_fences(unsigned char* at, std::int64_t n) { __asan_unpoison_memory_region(at, std::size_t(n)); }
#else
inline constexpr std::int64_t fence = 0;
inline void raise_fence(unsigned char*) {}
inline void drop_fences(unsigned char*, std::int64_t) {}
#endif

/// Hands out pieces of a block of memory, or only counts them when the block is null.
class Arena {
 public:
  explicit Arena(unsigned char* base) : base_(base) {}
  template <class P>
  void take(P*& p, std::int64_t n) {
    at_ = (at_ + 15) / 16 * 16;
    p = base_ ? reinterpret_cast<P*>(base_ + at_) : nullptr;
    at_ += (n > 0 ? n : 1) * std::int64_t(sizeof(P));
    if (base_) raise_fence(base_ + at_);
    at_ += fence;
  }
  template <class P>
  void scratch(P*& p, std::int64_t n) {
    take(p, n);
  }
  void keep(int*& p, std::int64_t n, std::int64_t, std::int64_t) { take(p, n); }
  std::int64_t size() const { return at_ + 16; }

 private:
  unsigned char* base_;
  std::int64_t at_ = 0;
};

}  // namespace clutchwork
