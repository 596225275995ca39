#pragma once

/// The step of eight lanes for processors with wide registers, whatever the rest is compiled for: the bits are the
/// same. CLUTCHWORK_WIDE: that for AVX2 is compiled; CLUTCHWORK_WIDEST: that for AVX-512. docs/theory/lanes.md
#define CLUTCHWORK_DECLARE_LANES(NAME)                                    \
  extern "C" {                                                            \
  void NAME##_advance(void* form, void* step, void* error, void* finite); \
  void NAME##_look(void* form, void* step, const void* times);            \
  void NAME##_doubt(void* form, void* step, void* doubtful);              \
  void NAME##_observe(void* form, void* step, void* row, void* sound);    \
  void NAME##_fit(void* form, void* step, void* sound);                   \
  }
CLUTCHWORK_DECLARE_LANES(clutchwork_wide)
CLUTCHWORK_DECLARE_LANES(clutchwork_widest)

#define CLUTCHWORK_DEFINE_LANES(NAME, STEP)                                                                            \
  void NAME##_advance(void* form, void* step, void* error, void* finite) { STEP::advance(form, step, error, finite); } \
  void NAME##_look(void* form, void* step, const void* times) { STEP::linearize_at(form, step, times); }               \
  void NAME##_doubt(void* form, void* step, void* doubtful) { STEP::doubt(form, step, doubtful); }                     \
  void NAME##_observe(void* form, void* step, void* row, void* sound) { STEP::observe(form, step, row, sound); }       \
  void NAME##_fit(void* form, void* step, void* sound) { STEP::fit(form, step, sound); }
