/* What the S-function of an exported model uses of Simulink's header, for one block. */
#include <stddef.h>

typedef int int_T;
typedef struct {
  const double *numbers;
  size_t count;
} mxArray;
typedef struct {
  int expected, given, inputs, outputs, width, input_width, works;
  mxArray params[2];
  double time, step, offset, *u, *y;
  void *work[4];
  const char *error;
} SimStruct;

static inline double *mxGetPr(const mxArray *array) { return (double *)array->numbers; }
static inline size_t mxGetNumberOfElements(const mxArray *array) { return array->count; }
static inline int set_count(int *count, int value) { return *count = value, 1; }

#define ssSetNumSFcnParams(S, n) ((S)->expected = (n))
#define ssGetNumSFcnParams(S) ((S)->expected)
#define ssGetSFcnParamsCount(S) ((S)->given)
#define ssGetSFcnParam(S, k) (&(S)->params[k])
#define ssSetNumInputPorts(S, n) set_count(&(S)->inputs, n)
#define ssSetNumOutputPorts(S, n) set_count(&(S)->outputs, n)
#define ssSetInputPortWidth(S, port, n) ((S)->input_width = (n))
#define ssSetOutputPortWidth(S, port, n) ((S)->width = (n))
#define ssSetInputPortRequiredContiguous(S, port, yes) ((void)(yes))
#define ssSetInputPortDirectFeedThrough(S, port, yes) ((void)(yes))
#define ssSetNumSampleTimes(S, n) ((void)(n))
#define ssSetNumPWork(S, n) ((S)->works = (n))
#define ssSetSampleTime(S, k, value) ((S)->step = (value))
#define ssSetOffsetTime(S, k, value) ((S)->offset = (value))
#define ssSetPWorkValue(S, k, value) ((S)->work[k] = (value))
#define ssGetPWorkValue(S, k) ((S)->work[k])
#define ssGetInputPortRealSignal(S, port) ((S)->u)
#define ssGetOutputPortRealSignal(S, port) ((S)->y)
#define ssGetT(S) ((S)->time)
#define ssSetErrorStatus(S, words) ((S)->error = (words))
