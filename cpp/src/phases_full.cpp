#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

namespace clutchwork {
CLUTCHWORK_PHASES(, FullForm)
}  // namespace clutchwork
