#ifndef CLUTCHWORK_C_API_H
#define CLUTCHWORK_C_API_H

/* The interface of the core for Python, controllers and other programs. Double precision, SI units.
   A run is kept in memory that the caller provides; the bytes of the system must outlive it. Nothing here allocates.

   A call with a null pointer, an index out of range or a number that is not finite is refused, as documented for each
   call, and the run is unchanged. Memory must have the stated length. A run may be used by one thread at a time; any
   number of runs may share the bytes of a system. */

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cw_run cw_run;

/* Fingerprint of every component and of the layout of system, rows and events. */
int64_t cw_schema_hash(void);

/* Bytes of memory that a run of this system needs; -1 when the bytes do not fit this core. */
int64_t cw_size(const void* system, int64_t bytes);

/* The same of a core whose steps of one length have single precision, as this one of double precision reports it; where
   that is this core already, no less than cw_size. */
int64_t cw_single_size(const void* system, int64_t bytes);

/* Start a run, at time zero or at its setting t_start, in `memory` (aligned to 16 bytes); NULL when system or memory do
 * not fit. */
cw_run* cw_load(const void* system, int64_t bytes, void* memory, int64_t memory_bytes);

/* Settings by name: rtol, atol, method (0 auto, 1 rodas5p, 2 dopri5, 3 fixed), step [s] of
   method fixed, first_step [s] (0: chosen by the solver), max_step [s] (INFINITY: no limit), max_steps, max_events,
   angles, work (0 or 1), t_start [s] before the first step. Ranges are those of the options of a run. 1: set; 0:
   unknown, out of range or not a number. */
int cw_set_option(cw_run* run, const char* name, double value);

/* Value of a signal, which it holds from the present time on in place of what the system has for it. 1: set; 0: no such
   signal, or the value is not finite. */
int cw_set_input(cw_run* run, int64_t input, double value);

/* Segments of a signal from the present time on, in place of those of the system and of a value that it holds. Segment
   k starts at times[k] [s], not before the one in front of it; its 12 numbers c at coefficients + 12 k are, s seconds
   after that start,
     c0 + c1 s + c2 s^2 + c3 s^3 + c4 exp(-c7 s) sin(c5 s + c6) + c8 exp(-c11 s) sin(c9 s + c10).
   The first one holds before its start too. A signal of the system that repeats keeps its period, in which all starts
   lie. The run has a copy in its own memory, with room for as many segments as the system has for that signal, and so
   has its saved state. What is past is not asked for: the segment of the present time may be the first one.
   1: set; 0: no such signal, more segments than that or none, starts that fall, or a number that is not finite. */
int cw_set_segments(cw_run* run, int64_t input, const double* times, const double* coefficients, int64_t n);

/* Let a signal follow the system again. 1: done, also where it did so already; 0: no such signal, or one that is set
   from outside alone. */
int cw_release_input(cw_run* run, int64_t input);

/* Whether values of signals may be set between calls: what all signals do at the very end of cw_advance then waits for
   them, so that each instant is decided once. Off at the start, where the system has no signal that is set from outside
   alone. It is not part of a saved state. 1: set; 0: no run. */
int cw_expect_inputs(cw_run* run, int expected);

/* Which numbers of rows somebody reads, and which of rows in steps in which nothing happens: `inside`, some of them.
   Both lists stay with the caller while the run goes on. Rows at the ends of the run and beside events and knots may
   lack angles and work that nobody reads, other rows whatever is not in `inside`; they have it as it was. The steps are
   the same. It is not part of a saved state. 1: set; 0: no run, or a number that no row has. */
int cw_read(cw_run* run, const int64_t* numbers, int64_t n, const int64_t* inside, int64_t n_inside);

/* A number of the parameter pool, before the run starts or between calls. 1: set; 0: no such number, the value is not
   finite, or the number is fixed because it locates a curve or selects a variant, such as an extrapolation. */
