/* The model as a level 2 S-function of Simulink. In this folder, in MATLAB:
     system('make build/libclutchwork.a')
     mex -Icore/include model_sfun.c model.c model_system.c build/libclutchwork.a
   Block S-Function, name model_sfun, parameters: step [s], inputs.
   The inputs are numbers of enum model_input, such as [1 2]: the elements of the input port, each held over a step. All
   other signals follow the model. The output port has all signals of model_signals, in their order. */
#define S_FUNCTION_NAME model_sfun
#define S_FUNCTION_LEVEL 2

#include <stdint.h>
#include <stdlib.h>

#include "simstruc.h"
#include "model.h"

/* places of what an instance keeps */
enum { RUN, MEMORY, WORK };

static double step_of(SimStruct *S) { return mxGetPr(ssGetSFcnParam(S, 0))[0]; }
static int inputs_of(SimStruct *S) { return (int)mxGetNumberOfElements(ssGetSFcnParam(S, 1)); }
static int64_t input_of(SimStruct *S, int k) { return (int64_t)mxGetPr(ssGetSFcnParam(S, 1))[k]; }

static void mdlInitializeSizes(SimStruct *S) {
  ssSetNumSFcnParams(S, 2);
  if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) return;
  const int inputs = inputs_of(S);
  if (!ssSetNumInputPorts(S, inputs > 0) || !ssSetNumOutputPorts(S, 1)) return;
  if (inputs > 0) {
    ssSetInputPortWidth(S, 0, inputs);
    ssSetInputPortRequiredContiguous(S, 0, 1);
    ssSetInputPortDirectFeedThrough(S, 0, 0);
  }
  ssSetOutputPortWidth(S, 0, MODEL_SIGNALS);
  ssSetNumSampleTimes(S, 1);
  ssSetNumPWork(S, WORK);
}

static void mdlInitializeSampleTimes(SimStruct *S) {
  ssSetSampleTime(S, 0, step_of(S));
  ssSetOffsetTime(S, 0, 0.0);
}

#define MDL_START
static void mdlStart(SimStruct *S) {
  /* with room to align it */
  char *memory = (char *)malloc(MODEL_MEMORY + 16);
  ssSetPWorkValue(S, MEMORY, memory);
  ssSetPWorkValue(S, RUN, NULL);
  if (memory == NULL) {
    ssSetErrorStatus(S, "no memory for a run of the model");
    return;
  }
  memory += (16 - (uintptr_t)memory % 16) % 16;
  cw_run *run = cw_load(model_system, MODEL_SYSTEM_BYTES, memory, MODEL_MEMORY);
  if (run == NULL || !model_set_options(run)) {
    ssSetErrorStatus(S, "the model does not fit this core or this machine");
    return;
  }
  cw_expect_inputs(run, 1);
  ssSetPWorkValue(S, RUN, run);
}

static void mdlOutputs(SimStruct *S, int_T tid) {
  (void)tid;
  cw_run *run = (cw_run *)ssGetPWorkValue(S, RUN);
  double row[MODEL_ROW_SIZE], *y = ssGetOutputPortRealSignal(S, 0);
  if (run == NULL || cw_row(run, row) != MODEL_STATUS_DONE) {
    ssSetErrorStatus(S, "a number of the model is not finite");
    return;
  }
  for (int k = 0; k < MODEL_SIGNALS; ++k) y[k] = model_signals[k].value(row);
}

#define MDL_UPDATE
static void mdlUpdate(SimStruct *S, int_T tid) {
  (void)tid;
  cw_run *run = (cw_run *)ssGetPWorkValue(S, RUN);
  const double *u = inputs_of(S) > 0 ? ssGetInputPortRealSignal(S, 0) : NULL;
  for (int k = 0; k < inputs_of(S); ++k) {
    if (cw_set_input(run, input_of(S, k), u[k])) continue;
    ssSetErrorStatus(S, "the second parameter has a number that is not in enum model_input, or an input is not finite");
    return;
  }
  double event[MODEL_EVENT_SIZE];
  const double end = MODEL_T_START + ssGetT(S) + step_of(S);
  int status;
  do {
    status = cw_advance(run, end, NULL, NULL, 0, 0, NULL);
    while (cw_take_events(run, event, 1) == 1) {
    }
  } while (status == MODEL_STATUS_EVENTS_FULL);
  if (status != MODEL_STATUS_DONE) ssSetErrorStatus(S, "the run cannot go on: see MODEL_STATUS_... in model.h");
}

static void mdlTerminate(SimStruct *S) {
  free(ssGetPWorkValue(S, MEMORY));
  ssSetPWorkValue(S, MEMORY, NULL);
}

#ifdef MATLAB_MEX_FILE
#include "simulink.c"
#else
#include "cg_sfun.h"
#endif
