#pragma once
#include <clutchwork/run/advance.hpp>
#include <cstring>

/// A run over numbers with derivatives: the numbers of its model in such a form. docs/theory/gradients.md
namespace clutchwork {

/// Makes the numbers of a model T.
template <class T>
void lift(Workspace<T>& ws, const System& from, Arena& arena) {
  auto copied = [&](const double* source, std::int64_t n) {
    T* copy = nullptr;
    arena.take(copy, n);
    for (std::int64_t i = 0; copy != nullptr && i < n; ++i) copy[i] = T(source[i]);
    return copy;
  };
  SystemOf<T>& to = ws.sys;
  static_cast<SystemCounts&>(to) = from;
  visit_fields(to, from, [&](auto& field, const auto* source, std::int64_t n) {
    using Entry = std::remove_cvref_t<decltype(*field)>;
    if constexpr (std::is_same_v<Entry, T>) {
      field = copied(source, n);
    } else {
      field = source;
    }
  });
  ws.moved.points = copied(from.points, 3 * from.n_points);
}

/// The image of a run without derivatives; returns the size that it needs.
template <class T>
std::int64_t carve_image(Workspace<T>& ws, Workspace<double>& image, const System& plain, unsigned char* memory) {
  image.sys = plain;
  image.row = ws.row;
  ws.moved.plain = &image;
  return carve(image, memory);
}

/// The number of a lifted model at a word of the bytes of the plain one, null where none is.
template <class T>
T* number_at(Workspace<T>& ws, const System& plain, const unsigned char* bytes, std::int64_t word) {
  T* found = nullptr;
  const auto at = bytes + 8 * word;
  auto entry = [&](const T* copy, const double* source, std::int64_t n) {
    const auto* first = reinterpret_cast<const unsigned char*>(source);
    if (at >= first && at < first + 8 * n) found = const_cast<T*>(copy) + (at - first) / 8;
  };
  visit_fields(ws.sys, plain, [&](auto& field, const auto* source, std::int64_t n) {
    using Entry = std::remove_cvref_t<decltype(*field)>;
    if constexpr (std::is_same_v<Entry, T>) entry(field, source, n);
  });
  entry(ws.moved.points, plain.points, 3 * plain.n_points);
  return found;
}

/// The instant [s] before which a word of the bytes has no part in the run: of a later piece of a signal its start,
/// -infinity of all others.
inline double begin_of(const System& plain, const unsigned char* bytes, std::int64_t word) {
  const auto at = reinterpret_cast<const double*>(bytes + 8 * word);
  for (std::int64_t i = 0; i < plain.inputs; ++i) {
    const std::int64_t first = plain.input_first[i], n = plain.input_count[i];
    const double *time = plain.segment_time + first, *coef = plain.segment_coef + segment_size * first;
    const bool is_time = at >= time && at < time + n, is_coef = at >= coef && at < coef + segment_size * n;
    if (!is_time && !is_coef) continue;
    const std::int64_t piece = is_time ? at - time : (at - coef) / segment_size;
    return piece > 0 && !(plain.input_period[i] > 0) ? time[piece] : -infinity;
  }
  return -infinity;
}

/// Derivatives without those of angles and work; false where steps follow the work.
template <class T>
bool leave_out_work(Workspace<T>& ws) {
  if (ws.started || ws.sys.prescribed > 0) return false;
  ws.moved.work_left_out = ws.options.work;
  ws.options.work = ws.options.angles = false;
  return true;
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
  mark_moving(ws);
}

}  // namespace clutchwork
