#pragma once
#include <cstring>

#include "instance.hpp"

/// What the doors of both versions share.
namespace clutchwork::fmi {

/// In which stages a call may be made.
template <class... S>
constexpr unsigned in(S... stages) {
  return ((1u << int(stages)) | ...);
}

inline constexpr unsigned any_stage = ~0u;
inline constexpr unsigned before_steps = in(Stage::instantiated, Stage::initialization);
inline constexpr unsigned running = in(Stage::step, Stage::event);
inline constexpr unsigned evaluated = running | in(Stage::initialization, Stage::terminated);

inline constexpr const char* stage_names[] = {"instantiated", "in initialization mode", "in step mode", "in event mode",
                                              "terminated",   "stopped by an error"};

/// Answers a call if it may be made now.
template <class Deed>
Answer allowed(Instance* instance, unsigned stages, const char* call, Deed&& deed) {
  if (instance == nullptr) return Answer::error;
  if (((stages >> int(instance->stage())) & 1u) == 0)
    return instance->refuse(std::string(call) + " is not allowed: the instance is " +
                            stage_names[int(instance->stage())]);
  return deed(*instance);
}

/// The worse of two answers.
inline Answer worse(Answer one, Answer other) { return int(one) > int(other) ? one : other; }

/// Values one after another; the first refusal ends it.
template <class Each>
Answer each(std::size_t n, Each&& deed) {
  Answer answer = Answer::ok;
  for (std::size_t i = 0; i < n && int(answer) < int(Answer::discard); ++i) answer = worse(answer, deed(i));
  return answer;
}

// ------------------------------------------------------------------------- derivatives: alike in both versions

template <class Deed>
int derivatives(Instance* instance, const char* call, const References& of, const References& by, bool has_room,
                Deed&& deed) {
  return int(allowed(instance, evaluated, call, [&](Instance& it) {
    if (of.n == 0) return Answer::ok;
    if (!has_room || of.at == nullptr || by.at == nullptr) return it.refuse(std::string(call) + " has no values");
    return deed(it);
  }));
}

inline int output_rates(Instance* instance, const char* call, const std::uint32_t* references, std::size_t n,
                        const std::int32_t* orders, double* rates) {
  return int(allowed(instance, evaluated, call, [&](Instance& it) {
    if (n == 0) return Answer::ok;
    if (it.exchanges()) return it.refuse(std::string(call) + " is for instances of co-simulation");
    if (references == nullptr || orders == nullptr || rates == nullptr)
      return it.refuse(std::string(call) + " has no values");
    for (std::size_t i = 0; i < n; ++i)
      if (orders[i] != 1) return it.refuse("derivatives of outputs are those of order 1, not " + number(orders[i]));
    return it.output_rates({references, n}, rates);
  }));
}

// ------------------------------------------------------------------------------ states: alike in both versions

inline int get_state(Instance* instance, const char* call, void** state) {
  return int(allowed(instance, any_stage, call, [&](Instance& it) {
    if (state == nullptr) return it.refuse(std::string(call) + " has no place for the state");
    delete static_cast<State*>(*state);
    return *state = it.state(), Answer::ok;
  }));
}

inline int free_state(Instance* instance, const char* call, void** state) {
  return int(allowed(instance, any_stage, call, [&](Instance&) {
    if (state != nullptr) delete static_cast<State*>(*state), *state = nullptr;
    return Answer::ok;
  }));
}

inline int state_size(Instance* instance, const char* call, void* state, std::size_t* size) {
  return int(allowed(instance, any_stage, call, [&](Instance& it) {
    if (state == nullptr || size == nullptr) return it.refuse("there is no state");
    *size = it.serialized(*static_cast<State*>(state)).size();
    return *size > 0 ? Answer::ok : it.refuse("the state cannot be saved");
  }));
}

inline int serialize_state(Instance* instance, const char* call, void* state, void* bytes, std::size_t size) {
  return int(allowed(instance, any_stage, call, [&](Instance& it) {
    if (state == nullptr || bytes == nullptr) return it.refuse("there is no state");
    const auto made = it.serialized(*static_cast<State*>(state));
    if (made.empty() || size < made.size()) return it.refuse("there is too little room for the state");
    return std::memcpy(bytes, made.data(), made.size()), Answer::ok;
  }));
}

inline int deserialize_state(Instance* instance, const char* call, const void* bytes, std::size_t size, void** state) {
  return int(allowed(instance, any_stage, call, [&](Instance& it) {
    if (state == nullptr) return it.refuse(std::string(call) + " has no place for the state");
    State* made = it.deserialized(static_cast<const unsigned char*>(bytes), std::int64_t(size));
    return made == nullptr ? Answer::error : (*state = made, Answer::ok);
  }));
}

}  // namespace clutchwork::fmi
