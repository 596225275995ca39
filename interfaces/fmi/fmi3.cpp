#include <cstring>

#include "calls.hpp"
#include "files.hpp"

/// The functions of FMI 3.0, by names and types of the standard (https://fmi-standard.org).

using namespace clutchwork::fmi;

#ifdef _WIN32
#define FMI_EXPORT extern "C" __declspec(dllexport)
#else
#define FMI_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace {

using Reference = std::uint32_t;
using Logger = void (*)(void* environment, int status, const char* category, const char* message);

struct Component {
  Logger logger;
  void* environment;
  Instance* instance;
  bool has_event_mode, may_return_early;
};

void say(void* who, Answer answer, const char* category, const char* text) {
  const auto* component = static_cast<Component*>(who);
  if (component->logger != nullptr) component->logger(component->environment, int(answer), category, text);
}

Instance* of(void* c) { return c == nullptr ? nullptr : static_cast<Component*>(c)->instance; }

/// A call that no variable of these FMUs has a use for; nothing asked is no error.
int none(void* c, const char* call, std::size_t n, const char* why) {
  return int(allowed(of(c), any_stage, call,
                     [&](Instance& it) { return n == 0 ? Answer::ok : it.refuse(std::string(call) + ": " + why); }));
}

constexpr const char* no_type = "no variable of this FMU has that type";
constexpr const char* no_schedule = "this FMU has no scheduled execution";
constexpr const char* no_clocks = "this FMU has no clocks";

template <class X>
int get(void* c, const char* call, bool whole, const Reference* references, std::size_t n, X* values,
        std::size_t room) {
  return int(allowed(of(c), any_stage & ~in(Stage::instantiated), call, [&](Instance& it) {
    if (n > 0 && (references == nullptr || values == nullptr || room < n))
      return it.refuse(std::string(call) + " has no room for the values");
    return each(n, [&](std::size_t i) {
      const Variable* one = it.variable(references[i]);
      if (one != nullptr && (one->kind == Kind::mode) != whole)
        return it.refuse("'" + one->name + "' has another type: use " + (whole ? "fmi3GetFloat64" : "fmi3GetInt32"));
      double value = 0;
      const Answer answer = it.get(references[i], &value);
      values[i] = X(value);
      return answer;
    });
  }));
}

/// A call of model exchange.
template <class Deed>
int exchange(void* c, unsigned stages, const char* call, Deed&& deed) {
  return int(allowed(of(c), stages, call, [&](Instance& it) {
    return it.exchanges() ? deed(it) : it.refuse(std::string(call) + " is for instances of model exchange");
  }));
}

void* made(Component* component, const char* token, const char* location, bool logging, Purpose purpose) {
  component->instance = Instance::make(resource_path(location), token, Listener{component, say}, purpose);
  if (component->instance == nullptr) {
    delete component;
    return nullptr;
  }
  if (logging) component->instance->log(true, Category::events);
  return component;
}

}  // namespace

FMI_EXPORT const char* fmi3GetVersion() { return "3.0"; }

FMI_EXPORT int fmi3SetDebugLogging(void* c, bool on, std::size_t n, const char* const names[]) {
  return int(allowed(of(c), any_stage, "fmi3SetDebugLogging", [&](Instance& it) {
    for (int k = 0; k < categories && n == 0; ++k) it.log(on, Category(k));
    if (n > 0 && names == nullptr) return it.refuse("there are no names of log categories");
    return each(n, [&](std::size_t i) {
      for (int k = 0; k < categories; ++k)
        if (names[i] != nullptr && std::strcmp(names[i], category_names[k]) == 0)
          return it.log(on, Category(k)), Answer::ok;
      return it.refuse("there is no log category of that name: error, warning, events");
    });
  }));
}

