// Rows of a film that several processes make.
#pragma once

#include "photile/communicator.hpp"
#include "photile/light_layers.hpp"

namespace photile {

/// Brings the rows of each process, its Shard of them all, to rank 0. The layers of the others stay
/// as they are. Collective.
void bring_rows(Communicator& processes, LightLayers& layers);

}  // namespace photile
