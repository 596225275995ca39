#define CLUTCHWORK_STEPS
#include "instances.hpp"

#if CLUTCHWORK_FORMS & 1
/// The steps of few speeds, each size for itself.
namespace clutchwork {
CLUTCHWORK_SIZED(, 1)
CLUTCHWORK_SIZED(, 2)
CLUTCHWORK_SIZED(, 3)
CLUTCHWORK_SIZED(, 4)
}  // namespace clutchwork
#endif
