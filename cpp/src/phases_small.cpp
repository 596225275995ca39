#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

namespace clutchwork {
CLUTCHWORK_SMALL_PHASES()
}  // namespace clutchwork
