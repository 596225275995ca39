/* Runs the model a step of MODEL_DT at a time, as a controller or a simulator around it does, and writes its signals
   as CSV. The solver ends a step at every instant, so the numbers are those of main.c within its tolerance. */
#include <cstdio>

#include "model.h"

namespace {

alignas(16) unsigned char memory[MODEL_MEMORY];
double event[MODEL_EVENT_SIZE];

/* What comes from outside, for the step that begins; signals are there as model_get_...(row). */
void set_inputs(cw_run* run, double time, const double* row) {
  static_cast<void>(run), static_cast<void>(time), static_cast<void>(row);
  /* cw_set_input(run, MODEL_INPUT_..., value); */
}

/* One step; neither heap nor files. */
int step(cw_run* run, double t_end) {
  int status;
  do {
    status = cw_advance(run, t_end, nullptr, nullptr, 0, 0, nullptr);
    while (cw_take_events(run, event, 1) == 1) {
    }
  } while (status == MODEL_STATUS_EVENTS_FULL);
  return status;
}

}  // namespace

int main() {
  cw_run* run = cw_load(model_system, MODEL_SYSTEM_BYTES, memory, sizeof memory);
  if (run == nullptr || cw_row_size(run) != MODEL_ROW_SIZE || !model_set_options(run)) {
    std::fprintf(stderr, "the system does not fit this core or this machine\n");
    return 2;
  }
  std::printf("time [s]");
  for (const model_signal& signal : model_signals) std::printf(",%s [%s]", signal.name, signal.unit);
  int status = MODEL_STATUS_DONE;
  double row[MODEL_ROW_SIZE] = {};
  /* what is set before the first step is part of the start */
  set_inputs(run, MODEL_T_START, row);
  for (int k = 0; k < MODEL_INSTANTS && status == MODEL_STATUS_DONE; ++k) {
    const double time = k + 1 < MODEL_INSTANTS ? fmin(MODEL_T_START + k * MODEL_DT, MODEL_T_END) : MODEL_T_END;
    status = step(run, time);
    if (status != MODEL_STATUS_DONE) break;
    cw_row(run, row);
    std::printf("\n%.17g", time);
    for (const model_signal& signal : model_signals) std::printf(",%.17g", signal.value(row));
    set_inputs(run, time, row);
  }
  std::printf("\n");
  if (status != MODEL_STATUS_DONE) std::fprintf(stderr, "stopped at %.17g s with status %d\n", cw_time(run), status);
  return status == MODEL_STATUS_DONE ? 0 : 1;
}
