#pragma once
#include <clutchwork/run/advance.hpp>
#include <cstring>

/// A run over numbers with derivatives: the numbers of its model in such a form. docs/theory/gradients.md
namespace clutchwork {

/// Makes the numbers of a model T. Arena: counts, or hands out memory.
template <class T, class Arena_>
void lift(SystemOf<T>& to, const System& from, Arena_& arena) {
  static_cast<SystemCounts&>(to) = from;
  visit_fields(to, from, [&](auto& field, const auto* source, std::int64_t n) {
    using Entry = std::remove_cvref_t<decltype(*field)>;
    if constexpr (std::is_same_v<Entry, T>) {
      T* copy = nullptr;
      arena.take(copy, n);
      for (std::int64_t i = 0; copy != nullptr && i < n; ++i) copy[i] = T(source[i]);
      field = copy;
    } else {
      field = source;
    }
  });
}

/// The number of a lifted model at a word of the bytes of the plain one, null where none is.
template <class T>
T* number_at(SystemOf<T>& lifted, const System& plain, const unsigned char* bytes, std::int64_t word) {
  T* found = nullptr;
  const auto at = bytes + 8 * word;
  visit_fields(lifted, plain, [&](auto& field, const auto* source, std::int64_t n) {
    using Entry = std::remove_cvref_t<decltype(*field)>;
    if constexpr (std::is_same_v<Entry, T>) {
      const auto* first = reinterpret_cast<const unsigned char*>(source);
      if (at >= first && at < first + 8 * n) found = const_cast<T*>(field) + (at - first) / 8;
    }
  });
  return found;
}

/// A run at its start, with the numbers of its model as they have been seeded.
template <class T>
void begin_lifted(Workspace<T>& ws) {
  for (std::int64_t i = 0; i < ws.sys.n_input_refs; ++i) ws.in.ref_signal[i] = ws.sys.input_refs[i];
  for (std::int64_t p = 0; p < ws.sys.prescribed; ++p)
    ws.in.ref_signal[ws.sys.n_input_refs + p] = ws.sys.prescribed_input[p];
  for (std::int64_t i = 0; i < ws.sys.n_params; ++i) ws.params[i] = ws.sys.params[i];
  for (std::int64_t i = 0; i < ws.sys.inputs; ++i) {
    ws.in.signal[i] = SignalOf<T>{};
    ws.in.signal[i].held = ws.sys.input_value[i];
  }
}

}  // namespace clutchwork
