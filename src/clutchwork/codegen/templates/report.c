/* What a step of MODEL_DT costs on the machine that runs it: memory, stack, time. Each step is repeated from a copy of
   the run and the least of its times counts, so that what else the machine does is left out. */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "model.h"

enum { REPEATS = 5, STACK = 1 << 18 };

static _Alignas(16) unsigned char memory[MODEL_MEMORY], copy[MODEL_MEMORY];

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int step(cw_run *run, double end) {
  double event[MODEL_EVENT_SIZE];
  int status = cw_advance(run, end, NULL, NULL, 0, 0, NULL);
  while (cw_take_events(run, event, 1) == 1) continue;
  return status;
}

/* Leave a pattern on the stack below the caller. */
static __attribute__((noinline)) void paint(void) {
  volatile unsigned char area[STACK];
  for (int k = 0; k < STACK; ++k) area[k] = 0xa5;
}

/* How much of the pattern is gone. */
static __attribute__((noinline)) int used(void) {
  volatile unsigned char area[STACK];
  int low = 0;
  while (low < STACK && area[low] == 0xa5) ++low;
  return STACK - low;
}

int main(void) {
  cw_run *run = cw_load(model_system, MODEL_SYSTEM_BYTES, memory, sizeof memory);
  if (run == NULL || !model_set_options(run)) return 2;
  int status = MODEL_STATUS_DONE, steps = 0, deepest = 0;
  double sum = 0.0, worst = 0.0, at = 0.0;
  for (double end = MODEL_T_START + MODEL_DT; end <= MODEL_T_END && status == MODEL_STATUS_DONE; end += MODEL_DT) {
    double least = 1e9;
    cw_copy(run, copy, sizeof copy);
    for (int k = 0; k < REPEATS; ++k) {
      cw_paste(run, copy, sizeof copy);
      const double begin = seconds();
      status = step(run, end);
      const double took = seconds() - begin;
      if (took < least) least = took;
    }
    cw_paste(run, copy, sizeof copy);
    paint();
    status = step(run, end);
    const int depth = used();
    if (depth > deepest) deepest = depth;
    sum += least, ++steps;
    if (least > worst) worst = least, at = end;
  }
  printf("memory of a run %d bytes, system %d bytes, stack of a step %d bytes\n", MODEL_MEMORY, MODEL_SYSTEM_BYTES,
         deepest);
  printf("%d steps of %g s: mean %.3g us, worst %.3g us, the step that ends at %g s\n", steps, MODEL_DT, 1e6 * sum / steps,
         1e6 * worst, at);
  return status == MODEL_STATUS_DONE ? 0 : 1;
}
