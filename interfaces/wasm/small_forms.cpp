#define CLUTCHWORK_INSTANCES
#include <instances.hpp>

/// The exact forms that this build has, and the one that stands in for the others.
namespace clutchwork {
#define CLUTCHWORK_FORM(SPEEDS, STATES) CLUTCHWORK_SMALL(, SPEEDS, STATES)
CLUTCHWORK_SMALL_FORMS(CLUTCHWORK_FORM)
template Status run_phase<SomeForm<double>>(Workspace<double>&, double, Sink&);
}  // namespace clutchwork
