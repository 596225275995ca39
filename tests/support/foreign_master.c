// A master of FMI 3.0 in plain C for any platform: it loads a library, runs a co-simulation and prints what came out in
// hexadecimal, bit for bit. Usage: MASTER LIBRARY TOKEN RESOURCES STEP STEPS INPUT VALUE OUTPUT...
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef _WIN32
#include <windows.h>
static void* load(const char* path) { return (void*)LoadLibraryA(path); }
static void* find(void* library, const char* name) { return (void*)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
static void* load(const char* path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void* find(void* library, const char* name) { return dlsym(library, name); }
#endif

typedef void (*log_message)(void*, int, const char*, const char*);
typedef void* (*instantiate)(const char*, const char*, const char*, _Bool, _Bool, _Bool, _Bool, const uint32_t*, size_t,
                             void*, log_message, void*);
typedef int (*enter)(void*, _Bool, double, double, _Bool, double);
typedef int (*leave)(void*);
typedef int (*set_float64)(void*, const uint32_t*, size_t, const double*, size_t);
typedef int (*get_float64)(void*, const uint32_t*, size_t, double*, size_t);
typedef int (*do_step)(void*, double, double, _Bool, _Bool*, _Bool*, _Bool*, double*);
typedef void (*release)(void*);

static void say(void* environment, int status, const char* category, const char* message) {
  (void)environment;
  fprintf(stderr, "%d %s: %s\n", status, category, message);
}

static int failed(const char* what) {
  fprintf(stderr, "%s failed\n", what);
  return 1;
}

int main(int count, char** word) {
  if (count < 9) return failed("reading the command line");
  void* library = load(word[1]);
  if (!library) return failed("loading the library");
  const instantiate make = (instantiate)find(library, "fmi3InstantiateCoSimulation");
  const enter begin = (enter)find(library, "fmi3EnterInitializationMode");
  const leave begun = (leave)find(library, "fmi3ExitInitializationMode");
  const set_float64 set = (set_float64)find(library, "fmi3SetFloat64");
  const get_float64 get = (get_float64)find(library, "fmi3GetFloat64");
  const do_step step = (do_step)find(library, "fmi3DoStep");
  const release end = (release)find(library, "fmi3FreeInstance");
  if (!make || !begin || !begun || !set || !get || !step || !end) return failed("finding the functions");

  void* one = make("one", word[2], word[3], 0, 1, 0, 0, 0, 0, 0, say, 0);
  if (!one) return failed("instantiation");
  if (begin(one, 0, 0, 0, 0, 0) != 0) return failed("the begin of initialisation");
  const uint32_t input = (uint32_t)strtoul(word[6], 0, 10);
  const double value = strtod(word[7], 0), size = strtod(word[4], 0);
  if (set(one, &input, 1, &value, 1) != 0) return failed("setting an input");
  if (begun(one) != 0) return failed("the end of initialisation");
  const long steps = strtol(word[5], 0, 10);
  for (long k = 0; k < steps; ++k) {
    _Bool event, stop, early;
    double last;
    if (step(one, (double)k * size, size, 1, &event, &stop, &early, &last) != 0) return failed("a step");
  }
  for (int i = 8; i < count; ++i) {
    const uint32_t output = (uint32_t)strtoul(word[i], 0, 10);
    double found = 0;
    if (get(one, &output, 1, &found, 1) != 0) return failed("reading an output");
    uint64_t bits = 0;
    for (int k = 7; k >= 0; --k) bits = bits << 8 | ((unsigned char*)&found)[k];
    printf("%016llx\n", (unsigned long long)bits);
  }
  end(one);
  return 0;
}
