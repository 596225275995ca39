#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

#if CLUTCHWORK_FORMS & 1
namespace clutchwork {
CLUTCHWORK_SMALL_PHASES()
}  // namespace clutchwork
#endif