int cw_set_param(cw_run* run, int64_t offset, double value);

/* A function that cw_advance calls after every step and every row of a grid; when it returns other than 0, cw_advance
   returns with status interrupted, at most one step later. NULL: none, as at the start. It must not use the run. It is
   not part of a saved state. 1: set; 0: no run. */
int cw_set_poll(cw_run* run, int (*poll)(void* context), void* context);

/* Integrate to t_end [s]. Grid: `times` holds n requested times, not decreasing, rows are filled for those that were
   reached. Steps: `steps` rows are filled per step, in equal parts, the last at its end, and the right limit after an
   event; `times` is written. `filled` counts the rows; NULL: not needed.
   Every row is finite: a run in which a number overflows ends with status not_finite before that row; without rows
   only the state is checked.
   Returns a status code; -1: refused because t_end is not finite or before the present time, n or steps is negative,
   or times or rows are NULL although n is not 0. After rows_full, events_full and interrupted it may be called again.
 */
int cw_advance(cw_run* run, double t_end, double* times, double* rows, int64_t n, int steps, int64_t* filled);

/* As cw_advance with one row per step, but a step that is longer than `spacing` [s], greater than 0, has several in
   equal parts that are not. There is room for the rest of the run with this spacing, four more; else rows_full. Steps
   of one length have one row each. */
int cw_advance_spaced(cw_run* run, double t_end, double spacing, double* times, double* rows, int64_t n,
                      int64_t* filled);

/* As cw_advance without rows, but it returns right after the first instant at which a contact changes its state, with
   steps of one length at the end of that step: `done` at cw_time, with events that wait. Take the events that wait
   before. */
int cw_advance_to_event(cw_run* run, double t_end);

/* The first instant [s] after the present time at which a signal of the system has a knot; INFINITY: none, or a null
   pointer. */
double cw_next_knot(const cw_run* run);

/* A run of a group and where its rows go; status and filled are written. All as in cw_advance. */
typedef struct {
  cw_run* run;
  double *times, *rows;
  int64_t n;
  int steps, status;
  int64_t filled;
} cw_member;

/* Bytes of memory in which runs of this system, and of others with the same structure, advance together; 0: it needs
   none, -1 for a null pointer. */
int64_t cw_group_size(const cw_run* run);

/* Advance runs to t_end [s], each with the bits of a call of cw_advance, but faster where eight in a row are of systems
   that differ in numbers alone: they take their steps together (docs/theory/lanes.md). The memory is not needed after
   the call. No run may be there twice. 0: done, see each status; -1: refused and nothing changed, because of a null
   pointer, a negative count, or less memory than cw_group_size of each run. */
int cw_advance_group(cw_member* members, int64_t count, double t_end, void* memory, int64_t memory_bytes);

/* Present time [s]; NaN for a null pointer. */
double cw_time(const cw_run* run);

/* Numbers in one row (-1 for a null pointer), and the row at the present time: a status as of cw_advance, the row is
   filled when it is 0 (done). */
int64_t cw_row_size(const cw_run* run);
int cw_row(cw_run* run, double* row);

/* Derivatives of all components at the present time, the modes of all contacts held: rows and columns of the matrix
   (nothing for null pointers), and the matrix, row by row, with the row of output at this instant, as cw_row gives it;
   its status. Rows: torque of each element, then of each contact (zero where it is locked or open); rate of each state;
   static torque of each contact, against the slip that its torque resists; most torque that each contact holds, then
   least, infinite where there is no bound; value of each flow. Columns: rate of each element and contact, each state,
   each signal, and last the value itself. docs/theory/linearisation.md (2) */
void cw_local_size(const cw_run* run, int64_t* rows, int64_t* columns);
int cw_local(cw_run* run, double* row, double* matrix);

/* Model exchange: another solver has time and state, the run has the modes. docs/theory/model-exchange.md
   Numbers of the state (speeds, states, angles, works) and of the margins; nothing for null pointers. */
