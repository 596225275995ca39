#define CLUTCHWORK_FIXED
#include "instances.hpp"

#include <clutchwork/run/fixed/advance.hpp>

/// Steps of one length, compiled apart.
namespace clutchwork {
template Status advance_fixed(Workspace<double>&, double, Sink&, bool);
}  // namespace clutchwork
