#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

#if CLUTCHWORK_FORMS & 4
namespace clutchwork {
CLUTCHWORK_PHASES(, FullForm)
}  // namespace clutchwork
#endif
