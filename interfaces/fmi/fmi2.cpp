#include <cstring>

#include "calls.hpp"
#include "files.hpp"

/// The functions of FMI 2.0, by names and types of the standard (https://fmi-standard.org).

using namespace clutchwork::fmi;

#ifdef _WIN32
#define FMI_EXPORT extern "C" __declspec(dllexport)
#else
#define FMI_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace {

using Reference = unsigned int;
using Logger = void (*)(void* environment, const char* instance, int status, const char* category, const char* message,
                        ...);

struct Callbacks {
  Logger logger;
  void* (*allocate)(std::size_t, std::size_t);
  void (*release)(void*);
  void (*step_finished)(void*, int);
  void* environment;
};

struct EventInfo {
  int discrete_states_needed, terminate, nominals_changed, states_changed, next_time_defined;
  double next_time;
};

struct Component {
  Logger logger;
  void* environment;
  std::string name;
  Instance* instance;
};

void say(void* who, Answer answer, const char* category, const char* text) {
  const auto* component = static_cast<Component*>(who);
  if (component->logger != nullptr)
    component->logger(component->environment, component->name.c_str(), int(answer), category, "%s", text);
}

Instance* of(void* c) { return c == nullptr ? nullptr : static_cast<Component*>(c)->instance; }

/// A call of model exchange.
template <class Deed>
int exchange(void* c, unsigned stages, const char* call, Deed&& deed) {
  return int(allowed(of(c), stages, call, [&](Instance& it) {
    return it.exchanges() ? deed(it) : it.refuse(std::string(call) + " is for instances of model exchange");
  }));
}

/// A value as a number of its type.
template <class X>
int get(void* c, const char* call, bool whole, const Reference* references, std::size_t n, X* values) {
  return int(allowed(of(c), any_stage & ~in(Stage::instantiated), call, [&](Instance& it) {
    if (n > 0 && (references == nullptr || values == nullptr)) return it.refuse(std::string(call) + " has no values");
    return each(n, [&](std::size_t i) {
      const Variable* one = it.variable(references[i]);
      if (one != nullptr && (one->kind == Kind::mode) != whole)
        return it.refuse("'" + one->name + "' has another type: use " + (whole ? "fmi2GetReal" : "fmi2GetInteger"));
      double value = 0;
      const Answer answer = it.get(references[i], &value);
      values[i] = X(value);
      return answer;
    });
  }));
}

/// Values of a type that no variable has.
int none(void* c, const char* call, std::size_t n) {
  return int(allowed(of(c), any_stage, call, [&](Instance& it) {
    return n == 0 ? Answer::ok : it.refuse(std::string(call) + ": no variable of this FMU has that type");
  }));
}

}  // namespace

FMI_EXPORT const char* fmi2GetTypesPlatform() { return "default"; }
FMI_EXPORT const char* fmi2GetVersion() { return "2.0"; }

FMI_EXPORT int fmi2SetDebugLogging(void* c, int on, std::size_t n, const char* const names[]) {
  return int(allowed(of(c), any_stage, "fmi2SetDebugLogging", [&](Instance& it) {
    for (int k = 0; k < categories && n == 0; ++k) it.log(on != 0, Category(k));
    if (n > 0 && names == nullptr) return it.refuse("there are no names of log categories");
    return each(n, [&](std::size_t i) {
      for (int k = 0; k < categories; ++k)
        if (names[i] != nullptr && std::strcmp(names[i], category_names[k]) == 0)
          return it.log(on != 0, Category(k)), Answer::ok;
      return it.refuse("there is no log category of that name: error, warning, events");
    });
  }));
}

FMI_EXPORT void* fmi2Instantiate(const char* name, int type, const char* guid, const char* location,
                                 const Callbacks* callbacks, int, int logging) {
  auto* made =
      new Component{callbacks != nullptr ? callbacks->logger : nullptr,
                    callbacks != nullptr ? callbacks->environment : nullptr, name != nullptr ? name : "", nullptr};
  const Listener listener{made, say};
  const Purpose purpose = type == 0 ? Purpose::model_exchange : Purpose::co_simulation;
  made->instance = Instance::make(resource_path(location), guid, listener, purpose);
  if (made->instance == nullptr) {
    delete made;
    return nullptr;
  }
  if (logging != 0) made->instance->log(true, Category::events);
  return made;
}

FMI_EXPORT void fmi2FreeInstance(void* c) {
  if (c == nullptr) return;
  delete of(c);
  delete static_cast<Component*>(c);
}

FMI_EXPORT int fmi2SetupExperiment(void* c, int has_tolerance, double tolerance, double start, int, double) {
  return int(allowed(of(c), in(Stage::instantiated), "fmi2SetupExperiment",
                     [&](Instance& it) { return it.experiment(start, has_tolerance != 0, tolerance); }));
}

