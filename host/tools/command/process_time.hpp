// What the process has taken before its first line: the loading of its libraries.
#pragma once

#include "photile/statistics.hpp"

namespace photile::app {

/// To be asked for in the beginning. Wall clock to a hundredth of a second; processor seconds where
/// the system does not tell.
TimeTaken time_of_loading();

}  // namespace photile::app
