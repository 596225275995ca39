/* The 3-4 shift with CVODE of SUNDIALS, all in C. The numbers of the model come from gearbox.h, which by_c.py writes from
 * equations.py. Of the library only functions are used, so that no header of it is needed.
 *
 *   cvode METHOD RTOL REPEATS    median of the CPU time of one run [us], and the events
 *   cvode METHOD RTOL            the states on the 1 ms grid, one line each
 * METHOD: 1 Adams, 2 BDF */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "gearbox.h"

typedef void* N_Vector;
typedef int (*Function)(double t, N_Vector y, N_Vector slope, void* user);
typedef int (*Guards)(double t, N_Vector y, double* values, void* user);
extern int SUNContext_Create(void* communicator, void** context);
extern N_Vector N_VNew_Serial(int64_t length, void* context);
extern double* N_VGetArrayPointer(N_Vector vector);
extern void N_VDestroy(N_Vector vector);
extern void* SUNDenseMatrix(int64_t rows, int64_t columns, void* context);
extern void SUNMatDestroy(void* matrix);
extern void* SUNLinSol_Dense(N_Vector vector, void* matrix, void* context);
extern int SUNLinSolFree(void* solver);
extern void* CVodeCreate(int method, void* context);
extern int CVodeInit(void* memory, Function function, double t, N_Vector y);
extern int CVodeReInit(void* memory, double t, N_Vector y);
extern int CVodeSStolerances(void* memory, double rtol, double atol);
extern int CVodeSetUserData(void* memory, void* user);
extern int CVodeSetLinearSolver(void* memory, void* solver, void* matrix);
extern int CVodeSetMaxNumSteps(void* memory, long steps);
extern int CVodeSetStopTime(void* memory, double t);
extern int CVodeRootInit(void* memory, int count, Guards guards);
extern int CVodeSetRootDirection(void* memory, int* direction);
extern int CVodeSetNoInactiveRootWarn(void* memory);
extern int CVodeGetRootInfo(void* memory, int* found);
extern int CVodeGetDky(void* memory, double t, int order, N_Vector into);
extern int CVode(void* memory, double stop, N_Vector y, double* t, int task);
extern void CVodeFree(void** memory);
enum { one_step = 2, stopped = 1, at_root = 2 };

typedef struct {
  int mode[4], k, set;
} Modes;

static double dot(const double* a, const double* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }
static double pressure(int i, double t, int k) { return PRESSURES[k][i] + SLOPES[k][i] * (t - KNOTS[k]); }
static int set_of(const int* mode) { return 4 * (mode[0] == 0) + 2 * (mode[1] == 0) + (mode[2] == 0); }

static void applied(double t, const double* y, const int* mode, int k, double* q) {
  const double shaft = y[4] + DAMPING * (y[1] - y[2]);
  q[0] = mode[3] == 0 ? 4000.0 - 4.7746 * y[0] : 3000.0 - 190.9859 * (y[0] - KNEE);
  q[1] = -shaft, q[2] = shaft, q[3] = -4000.0 * tanh(2.0 * y[3]);
  for (int i = 0; i < 3; ++i) {
    const double pressed = pressure(i, t, k);
    if (mode[i] == 0 || pressed <= 0) continue;
    const double sliding = FAST + MORE * exp(fmin(20.0, -RATE * mode[i] * dot(SLIPS[i], y)));
    for (int j = 0; j < 4; ++j) q[j] -= SLIPS[i][j] * mode[i] * GAINS[i] * pressed * sliding;
  }
}

static int slope(double t, N_Vector state, N_Vector into, void* user) {
  const Modes* now = user;
  const double* y = N_VGetArrayPointer(state);
  double q[4], *d = N_VGetArrayPointer(into);
  applied(t, y, now->mode, now->k, q);
  for (int j = 0; j < 4; ++j) d[j] = dot(ACCELERATIONS[now->set][j], q);
  d[4] = STIFFNESS * (y[1] - y[2]);
  return 0;
}

static double held(int i, double t, const double* y, const int* mode, int k) {
  double q[4];
  applied(t, y, mode, k, q);
  return dot(MULTIPLIERS[set_of(mode)][i], q);
}

static int guards(double t, N_Vector state, double* g, void* user) {
  const Modes* now = user;
  const double* y = N_VGetArrayPointer(state);
  for (int i = 0; i < 3; ++i) {
    if (now->mode[i] == 0) {
      g[i] = GAINS[i] * STATIC * pressure(i, t, now->k) - fabs(held(i, t, y, now->mode, now->k));
    } else if (PRESSURES[now->k][i] == 0 && SLOPES[now->k][i] == 0) {
      g[i] = 1.0;
    } else {
      g[i] = now->mode[i] * dot(SLIPS[i], y);
    }
  }
  g[3] = now->mode[3] == 0 ? KNEE - y[0] : y[0] - KNEE;
  return 0;
}

