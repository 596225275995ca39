#ifndef CLUTCHWORK_C_API_H
#define CLUTCHWORK_C_API_H

/* The narrow line between the core and its doors: Python, FMU, controller. Double precision, SI units.
   A run lives in memory that the caller gives; the bytes of the system must outlive it. Nothing here allocates. */

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cw_run cw_run;

/* Fingerprint of every component and of the layout of system, rows and events. */
int64_t cw_schema_hash(void);

/* Bytes of memory that a run of this system needs; -1 when the bytes do not fit this core. */
int64_t cw_size(const void* system, int64_t bytes);

/* Start a run at time zero in `memory` (aligned to 16 bytes); NULL when system or memory do not fit. */
cw_run* cw_load(const void* system, int64_t bytes, void* memory, int64_t memory_bytes);

/* Settings by name: rtol, atol, method, first_step, max_step, max_steps, max_events, angles, work. 0: unknown or out of
 * range. */
int cw_set_option(cw_run* run, const char* name, double value);

/* Value of a signal that is set from outside; 0: no such signal. */
int cw_set_input(cw_run* run, int64_t input, double value);

/* A number of the parameter pool, before the run starts or between calls; 0: no such number. */
int cw_set_param(cw_run* run, int64_t offset, double value);

/* Integrate to t_end [s]. Grid: `times` holds n requested times, rows are filled for those that were reached.
   Steps: rows are filled per step, `times` is written. `filled` counts the rows. Returns a status code. */
int cw_advance(cw_run* run, double t_end, double* times, double* rows, int64_t n, int steps, int64_t* filled);

/* Present time [s]. */
double cw_time(const cw_run* run);

/* Numbers in one row, and the row at the present time. */
int64_t cw_row_size(const cw_run* run);
int cw_row(cw_run* run, double* row);

/* Numbers in one event. */
int64_t cw_event_size(void);

/* Take the waiting events: writes up to `room` of them, returns how many. */
int64_t cw_take_events(cw_run* run, double* events, int64_t room);

/* Counters: steps, rejected, evaluations, jacobians, events, phases, locations. */
void cw_statistics(const cw_run* run, int64_t counts[7]);

/* Where a failure happened: component (elements, then contacts; -1 none) and value. */
int64_t cw_detail(const cw_run* run, double* value);

/* Complete state, bit for bit: cw_size bytes. Restore works in any run of the same system. */
void cw_save(const cw_run* run, void* bytes);
int cw_restore(cw_run* run, const void* bytes, int64_t n);

/* Kinetic coefficient at a slip and static coefficient of a law at its inputs (as a temperature); 0: no such law. */
int cw_law(int number, const double* params, const double* inputs, const double* points, int64_t n_points, double slip,
           double* kinetic, double* hold);

#ifdef __cplusplus
}
#endif
#endif