FMI_EXPORT void* fmi3InstantiateCoSimulation(const char*, const char* token, const char* location, bool, bool logging,
                                             bool has_event_mode, bool may_return_early, const Reference*, std::size_t,
                                             void* environment, Logger logger, void*) {
  auto* component = new Component{logger, environment, nullptr, has_event_mode, may_return_early};
  return made(component, token, location, logging, Purpose::co_simulation);
}

FMI_EXPORT void* fmi3InstantiateModelExchange(const char*, const char* token, const char* location, bool, bool logging,
                                              void* environment, Logger logger) {
  auto* component = new Component{logger, environment, nullptr, true, false};
  return made(component, token, location, logging, Purpose::model_exchange);
}

FMI_EXPORT void* fmi3InstantiateScheduledExecution(const char*, const char*, const char*, bool, bool, void* environment,
                                                   Logger logger, void*, void*, void*) {
  if (logger != nullptr) logger(environment, int(Answer::error), category_names[0], no_schedule);
  return nullptr;
}

FMI_EXPORT void fmi3FreeInstance(void* c) {
  if (c == nullptr) return;
  delete of(c);
  delete static_cast<Component*>(c);
}

FMI_EXPORT int fmi3EnterInitializationMode(void* c, bool has_tolerance, double tolerance, double start, bool, double) {
  return int(allowed(of(c), in(Stage::instantiated), "fmi3EnterInitializationMode", [&](Instance& it) {
    return worse(it.experiment(start, has_tolerance, tolerance), it.initialize());
  }));
}

FMI_EXPORT int fmi3ExitInitializationMode(void* c) {
  return int(allowed(of(c), in(Stage::initialization), "fmi3ExitInitializationMode", [&](Instance& it) {
    return it.enter(static_cast<Component*>(c)->has_event_mode ? Stage::event : Stage::step);
  }));
}

FMI_EXPORT int fmi3EnterEventMode(void* c) {
  return int(allowed(of(c), in(Stage::step), "fmi3EnterEventMode", [&](Instance& it) {
    if (!static_cast<Component*>(c)->has_event_mode) return it.refuse("event mode was not asked for at instantiation");
    return it.enter(Stage::event);
  }));
}

FMI_EXPORT int fmi3EnterStepMode(void* c) {
  return int(allowed(of(c), in(Stage::event), "fmi3EnterStepMode", [&](Instance& it) {
    return it.exchanges() ? it.refuse("fmi3EnterStepMode is for instances of co-simulation") : it.enter(Stage::step);
  }));
}

FMI_EXPORT int fmi3Terminate(void* c) {
  return int(allowed(of(c), running, "fmi3Terminate", [&](Instance& it) { return it.enter(Stage::terminated); }));
}

FMI_EXPORT int fmi3Reset(void* c) {
  return int(allowed(of(c), any_stage, "fmi3Reset", [&](Instance& it) { return it.reset(), Answer::ok; }));
}

// ---------------------------------------------------------------------------------------------------------- variables

FMI_EXPORT int fmi3GetFloat64(void* c, const Reference r[], std::size_t n, double values[], std::size_t room) {
  return get(c, "fmi3GetFloat64", false, r, n, values, room);
}

FMI_EXPORT int fmi3GetInt32(void* c, const Reference r[], std::size_t n, std::int32_t values[], std::size_t room) {
  return get(c, "fmi3GetInt32", true, r, n, values, room);
}

FMI_EXPORT int fmi3SetFloat64(void* c, const Reference r[], std::size_t n, const double values[], std::size_t given) {
  return int(allowed(of(c), before_steps | running, "fmi3SetFloat64", [&](Instance& it) {
    if (n > 0 && (r == nullptr || values == nullptr || given < n)) return it.refuse("fmi3SetFloat64 has no values");
    const Answer checked = each(n, [&](std::size_t i) { return it.check(r[i], values[i]); });
    return checked != Answer::ok ? checked : each(n, [&](std::size_t i) { return it.set(r[i], values[i]); });
  }));
}

