// Times tunings on a device.
#pragma once

#include "estimate/tuning_sample.hpp"
#include "photile/estimate_tuning.hpp"

namespace photile::estimate {

/// As tune_estimate, on a sample of another size.
TuningResult tune_on_sample(Device& device, const SceneNeeds& needs, int neighbours,
                            const TuningSampleSize& size, Progress& progress);

}  // namespace photile::estimate
