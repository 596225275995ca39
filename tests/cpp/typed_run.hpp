#pragma once
#include <clutchwork/run/advance.hpp>

#include "fixture.hpp"

/// A run with another scalar than double, set up as the C line does it.
namespace fixture {

template <class T>
struct TypedRun {
  Bytes system, memory;
  Workspace<T> ws;

  explicit TypedRun(const Model& model) : system(model.bytes()) {
    bind(ws.sys, system.data(), std::int64_t(system.size()));
    ws.row = RowLayout(ws.sys);
    memory.resize(std::size_t(carve(ws, nullptr)));
    carve(ws, memory.data());
    for (int i = 0; i < ws.sys.n_input_refs; ++i) ws.in.ref_signal[i] = ws.sys.input_refs[i];
    for (int p = 0; p < ws.sys.prescribed; ++p) ws.in.ref_signal[ws.sys.n_input_refs + p] = ws.sys.prescribed_input[p];
    for (int i = 0; i < ws.sys.n_params; ++i) ws.params[i] = T(ws.sys.params[i]);
    for (int i = 0; i < ws.sys.inputs; ++i) ws.in.signal[i] = Signal{}, ws.in.signal[i].held = ws.sys.input_value[i];
  }
  Status advance(double t) {
    Sink none;
    return clutchwork::advance(ws, t, none);
  }
};

}  // namespace fixture

/// Sizes of another scalar that are compiled: one and two speeds, two with a state; others in the sparse form.
#define ONLY_TWO_SPEEDS(...)                                                                             \
  namespace clutchwork {                                                                                 \
  template <>                                                                                            \
  Status dispatch<__VA_ARGS__, 1, 0>(Workspace<__VA_ARGS__> & ws, double t_end, Sink& sink) {            \
    const int size = ws.reduced.is_sparse ? 0 : 10 * ws.reduced.nz + int(ws.sys.states);                 \
    if (size == 10) return run_phase<SmallForm<__VA_ARGS__, 1, 0>>(ws, t_end, sink);                     \
    if (size == 20) return run_phase<SmallForm<__VA_ARGS__, 2, 0>>(ws, t_end, sink);                     \
    if (size == 21) return run_phase<SmallForm<__VA_ARGS__, 2, 1>>(ws, t_end, sink);                     \
    return ws.reduced.is_sparse ? run_phase<SparseForm<__VA_ARGS__>>(ws, t_end, sink) : Status::no_mode; \
  }                                                                                                      \
  }
