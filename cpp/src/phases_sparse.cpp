#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

namespace clutchwork {
CLUTCHWORK_PHASES(, SparseForm)
}  // namespace clutchwork
