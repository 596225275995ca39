#pragma once
#include <clutchwork/run/advance.hpp>

/// The phases that are compiled apart, to build on several cores. Scalar: double.
#define CLUTCHWORK_SMALL(KEYWORD, NZ, NS) \
  KEYWORD template Status run_phase<SmallForm<double, NZ, NS>>(Workspace<double>&, double, Sink&);
#define CLUTCHWORK_SMALL_ROW(KEYWORD, NZ) \
  CLUTCHWORK_SMALL(KEYWORD, NZ, 0)        \
  CLUTCHWORK_SMALL(KEYWORD, NZ, 1)        \
  CLUTCHWORK_SMALL(KEYWORD, NZ, 2) CLUTCHWORK_SMALL(KEYWORD, NZ, 3) CLUTCHWORK_SMALL(KEYWORD, NZ, 4)

namespace clutchwork {
#ifndef CLUTCHWORK_INSTANCES
CLUTCHWORK_SMALL_ROW(extern, 0)
CLUTCHWORK_SMALL_ROW(extern, 1)
CLUTCHWORK_SMALL_ROW(extern, 2)
CLUTCHWORK_SMALL_ROW(extern, 3)
CLUTCHWORK_SMALL_ROW(extern, 4)
extern template Status run_phase<SparseForm<double>>(Workspace<double>&, double, Sink&);
#endif
}  // namespace clutchwork
