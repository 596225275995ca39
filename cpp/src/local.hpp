#pragma once
#include <clutchwork/motion/local.hpp>

/// Derivatives of all components, compiled apart.
namespace clutchwork {

/// Write the matrix of derivatives at the present point of a run, right after its row.
void fill_local(Workspace<double>& ws, double* matrix);

}  // namespace clutchwork
