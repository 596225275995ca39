#define CLUTCHWORK_INSTANCES
#include <instances.hpp>

/// The exact forms that this build has.
namespace clutchwork {
#define CLUTCHWORK_FORM(SPEEDS, STATES) CLUTCHWORK_SMALL(, SPEEDS, STATES)
CLUTCHWORK_SMALL_FORMS(CLUTCHWORK_FORM)
}  // namespace clutchwork
