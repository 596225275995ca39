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

/// Forms of another scalar that are compiled: those of few speeds in one, others in the sparse form.
#define SMALL_AND_SPARSE(...)                                                             \
  namespace clutchwork {                                                                  \
  template <>                                                                             \
  Status dispatch<__VA_ARGS__>(Workspace<__VA_ARGS__> & ws, double t_end, Sink& sink) {   \
    if (ws.reduced.is_sparse) return run_phase<SparseForm<__VA_ARGS__>>(ws, t_end, sink); \
    return run_phase<SmallForm<__VA_ARGS__>>(ws, t_end, sink);                            \
  }                                                                                       \
  }
