#include "local.hpp"

#include "instances.hpp"

namespace clutchwork {

void fill_local(Workspace<double>& ws, double* matrix) { LocalDerivatives<double>(ws, matrix).fill(); }

}  // namespace clutchwork