void cw_place_size(const cw_run* run, int64_t* states, int64_t* margins);

/* The present state; nothing before the first row, or for null pointers. */
void cw_states(const cw_run* run, double* x);

/* As cw_set_input, but for a signal that goes on smoothly, with a time derivative: nothing is decided. 1: set; 0: as
   there. */
int cw_place_input(cw_run* run, int64_t input, double value, double slope);

/* Take time and state, modes held and signals on their segments, and give the row there: a status as of cw_advance; -1:
   refused because a number is not finite, before the first row, or for a null pointer. The state is not checked. The
   speeds are then those on which what is locked has no slip: see cw_states. */
int cw_place(cw_run* run, double t, const double* x, double* row);

/* After cw_place: the time derivative of the state, and the margins: above zero while nothing needs a decision.
   Nothing for null pointers. */
void cw_rates(const cw_run* run, double* dx);
void cw_margins(cw_run* run, double* margins);

/* After cw_place: decide what is due, all contacts together; `anew`: signals may have jumped here. The time stays, the
   state may be another one; the row and the margins are those after it. A status as of cw_advance. The events wait. */
int cw_decide(cw_run* run, int anew, double* row, double* margins);

/* Numbers in one event. */
int64_t cw_event_size(void);

/* How many events wait to be taken; -1 for a null pointer. */
int64_t cw_pending_events(const cw_run* run);

/* Take the pending events: writes up to `room` of them, returns how many; -1: refused because `room` is negative, or
   `events` is NULL although it is not 0. */
int64_t cw_take_events(cw_run* run, double* events, int64_t room);

/* Counters: steps, rejected, evaluations, jacobians, events, phases, locations. Nothing for null pointers. */
void cw_statistics(const cw_run* run, int64_t counts[7]);

/* Where a failure happened: component (elements, then contacts; -1 none) and value. */
int64_t cw_detail(const cw_run* run, double* value);

/* After not_finite: which number of a row is not finite; -1 when it was found elsewhere. */
int64_t cw_detail_row(const cw_run* run);

/* Complete state of a run, bit for bit: bytes of it, more while segments are set (-1 for a null pointer); write them to
   memory of `room` bytes and return their number (-1: refused because there is too little room, or a null pointer). The
   bytes contain no pointers. They carry the versions of core and state, a fingerprint of the system, their size and a
   checksum. */
int64_t cw_state_size(const cw_run* run);
int64_t cw_save(const cw_run* run, void* bytes, int64_t room);

/* Restore a run of the same system, in any memory, to the state in which cw_save was called: it continues with the same
   bits. Options, inputs, segments and parameters are restored too. 1: done; 0: refused and the run unchanged, because
   the state belongs to another system or version, has another size, is damaged, or contains an impossible value. */
int cw_restore(cw_run* run, const void* bytes, int64_t n);

/* A copy of a run within one process, some twenty times as fast as cw_save: writes as many bytes as cw_size gives to
   memory of any alignment and returns their number; -1: refused because there is too little room, or a null pointer. */
int64_t cw_copy(const cw_run* run, void* copy, int64_t room);

/* Make a run of the same system bytes, in any memory, what the copied one was: it continues with the same bits. What
   cw_set_poll and cw_expect_inputs say stays that of the run. The copy must come from this process, unchanged. 1: done;
   0: refused and the run unchanged, because it is a copy of a run of another system. */
int cw_paste(cw_run* run, const void* copy, int64_t bytes);

/* Kinetic coefficient at a slip and static coefficient of a law at its inputs (such as a temperature). 1: done; 0: no
   such law, or a null pointer for params, kinetic or hold. */
int cw_law(int number, const double* params, const double* inputs, const double* points, int64_t n_points, double slip,
           double* kinetic, double* hold);

#ifdef __cplusplus
}
#endif
#endif
