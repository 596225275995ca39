#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

#if CLUTCHWORK_FORMS & 2
namespace clutchwork {
CLUTCHWORK_PHASES(, SparseForm)
}  // namespace clutchwork
#endif
