#ifndef CLUTCHWORK_DERIVATIVES_H
#define CLUTCHWORK_DERIVATIVES_H
#include <clutchwork/c_api.h>

/* Runs with derivatives beside those of c_api.h, whose rules and statuses are theirs; cpp/src/derivatives compiles
   apart. */

#ifdef __cplusplus
extern "C" {
#endif

/* Runs with derivatives by numbers of the system: the motion, its events and their instants. docs/theory/gradients.md
 */
typedef struct cw_tangents cw_tangents;

/* Directions of one such run. */
#define CW_DIRECTIONS 8

/* Numbers of a guard that was hit: time [s], kind of guard (-1: a knot of the signal whose number stands for the
   component), component (elements, then contacts; -1: none), size of its time derivative over its scale [1/s], and by
   how much the derivatives of two events at this instant differ [s]. */
#define CW_GRAZE 5

/* Whether they are compiled for the processor of this machine: 1, or 0, and no other call may follow. */
int cw_tangents_supported(void);

/* Bytes of memory that it needs; -1 when the bytes do not fit this core. */
int64_t cw_tangents_size(const void* system, int64_t bytes);

/* Start a run with derivatives in `memory`; NULL when system or memory do not fit. Nothing needs to be freed. */
cw_tangents* cw_tangents_load(const void* system, int64_t bytes, void* memory, int64_t memory_bytes);

/* As cw_set_option. The method is rodas5p whatever is set. */
int cw_tangents_set_option(cw_tangents* run, const char* name, double value);

/* Angles and work get no derivatives, nor values, which costs less; the steps stay those of a run with work where the
   option is set. Before the start. 1: done; 0: the steps follow the work, so that it is not left out. */
int cw_tangents_leave_out_work(cw_tangents* run);

/* Word `word` of eight bytes of the system changes by `slope` per unit of a direction; before the start. Repeated calls
   add up. 1: done; 0: no such direction, or the word is not a number of the motion. */
int cw_tangents_seed(cw_tangents* run, int64_t word, int direction, double slope);

/* As cw_advance with a grid: rows as there, and after each other CW_DIRECTIONS derivatives of each of their numbers, at
   a fixed time, into `tangents`. Call it again, with what is left of the grid, after events_full. */
int cw_tangents_advance(cw_tangents* run, double t_end, const double* times, double* rows, double* tangents, int64_t n,
                        int64_t* filled);

/* Take the oldest events out, at most `most`, and the derivatives of their times; returns how many. */
int64_t cw_tangents_events(cw_tangents* run, double* events, double* tangents, int64_t most);

/* Take the guards that were hit out, at most `most`, and the derivatives of their times; returns how many. */
int64_t cw_tangents_grazes(cw_tangents* run, double* grazes, double* tangents, int64_t most);

/* Component that a status other than done is about, -1: none, and the value it is about. */
int cw_tangents_fault(const cw_tangents* run, double* value);

/* Accepted steps. */
int64_t cw_tangents_steps(const cw_tangents* run);

/* Runs that note how their numbers came about, for derivatives of one result by any number of words of the system. */
typedef struct cw_adjoint cw_adjoint;

/* Bytes of memory that such a run needs without its tape; -1 when the bytes do not fit this core. */
int64_t cw_adjoint_size(const void* system, int64_t bytes);

/* Start a run in `memory` (aligned to 16 bytes) that writes on `tape`, 24 bytes for each operation of the motion; NULL
   when system or memory do not fit. */
cw_adjoint* cw_adjoint_load(const void* system, int64_t bytes, void* memory, int64_t memory_bytes, void* tape,
                            int64_t tape_bytes);

/* As cw_tangents_set_option. */
int cw_adjoint_set_option(cw_adjoint* run, const char* name, double value);

/* Derivatives by this word of the system are wanted; before the start. Its number on the tape, -1: it has none. The
   steps of the derivatives are those that one direction needs, in which the word changes by `probe`. */
int64_t cw_adjoint_seed(cw_adjoint* run, int64_t word, double probe);

/* As cw_tangents_leave_out_work. */
int cw_adjoint_leave_out_work(cw_adjoint* run);

/* As cw_tangents_advance, with the number on the tape of each number of the rows, 0: a constant, into `numbers`. Status
   interrupted: the tape is full. */
int cw_adjoint_advance(cw_adjoint* run, double t_end, const double* times, double* rows, double* numbers, int64_t n,
                       int64_t* filled);

/* As cw_tangents_events, with the numbers on the tape of their times. */
int64_t cw_adjoint_events(cw_adjoint* run, double* events, double* numbers, int64_t most);

/* As cw_tangents_grazes, with the numbers on the tape of their times, and without what two events at one instant differ
   by. */
int64_t cw_adjoint_grazes(cw_adjoint* run, double* grazes, double* numbers, int64_t most);

/* Numbers on the tape. */
int64_t cw_adjoint_numbers(const cw_adjoint* run);

/* Weights of results, at their numbers on the tape, become derivatives of their sum by all numbers.
   1: done; 0: the tape is full. */
int cw_adjoint_back(const cw_adjoint* run, double* adjoint);

/* As cw_tangents_fault. */
int cw_adjoint_fault(const cw_adjoint* run, double* value);

#ifdef __cplusplus
}
#endif
#endif