FMI_EXPORT int fmi2EnterInitializationMode(void* c) {
  return int(allowed(of(c), in(Stage::instantiated), "fmi2EnterInitializationMode",
                     [&](Instance& it) { return it.initialize(); }));
}

FMI_EXPORT int fmi2ExitInitializationMode(void* c) {
  return int(allowed(of(c), in(Stage::initialization), "fmi2ExitInitializationMode",
                     [&](Instance& it) { return it.enter(it.exchanges() ? Stage::event : Stage::step); }));
}

FMI_EXPORT int fmi2Terminate(void* c) {
  return int(allowed(of(c), running, "fmi2Terminate", [&](Instance& it) { return it.enter(Stage::terminated); }));
}

FMI_EXPORT int fmi2Reset(void* c) {
  return int(allowed(of(c), any_stage, "fmi2Reset", [&](Instance& it) { return it.reset(), Answer::ok; }));
}

FMI_EXPORT int fmi2GetReal(void* c, const Reference* references, std::size_t n, double* values) {
  return get(c, "fmi2GetReal", false, references, n, values);
}

FMI_EXPORT int fmi2GetInteger(void* c, const Reference* references, std::size_t n, int* values) {
  return get(c, "fmi2GetInteger", true, references, n, values);
}

FMI_EXPORT int fmi2GetBoolean(void* c, const Reference*, std::size_t n, int*) { return none(c, "fmi2GetBoolean", n); }
FMI_EXPORT int fmi2GetString(void* c, const Reference*, std::size_t n, const char**) {
  return none(c, "fmi2GetString", n);
}

FMI_EXPORT int fmi2SetReal(void* c, const Reference* references, std::size_t n, const double* values) {
  return int(allowed(of(c), before_steps | running, "fmi2SetReal", [&](Instance& it) {
    if (n > 0 && (references == nullptr || values == nullptr)) return it.refuse("fmi2SetReal has no values");
    const Answer checked = each(n, [&](std::size_t i) { return it.check(references[i], values[i]); });
    return checked != Answer::ok ? checked : each(n, [&](std::size_t i) { return it.set(references[i], values[i]); });
  }));
}

FMI_EXPORT int fmi2SetInteger(void* c, const Reference*, std::size_t n, const int*) {
  return none(c, "fmi2SetInteger", n);
}
FMI_EXPORT int fmi2SetBoolean(void* c, const Reference*, std::size_t n, const int*) {
  return none(c, "fmi2SetBoolean", n);
}
FMI_EXPORT int fmi2SetString(void* c, const Reference*, std::size_t n, const char* const*) {
  return none(c, "fmi2SetString", n);
}

FMI_EXPORT int fmi2SetRealInputDerivatives(void* c, const Reference* references, std::size_t n, const int* orders,
                                           const double* values) {
  return int(allowed(of(c), before_steps | running, "fmi2SetRealInputDerivatives", [&](Instance& it) {
    if (n > 0 && (references == nullptr || values == nullptr || orders == nullptr))
      return it.refuse("fmi2SetRealInputDerivatives has no values");
    return each(n, [&](std::size_t i) { return it.set_slope(references[i], orders[i], values[i]); });
  }));
}

FMI_EXPORT int fmi2GetRealOutputDerivatives(void* c, const Reference* references, std::size_t n, const int* orders,
                                            double* rates) {
  return output_rates(of(c), "fmi2GetRealOutputDerivatives", references, n, orders, rates);
}

FMI_EXPORT int fmi2DoStep(void* c, double from, double size, int) {
  return int(allowed(of(c), in(Stage::step, Stage::failed), "fmi2DoStep", [&](Instance& it) {
    if (it.exchanges()) return it.refuse("fmi2DoStep is for instances of co-simulation");
    const Answer answer = it.step(from, size, false).answer;
    if (answer == Answer::ok) it.forget_slopes();
    return answer;
  }));
}

FMI_EXPORT int fmi2CancelStep(void* c) {
  return int(allowed(of(c), any_stage, "fmi2CancelStep",
                     [](Instance& it) { return it.refuse("a step is never pending, so that none can be cancelled"); }));
}

FMI_EXPORT int fmi2GetStatus(void*, int, int*) { return int(Answer::discard); }
FMI_EXPORT int fmi2GetRealStatus(void* c, int kind, double* value) {
  return int(allowed(of(c), any_stage, "fmi2GetRealStatus", [&](Instance& it) {
    if (kind != 2 || value == nullptr) return Answer::discard;
    return *value = it.time(), Answer::ok;
  }));
}
FMI_EXPORT int fmi2GetIntegerStatus(void*, int, int*) { return int(Answer::discard); }
FMI_EXPORT int fmi2GetBooleanStatus(void* c, int kind, int* value) {
  if (kind != 3 || value == nullptr || c == nullptr) return int(Answer::discard);
  return *value = 0, int(Answer::ok);
}
FMI_EXPORT int fmi2GetStringStatus(void*, int, const char**) { return int(Answer::discard); }

