#define CLUTCHWORK_INSTANCES
#define CLUTCHWORK_COMPONENTS
#include "instances.hpp"
namespace clutchwork {
CLUTCHWORK_SHARED()
}
