#pragma once

/// The step of eight lanes for processors with wide registers, whatever the rest is compiled for: the bits are the
/// same. CLUTCHWORK_WIDE: it is compiled; CLUTCHWORK_WIDE_ALONE: no other one is. docs/theory/lanes.md
extern "C" {
void clutchwork_wide_advance(void* form, void* step, void* error, void* finite);
void clutchwork_wide_look(void* form, void* step, const void* times);
void clutchwork_wide_doubt(void* form, void* step, void* doubtful);
void clutchwork_wide_observe(void* form, void* step, const void* share, void* sound);
void clutchwork_wide_fit(void* form, void* step, void* sound);
}