FMI_EXPORT int fmi3GetFloat32(void* c, const Reference*, std::size_t n, float*, std::size_t) {
  return none(c, "fmi3GetFloat32", n, no_type);
}
FMI_EXPORT int fmi3GetInt8(void* c, const Reference*, std::size_t n, std::int8_t*, std::size_t) {
  return none(c, "fmi3GetInt8", n, no_type);
}
FMI_EXPORT int fmi3GetUInt8(void* c, const Reference*, std::size_t n, std::uint8_t*, std::size_t) {
  return none(c, "fmi3GetUInt8", n, no_type);
}
FMI_EXPORT int fmi3GetInt16(void* c, const Reference*, std::size_t n, std::int16_t*, std::size_t) {
  return none(c, "fmi3GetInt16", n, no_type);
}
FMI_EXPORT int fmi3GetUInt16(void* c, const Reference*, std::size_t n, std::uint16_t*, std::size_t) {
  return none(c, "fmi3GetUInt16", n, no_type);
}
FMI_EXPORT int fmi3GetUInt32(void* c, const Reference*, std::size_t n, std::uint32_t*, std::size_t) {
  return none(c, "fmi3GetUInt32", n, no_type);
}
FMI_EXPORT int fmi3GetInt64(void* c, const Reference*, std::size_t n, std::int64_t*, std::size_t) {
  return none(c, "fmi3GetInt64", n, no_type);
}
FMI_EXPORT int fmi3GetUInt64(void* c, const Reference*, std::size_t n, std::uint64_t*, std::size_t) {
  return none(c, "fmi3GetUInt64", n, no_type);
}
FMI_EXPORT int fmi3GetBoolean(void* c, const Reference*, std::size_t n, bool*, std::size_t) {
  return none(c, "fmi3GetBoolean", n, no_type);
}
FMI_EXPORT int fmi3GetString(void* c, const Reference*, std::size_t n, const char**, std::size_t) {
  return none(c, "fmi3GetString", n, no_type);
}
FMI_EXPORT int fmi3SetFloat32(void* c, const Reference*, std::size_t n, const float*, std::size_t) {
  return none(c, "fmi3SetFloat32", n, no_type);
}
FMI_EXPORT int fmi3SetInt8(void* c, const Reference*, std::size_t n, const std::int8_t*, std::size_t) {
  return none(c, "fmi3SetInt8", n, no_type);
}
FMI_EXPORT int fmi3SetUInt8(void* c, const Reference*, std::size_t n, const std::uint8_t*, std::size_t) {
  return none(c, "fmi3SetUInt8", n, no_type);
}
FMI_EXPORT int fmi3SetInt16(void* c, const Reference*, std::size_t n, const std::int16_t*, std::size_t) {
  return none(c, "fmi3SetInt16", n, no_type);
}
FMI_EXPORT int fmi3SetUInt16(void* c, const Reference*, std::size_t n, const std::uint16_t*, std::size_t) {
  return none(c, "fmi3SetUInt16", n, no_type);
}
FMI_EXPORT int fmi3SetUInt32(void* c, const Reference*, std::size_t n, const std::uint32_t*, std::size_t) {
  return none(c, "fmi3SetUInt32", n, no_type);
}
FMI_EXPORT int fmi3SetInt64(void* c, const Reference*, std::size_t n, const std::int64_t*, std::size_t) {
  return none(c, "fmi3SetInt64", n, no_type);
}
FMI_EXPORT int fmi3SetUInt64(void* c, const Reference*, std::size_t n, const std::uint64_t*, std::size_t) {
  return none(c, "fmi3SetUInt64", n, no_type);
}
FMI_EXPORT int fmi3SetBoolean(void* c, const Reference*, std::size_t n, const bool*, std::size_t) {
  return none(c, "fmi3SetBoolean", n, no_type);
}
FMI_EXPORT int fmi3SetString(void* c, const Reference*, std::size_t n, const char* const*, std::size_t) {
  return none(c, "fmi3SetString", n, no_type);
}
FMI_EXPORT int fmi3SetInt32(void* c, const Reference*, std::size_t n, const std::int32_t*, std::size_t) {
  return none(c, "fmi3SetInt32", n, no_type);
}
FMI_EXPORT int fmi3GetBinary(void* c, const Reference*, std::size_t n, std::size_t*, const std::uint8_t**,
                             std::size_t) {
  return none(c, "fmi3GetBinary", n, no_type);
}
FMI_EXPORT int fmi3SetBinary(void* c, const Reference*, std::size_t n, const std::size_t*, const std::uint8_t* const*,
                             std::size_t) {
  return none(c, "fmi3SetBinary", n, no_type);
}
FMI_EXPORT int fmi3GetClock(void* c, const Reference*, std::size_t n, bool*) {
  return none(c, "fmi3GetClock", n, no_clocks);
}
FMI_EXPORT int fmi3SetClock(void* c, const Reference*, std::size_t n, const bool*) {
  return none(c, "fmi3SetClock", n, no_clocks);
}

