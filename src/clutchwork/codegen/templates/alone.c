/* The whole run without a heap: whatever allocates ends the program. */
#include <stdio.h>
#include "model.h"

void abort(void);
void *malloc(size_t n) { (void)n; abort(); }
void *calloc(size_t n, size_t m) { (void)n, (void)m; abort(); }
void *realloc(void *p, size_t n) { (void)p, (void)n; abort(); }

static _Alignas(16) unsigned char memory[MODEL_MEMORY];

int main(void) {
  double row[MODEL_ROW_SIZE], event[MODEL_EVENT_SIZE];
  cw_run *run = cw_load(model_system, MODEL_SYSTEM_BYTES, memory, sizeof memory);
  if (run == NULL || !model_set_options(run)) return 1;
  int status;
  do {
    status = cw_advance(run, MODEL_T_END, NULL, NULL, 0, 0, NULL);
    while (cw_take_events(run, event, 1) == 1) continue;
  } while (status == MODEL_STATUS_EVENTS_FULL);
  return status == MODEL_STATUS_DONE && cw_row(run, row) == MODEL_STATUS_DONE ? 0 : 2;
}
