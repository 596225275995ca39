/* Simulates a block of the S-function in the order in which Simulink calls it: outputs, then update. */
#include <stdio.h>

int main(void) {
  static const double step[] = {0.01}, inputs[] = {MODEL_INPUT_LOAD_TORQUE}, wrong[] = {99.0};
  static double u[1], y[MODEL_SIGNALS];
  SimStruct block = {.given = 2, .params = {{step, 1}, {inputs, 1}}, .u = u, .y = y};
  mdlInitializeSizes(&block);
  mdlInitializeSampleTimes(&block);
  mdlStart(&block);
  if (block.inputs != 1 || block.outputs != 1 || block.input_width != 1 || block.step != 0.01) return 2;
  for (int k = 0; k <= 100 && block.error == NULL; ++k) {
    block.time = k * 0.01;
    mdlOutputs(&block, 0);
    for (int n = 0; n < MODEL_SIGNALS; ++n) printf("%.17g%c", y[n], n + 1 < MODEL_SIGNALS ? ' ' : '\n');
    u[0] = k < 50 ? 0.0 : -40.0;
    mdlUpdate(&block, 0);
  }
  if (block.error != NULL) return 3;
  block.params[1].numbers = wrong;
  mdlUpdate(&block, 0);
  mdlTerminate(&block);
  return block.error != NULL && block.work[MEMORY] == NULL ? 0 : 4;
}
