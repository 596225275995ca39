#pragma once
#include <cstdint>

/// Runs with derivatives behind c_api.h: one compiled for any processor, one for wide registers. A processor without
/// these must not meet a copy of them, so they speak through plain types. docs/theory/gradients.md
struct cw_tangent_calls {
  std::int64_t (*size)(const void* system, std::int64_t bytes);
  void* (*load)(const void* system, std::int64_t bytes, void* memory, std::int64_t memory_bytes);
  int (*set_option)(void* run, const char* name, double value);
  int (*leave_out_work)(void* run);
  int (*seed)(void* run, std::int64_t word, int direction, double slope);
  int (*advance)(void* run, double t_end, const double* times, double* rows, double* tangents, std::int64_t n,
                 std::int64_t* filled);
  std::int64_t (*events)(void* run, double* events, double* tangents, std::int64_t most);
  std::int64_t (*grazes)(void* run, double* grazes, double* tangents, std::int64_t most);
  int (*fault)(const void* run, double* value);
  std::int64_t (*steps)(const void* run);
};

extern const cw_tangent_calls clutchwork_tangents_plain;
/// CLUTCHWORK_WIDE: it is compiled; CLUTCHWORK_WIDE_ALONE: the other one is not.
extern const cw_tangent_calls clutchwork_tangents_wide;
