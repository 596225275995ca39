#pragma once
#include <clutchwork/registry.gen.hpp>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>
#endif

/// Memory of a run in one block, and the sizes of its arrays.
namespace clutchwork {

/// Whether the matrices of a system are whole: it has few speeds, or directions that vary.
inline bool is_few(const SystemCounts& s) { return s.speeds <= few_speeds || s.transmissions > 0; }

/// Whether there is room for the matrices of steps of one length.
inline bool has_fixed_steps(const SystemCounts& s) { return is_few(s) || s.speeds <= most_fixed_speeds; }

/// Numbers of things in a system, by which arrays are sized; for few speeds the matrices are whole.
struct Sizes {
  std::int64_t speeds, prescribed, supplies, meters, states, shared, nodes, elements, contacts, directions, references,
      signals, segments, flows, processes, transmissions, loads;
  bool few;
  bool fixed;                  ///< it may have steps of one length
  bool full;                   ///< it runs in the full form
  std::int64_t spares;         ///< most locked contacts that can depend on others
  std::int64_t set;            ///< most contacts of a set that depend on each other
  std::int64_t factor;         ///< of the mass matrix
  std::int64_t mass_weighted;  ///< mass-weighted directions
  std::int64_t mobility;       ///< of the contacts
  std::int64_t expansion;      ///< speeds over reduced ones, and on the way there
  std::int64_t rate, mass;     ///< over reduced speeds
  std::int64_t envelope;       ///< of the reduced motion
  std::int64_t blocks;         ///< of the own states
  std::int64_t row;            ///< of output

  template <class G>
  explicit Sizes(const SystemOf<G>& s)
      : speeds(s.speeds),
        prescribed(s.prescribed),
        supplies(s.supplies),
        meters(s.meters),
        states(s.states),
        shared(s.shared),
        nodes(s.nodes),
        elements(s.elements),
        contacts(s.contacts),
        directions(s.elements + s.contacts),
        references(s.n_input_refs + s.prescribed),
        signals(s.inputs),
        segments(s.segments),
        flows(s.flows),
        processes(s.processes),
        transmissions(s.transmissions),
        loads(s.loads),
        few(is_few(s)),
        fixed(has_fixed_steps(s)),
        full(s.full != nullptr && s.full[0] != 0) {
    const auto nv = speeds, nc = contacts;
    spares = few ? (nc > 1 || transmissions > 0 ? nc : 0) : s.spares, set = few ? spares : s.set_size;
    // those that follow loads make one set of all that is locked
    if (loads > 0) set = nc;
    factor = few ? nv * (nv + 1) / 2 : s.factor_room, mass_weighted = few ? directions * nv : s.direction_room;
    mobility = few ? nc * (nc + 1) / 2 : s.mobility_room;
    expansion = few ? nv * nv : s.expansion_room, rate = few ? directions * nv : s.rate_room;
    envelope = few ? nv * (nv + 1) / 2 : s.envelope_room, mass = few ? envelope : s.mass_room;
    row = RowLayout(s).size;
    blocks = states <= 8 ? states * states : states * most_own_states;
  }
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
    constexpr std::int64_t step = alignof(P) > 16 ? alignof(P) : 16;
    at_ = (at_ + step - 1) / step * step;
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