static void switch_mode(int i, double t, double* y, Modes* now) {
  if (i == 3) {
    now->mode[3] = 1 - now->mode[3];
  } else if (now->mode[i] == 0) {
    now->mode[i] = held(i, t, y, now->mode, now->k) > 0 ? 1 : -1;
  } else {
    const int sign = now->mode[i];
    now->mode[i] = 0;
    if (fabs(held(i, t, y, now->mode, now->k)) > GAINS[i] * STATIC * pressure(i, t, now->k)) now->mode[i] = -sign;
  }
  now->set = set_of(now->mode);
  /* the round-off of the slip of locked clutches, one after another */
  for (int round = 0; round < 3; ++round) {
    for (int c = 0; c < 3; ++c) {
      if (now->mode[c] != 0) continue;
      double across[4];
      for (int j = 0; j < 4; ++j) across[j] = dot(MASS_INVERSE[j], SLIPS[c]);
      const double share = dot(SLIPS[c], y) / dot(SLIPS[c], across);
      for (int j = 0; j < 4; ++j) y[j] -= share * across[j];
    }
  }
}

/* One run; with `rows` the states on the 1 ms grid too. The number of events, -1 when the solver fails. */
static int run(void* context, int method, double rtol, double* rows, double* times) {
  N_Vector y = N_VNew_Serial(5, context), between = N_VNew_Serial(5, context);
  double* value = N_VGetArrayPointer(y);
  memset(value, 0, 5 * sizeof *value);
  void *matrix = SUNDenseMatrix(5, 5, context), *linear = SUNLinSol_Dense(y, matrix, context);
  void* memory = CVodeCreate(method, context);
  Modes now = {{1, 0, 0, 0}, 0, 0};
  now.set = set_of(now.mode);
  int direction[4] = {-1, -1, -1, -1}, events = 0, filled = 0;
  CVodeInit(memory, slope, 0.0, y);
  CVodeSStolerances(memory, rtol, 1e-2 * rtol);
  CVodeSetUserData(memory, &now);
  CVodeSetLinearSolver(memory, linear, matrix);
  CVodeSetMaxNumSteps(memory, 100000);
  CVodeRootInit(memory, 4, guards);
  CVodeSetRootDirection(memory, direction);
  CVodeSetNoInactiveRootWarn(memory);
  for (now.k = 0; now.k < STRETCHES && events >= 0; ++now.k) {
    double t = KNOTS[now.k];
    const double stop = KNOTS[now.k + 1];
    CVodeReInit(memory, t, y);
    CVodeSetStopTime(memory, stop);
    while (t < stop) {
      const int status = CVode(memory, stop, y, &t, one_step);
      if (status < 0) {
        events = -1;
        break;
      }
      for (; rows && filled <= 4000 && (filled * 1e-3 < t || (filled == 4000 && t >= stop)); ++filled) {
        CVodeGetDky(memory, filled * 1e-3, 0, between);
        memcpy(rows + 5 * filled, N_VGetArrayPointer(between), 5 * sizeof(double));
      }
      if (status != at_root) continue;
      int found[4];
      CVodeGetRootInfo(memory, found);
      for (int i = 0; i < 4; ++i) {
        if (found[i] == 0) continue;
        if (events < 16) times[events] = t;
        ++events;
        switch_mode(i, t, value, &now);
        break;
      }
      CVodeReInit(memory, t, y);
      CVodeSetStopTime(memory, stop);
    }
  }
  CVodeFree(&memory);
  SUNLinSolFree(linear);
  SUNMatDestroy(matrix);
  N_VDestroy(between);
  N_VDestroy(y);
  return events;
}

static double cpu(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static int order(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

int main(int count, char** words) {
  if (count < 3) return 2;
  void* context = NULL;
  if (SUNContext_Create(NULL, &context) != 0) return 1;
  const int method = atoi(words[1]), repeats = count > 3 ? atoi(words[3]) : 0;
  const double rtol = atof(words[2]);
  double times[16];
  if (repeats < 1) {
    static double rows[4001 * 5];
    if (run(context, method, rtol, rows, times) < 0) return 1;
    for (int i = 0; i <= 4000; ++i) {
      for (int j = 0; j < 5; ++j) printf("%.17g%c", rows[5 * i + j], j < 4 ? ' ' : '\n');
    }
    return 0;
  }
  double* taken = malloc(sizeof *taken * (size_t)repeats);
  int events = 0;
  for (int r = 0; r < repeats && events >= 0; ++r) {
    const double start = cpu();
    events = run(context, method, rtol, NULL, times);
    taken[r] = cpu() - start;
  }
  if (events < 0) return 1;
  qsort(taken, (size_t)repeats, sizeof *taken, order);
  printf("%.3f", taken[repeats / 2]);
  for (int i = 0; i < events && i < 16; ++i) printf(" %.9f", times[i]);
  printf("\n");
  return 0;
}
