// The communicator of MPI_COMM_WORLD, in a separate module.
#pragma once

#include "photile/communicator.hpp"

extern "C" {

/// Initialises MPI, once, and returns the process's communicator, which ends MPI when it concludes.
/// Null where MPI cannot be initialised.
__attribute__((visibility("default"))) photile::Communicator* photile_mpi_communicator();

/// Whether another process has failed, as far as is known between collective calls. Any thread; the
/// one that has called the above finds out, the others hear of it.
__attribute__((visibility("default"))) bool photile_mpi_other_failed();

}  // extern "C"
