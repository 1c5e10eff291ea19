// Tunings in words, and `photile devices --tune`.
#pragma once

#include <string>

#include "photile/device.hpp"
#include "photile/estimate_tuning.hpp"
#include "photile/progress.hpp"

namespace photile::app {

/// "select, 16 wide, 8 hits a work-item, work-groups of 64, 4 photons a cell".
std::string tuning_words(const EstimateTuning& tuning);

/// Finds and stores the tuning of `device` for k = `neighbours` and each kind of scene: one light
/// or several, diffuse or glossy. Prints every trial, in microseconds per hit, and the choice.
/// Errors: OutputError when the choice cannot be kept; Interrupted.
void tune_device(Device& device, int neighbours, Progress& progress);

}  // namespace photile::app
