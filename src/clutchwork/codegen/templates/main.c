/* Runs the model over its grid and writes its signals as CSV, the events to standard error.
   The numbers are those of clutchwork in Python on the same grid. Nothing comes from the heap. */
#include <stdio.h>

#include "model.h"

static _Alignas(16) unsigned char memory[MODEL_MEMORY];
static double times[MODEL_INSTANTS];
static double rows[(size_t)MODEL_INSTANTS * MODEL_ROW_SIZE];

static void print_head(void) {
  printf("time [s]");
  for (int k = 0; k < MODEL_SIGNALS; ++k) printf(",%s [%s]", model_signals[k].name, model_signals[k].unit);
  printf("\n");
}

static void print_row(double time, const double *row) {
  printf("%.17g", time);
  for (int k = 0; k < MODEL_SIGNALS; ++k) printf(",%.17g", model_signals[k].value(row));
  printf("\n");
}

static void tell_events(cw_run *run) {
  double event[MODEL_EVENT_SIZE];
  while (cw_take_events(run, event, 1) == 1) {
    const int contact = (int)event[MODEL_EVENT_CONTACT];
    fprintf(stderr, "%.17g s: %s from %d to %d\n", event[MODEL_EVENT_TIME],
            contact >= 0 && contact < MODEL_CONTACTS ? model_contacts[contact] : "-", (int)event[MODEL_EVENT_FROM],
            (int)event[MODEL_EVENT_TO]);
  }
}

int main(void) {
  cw_run *run = cw_load(model_system, MODEL_SYSTEM_BYTES, memory, sizeof memory);
  if (run == NULL || cw_row_size(run) != MODEL_ROW_SIZE || !model_set_options(run)) {
    fprintf(stderr, "the system does not fit this core or this machine\n");
    return 2;
  }
  for (int64_t k = 0; k + 1 < MODEL_INSTANTS; ++k) times[k] = fmin(MODEL_T_START + (double)k * MODEL_DT, MODEL_T_END);
  times[MODEL_INSTANTS - 1] = MODEL_T_END;

  /* inputs that are set from outside stay at zero here: cw_set_input(run, MODEL_INPUT_..., value) sets one */
  int64_t done = 0, filled = 0;
  int status;
  do {
    status = cw_advance(run, MODEL_T_END, times + done, rows + done * MODEL_ROW_SIZE, MODEL_INSTANTS - done, 0, &filled);
    done += filled;
    tell_events(run);
  } while (status == MODEL_STATUS_EVENTS_FULL);

  print_head();
  for (int64_t k = 0; k < done; ++k) print_row(times[k], rows + k * MODEL_ROW_SIZE);
  if (status != MODEL_STATUS_DONE) fprintf(stderr, "stopped at %.17g s with status %d\n", cw_time(run), status);
  return status == MODEL_STATUS_DONE ? 0 : 1;
}
