#define CLUTCHWORK_INSTANCES
#include "instances.hpp"

namespace clutchwork {
template Status run_phase<FullForm<double>>(Workspace<double>&, double, Sink&);
}  // namespace clutchwork
