// The communicator of MPI_COMM_WORLD, in a module of its own.
#pragma once

#include "photile/communicator.hpp"

extern "C" {

/// Initialises MPI, once, and returns the process's communicator, which ends MPI when it concludes.
/// Null where MPI cannot be initialised.
__attribute__((visibility("default"))) photile::Communicator* photile_mpi_communicator();

}  // extern "C"
