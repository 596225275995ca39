#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

namespace clutchwork {
CLUTCHWORK_SMALL_ROW(, 3)
}  // namespace clutchwork