// ------------------------------------------------------------------------------------------------------------- clocks

FMI_EXPORT int fmi3GetIntervalDecimal(void* c, const Reference*, std::size_t n, double*, int*) {
  return none(c, "fmi3GetIntervalDecimal", n, no_clocks);
}
FMI_EXPORT int fmi3GetIntervalFraction(void* c, const Reference*, std::size_t n, std::uint64_t*, std::uint64_t*, int*) {
  return none(c, "fmi3GetIntervalFraction", n, no_clocks);
}
FMI_EXPORT int fmi3GetShiftDecimal(void* c, const Reference*, std::size_t n, double*) {
  return none(c, "fmi3GetShiftDecimal", n, no_clocks);
}
FMI_EXPORT int fmi3GetShiftFraction(void* c, const Reference*, std::size_t n, std::uint64_t*, std::uint64_t*) {
  return none(c, "fmi3GetShiftFraction", n, no_clocks);
}
FMI_EXPORT int fmi3SetIntervalDecimal(void* c, const Reference*, std::size_t n, const double*) {
  return none(c, "fmi3SetIntervalDecimal", n, no_clocks);
}
FMI_EXPORT int fmi3SetIntervalFraction(void* c, const Reference*, std::size_t n, const std::uint64_t*,
                                       const std::uint64_t*) {
  return none(c, "fmi3SetIntervalFraction", n, no_clocks);
}
FMI_EXPORT int fmi3SetShiftDecimal(void* c, const Reference*, std::size_t n, const double*) {
  return none(c, "fmi3SetShiftDecimal", n, no_clocks);
}
FMI_EXPORT int fmi3SetShiftFraction(void* c, const Reference*, std::size_t n, const std::uint64_t*,
                                    const std::uint64_t*) {
  return none(c, "fmi3SetShiftFraction", n, no_clocks);
}
FMI_EXPORT int fmi3ActivateModelPartition(void* c, Reference, double) {
  return none(c, "fmi3ActivateModelPartition", 1, no_clocks);
}

// -------------------------------------------------------------------------------------------------------- derivatives

