#pragma once
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

}  // namespace clutchwork::fmi
