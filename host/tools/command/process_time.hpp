// What the process has taken since it was started, the loading of its libraries included.
#pragma once

#include "photile/statistics.hpp"

namespace photile::app {

/// Wall clock to a hundredth of a second; 0 where the system does not tell.
TimeTaken since_process_start();

}  // namespace photile::app