FMI_EXPORT int fmi3GetNumberOfVariableDependencies(void* c, Reference, std::size_t*) {
  return int(allowed(of(c), any_stage, "fmi3GetNumberOfVariableDependencies", [&](Instance& it) {
    return it.refuse("fmi3GetNumberOfVariableDependencies: see the model description");
  }));
}
FMI_EXPORT int fmi3GetVariableDependencies(void* c, Reference, std::size_t*, Reference*, std::size_t*, int*,
                                           std::size_t) {
  return none(c, "fmi3GetVariableDependencies", 1, "see the model description");
}
FMI_EXPORT int fmi3GetDirectionalDerivative(void* c, const Reference* unknowns, std::size_t n, const Reference* knowns,
                                            std::size_t n_knowns, const double* seed, std::size_t seeds, double* found,
                                            std::size_t room) {
  const bool has_room = seed != nullptr && found != nullptr && seeds == n_knowns && room >= n;
  return derivatives(of(c), "fmi3GetDirectionalDerivative", {unknowns, n}, {knowns, n_knowns}, has_room,
                     [&](Instance& it) { return it.derivatives({unknowns, n}, {knowns, n_knowns}, seed, found); });
}
FMI_EXPORT int fmi3GetAdjointDerivative(void* c, const Reference* unknowns, std::size_t n, const Reference* knowns,
                                        std::size_t n_knowns, const double* seed, std::size_t seeds, double* found,
                                        std::size_t room) {
  const bool has_room = seed != nullptr && found != nullptr && seeds == n && room >= n_knowns;
  return derivatives(of(c), "fmi3GetAdjointDerivative", {unknowns, n}, {knowns, n_knowns}, has_room,
                     [&](Instance& it) { return it.adjoint({unknowns, n}, {knowns, n_knowns}, seed, found); });
}
FMI_EXPORT int fmi3GetOutputDerivatives(void* c, const Reference* references, std::size_t n, const std::int32_t* orders,
                                        double* rates, std::size_t room) {
  return output_rates(of(c), "fmi3GetOutputDerivatives", references, n, orders, room < n ? nullptr : rates);
}

// -------------------------------------------------------------------------------------------------------------- modes

FMI_EXPORT int fmi3EnterConfigurationMode(void* c) {
  return none(c, "fmi3EnterConfigurationMode", 1, "this FMU has no structural parameters");
}
FMI_EXPORT int fmi3ExitConfigurationMode(void* c) {
  return none(c, "fmi3ExitConfigurationMode", 1, "this FMU has no structural parameters");
}

FMI_EXPORT int fmi3EvaluateDiscreteStates(void* c) { return none(c, "fmi3EvaluateDiscreteStates", 0, ""); }

FMI_EXPORT int fmi3UpdateDiscreteStates(void* c, bool* again, bool* terminate, bool* nominals, bool* states,
                                        bool* has_next, double* next) {
  return int(allowed(of(c), in(Stage::event, Stage::initialization), "fmi3UpdateDiscreteStates", [&](Instance& it) {
    for (bool* flag : {again, terminate, nominals, states, has_next})
      if (flag == nullptr) return it.refuse("fmi3UpdateDiscreteStates has no place for what it tells");
    *again = *terminate = *nominals = *states = false;
    const bool decides = it.exchanges() && it.stage() == Stage::event;
    const Answer answer = decides ? it.decide(states) : Answer::ok;
    *has_next = next != nullptr && it.has_next_knot();
    if (*has_next) *next = it.next_knot();
    return answer;
  }));
}

// ----------------------------------------------------------------------------------------------------- model exchange

FMI_EXPORT int fmi3EnterContinuousTimeMode(void* c) {
  return exchange(c, in(Stage::event), "fmi3EnterContinuousTimeMode",
                  [](Instance& it) { return it.enter(Stage::step); });
}

FMI_EXPORT int fmi3CompletedIntegratorStep(void* c, bool, bool* event, bool* terminate) {
  return exchange(c, in(Stage::step), "fmi3CompletedIntegratorStep", [&](Instance&) {
    if (event != nullptr) *event = false;
    if (terminate != nullptr) *terminate = false;
    return Answer::ok;
  });
}

FMI_EXPORT int fmi3SetTime(void* c, double t) {
  return exchange(c, running, "fmi3SetTime", [&](Instance& it) { return it.set_time(t); });
}

FMI_EXPORT int fmi3SetContinuousStates(void* c, const double* x, std::size_t n) {
  return exchange(c, running, "fmi3SetContinuousStates", [&](Instance& it) { return it.set_states(x, n); });
}