// ------------------------------------------------------------------------------------------------------------- states

FMI_EXPORT int fmi2GetFMUstate(void* c, void** state) { return get_state(of(c), "fmi2GetFMUstate", state); }

FMI_EXPORT int fmi2SetFMUstate(void* c, void* state) {
  return int(allowed(of(c), any_stage, "fmi2SetFMUstate", [&](Instance& it) {
    return state == nullptr ? it.refuse("there is no state") : it.go_to(*static_cast<State*>(state));
  }));
}

FMI_EXPORT int fmi2FreeFMUstate(void* c, void** state) { return free_state(of(c), "fmi2FreeFMUstate", state); }

FMI_EXPORT int fmi2SerializedFMUstateSize(void* c, void* state, std::size_t* size) {
  return state_size(of(c), "fmi2SerializedFMUstateSize", state, size);
}

FMI_EXPORT int fmi2SerializeFMUstate(void* c, void* state, char bytes[], std::size_t size) {
  return serialize_state(of(c), "fmi2SerializeFMUstate", state, bytes, size);
}

FMI_EXPORT int fmi2DeSerializeFMUstate(void* c, const char bytes[], std::size_t size, void** state) {
  return deserialize_state(of(c), "fmi2DeSerializeFMUstate", bytes, size, state);
}

FMI_EXPORT int fmi2GetDirectionalDerivative(void* c, const Reference* unknowns, std::size_t n, const Reference* knowns,
                                            std::size_t n_knowns, const double* seed, double* found) {
  return derivatives(of(c), "fmi2GetDirectionalDerivative", {unknowns, n}, {knowns, n_knowns},
                     seed != nullptr && found != nullptr,
                     [&](Instance& it) { return it.derivatives({unknowns, n}, {knowns, n_knowns}, seed, found); });
}

// ----------------------------------------------------------------------------------------------------- model exchange

FMI_EXPORT int fmi2EnterEventMode(void* c) {
  return exchange(c, in(Stage::step), "fmi2EnterEventMode", [](Instance& it) { return it.enter(Stage::event); });
}

FMI_EXPORT int fmi2NewDiscreteStates(void* c, EventInfo* info) {
  return exchange(c, in(Stage::event), "fmi2NewDiscreteStates", [&](Instance& it) {
    if (info == nullptr) return it.refuse("fmi2NewDiscreteStates has no place for what it tells");
    bool changed = false;
    const Answer answer = it.decide(&changed);
    *info = EventInfo{0, 0, 0, changed, it.has_next_knot(), it.next_knot()};
    return answer;
  });
}

FMI_EXPORT int fmi2EnterContinuousTimeMode(void* c) {
  return exchange(c, in(Stage::event), "fmi2EnterContinuousTimeMode",
                  [](Instance& it) { return it.enter(Stage::step); });
}

FMI_EXPORT int fmi2CompletedIntegratorStep(void* c, int, int* event, int* terminate) {
  return exchange(c, in(Stage::step), "fmi2CompletedIntegratorStep", [&](Instance&) {
    if (event != nullptr) *event = 0;
    if (terminate != nullptr) *terminate = 0;
    return Answer::ok;
  });
}

FMI_EXPORT int fmi2SetTime(void* c, double t) {
  return exchange(c, running, "fmi2SetTime", [&](Instance& it) { return it.set_time(t); });
}

FMI_EXPORT int fmi2SetContinuousStates(void* c, const double* x, std::size_t n) {
  return exchange(c, running, "fmi2SetContinuousStates", [&](Instance& it) { return it.set_states(x, n); });
}

FMI_EXPORT int fmi2GetDerivatives(void* c, double* dx, std::size_t n) {
  return exchange(c, evaluated, "fmi2GetDerivatives", [&](Instance& it) { return it.rates(dx, n); });
}

FMI_EXPORT int fmi2GetEventIndicators(void* c, double* z, std::size_t n) {
  return exchange(c, evaluated, "fmi2GetEventIndicators", [&](Instance& it) { return it.margins(z, n); });
}

FMI_EXPORT int fmi2GetContinuousStates(void* c, double* x, std::size_t n) {
  return exchange(c, evaluated, "fmi2GetContinuousStates", [&](Instance& it) { return it.get_states(x, n); });
}

FMI_EXPORT int fmi2GetNominalsOfContinuousStates(void* c, double* sizes, std::size_t n) {
  return exchange(c, evaluated, "fmi2GetNominalsOfContinuousStates",
                  [&](Instance& it) { return it.nominals(sizes, n); });
}
