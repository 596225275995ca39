#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

namespace clutchwork {
CLUTCHWORK_SMALL_ROW(, 1)
}  // namespace clutchwork