FMI_EXPORT int fmi3GetContinuousStateDerivatives(void* c, double* dx, std::size_t n) {
  return exchange(c, evaluated, "fmi3GetContinuousStateDerivatives", [&](Instance& it) { return it.rates(dx, n); });
}

FMI_EXPORT int fmi3GetEventIndicators(void* c, double* z, std::size_t n) {
  return exchange(c, evaluated, "fmi3GetEventIndicators", [&](Instance& it) { return it.margins(z, n); });
}

FMI_EXPORT int fmi3GetContinuousStates(void* c, double* x, std::size_t n) {
  return exchange(c, evaluated, "fmi3GetContinuousStates", [&](Instance& it) { return it.get_states(x, n); });
}

FMI_EXPORT int fmi3GetNominalsOfContinuousStates(void* c, double* sizes, std::size_t n) {
  return exchange(c, any_stage, "fmi3GetNominalsOfContinuousStates",
                  [&](Instance& it) { return it.nominals(sizes, n); });
}

FMI_EXPORT int fmi3GetNumberOfEventIndicators(void* c, std::size_t* n) {
  return exchange(c, any_stage, "fmi3GetNumberOfEventIndicators", [&](Instance& it) {
    return n == nullptr ? it.refuse("there is no place for the number") : (*n = it.margin_count(), Answer::ok);
  });
}

FMI_EXPORT int fmi3GetNumberOfContinuousStates(void* c, std::size_t* n) {
  return exchange(c, any_stage, "fmi3GetNumberOfContinuousStates", [&](Instance& it) {
    return n == nullptr ? it.refuse("there is no place for the number") : (*n = it.state_count(), Answer::ok);
  });
}

// -------------------------------------------------------------------------------------------------------------- steps

FMI_EXPORT int fmi3DoStep(void* c, double from, double size, bool, bool* event, bool* terminate, bool* early,
                          double* reached) {
  return int(allowed(of(c), in(Stage::step, Stage::failed), "fmi3DoStep", [&](Instance& it) {
    if (it.exchanges()) return it.refuse("fmi3DoStep is for instances of co-simulation");
    const auto* component = static_cast<Component*>(c);
    const Stepped done = it.step(from, size, component->may_return_early);
    if (event != nullptr) *event = done.is_early && component->has_event_mode;
    if (terminate != nullptr) *terminate = false;
    if (early != nullptr) *early = done.is_early;
    if (reached != nullptr) *reached = it.time();
    return done.answer;
  }));
}

// ------------------------------------------------------------------------------------------------------------- states

FMI_EXPORT int fmi3GetFMUState(void* c, void** state) { return get_state(of(c), "fmi3GetFMUState", state); }

FMI_EXPORT int fmi3SetFMUState(void* c, void* state) {
  return int(allowed(of(c), any_stage, "fmi3SetFMUState", [&](Instance& it) {
    if (state == nullptr) return it.refuse("there is no state");
    const Answer answer = it.go_to(*static_cast<State*>(state));
    // of an instance with event mode
    const bool has_mode = static_cast<Component*>(c)->has_event_mode;
    return it.stage() == Stage::event && !has_mode ? worse(answer, it.enter(Stage::step)) : answer;
  }));
}

FMI_EXPORT int fmi3FreeFMUState(void* c, void** state) { return free_state(of(c), "fmi3FreeFMUState", state); }

FMI_EXPORT int fmi3SerializedFMUStateSize(void* c, void* state, std::size_t* size) {
  return state_size(of(c), "fmi3SerializedFMUStateSize", state, size);
}

FMI_EXPORT int fmi3SerializeFMUState(void* c, void* state, std::uint8_t bytes[], std::size_t size) {
  return serialize_state(of(c), "fmi3SerializeFMUState", state, bytes, size);
}

FMI_EXPORT int fmi3DeserializeFMUState(void* c, const std::uint8_t bytes[], std::size_t size, void** state) {
  return deserialize_state(of(c), "fmi3DeserializeFMUState", bytes, size, state);
}
