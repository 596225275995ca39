#define CLUTCHWORK_INSTANCES
#include <instances.hpp>

/// The small forms that the tests run under sanitizers.
namespace clutchwork {
CLUTCHWORK_SMALL(, 1, 0)
CLUTCHWORK_SMALL(, 1, 1)
CLUTCHWORK_SMALL(, 2, 0)
CLUTCHWORK_SMALL(, 2, 1)
CLUTCHWORK_SMALL(, 2, 2)
}  // namespace clutchwork
