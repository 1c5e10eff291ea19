// The folder in which PoCL keeps compiled kernels while this process runs.
//
// PoCL (3.1) ends the process on a truncated shared object, a damaged program.bc or a folder that
// it cannot write, and two processes may be writing one folder at a time, so that no check of a
// shared folder holds. Every process therefore gets a fresh folder of its own, into which only
// verified files are put (pocl_cache.hpp), and which goes when the process ends. A killed process's
// folder goes when the next one starts.
#pragma once

#include <filesystem>
#include <optional>

namespace photile::device {

/// Creates the folder and names it to PoCL by POCL_CACHE_DIR. Call before the first OpenCL call; a
/// second call does nothing. Where the user set POCL_CACHE_DIR to a folder that can be written, it
/// is left alone. Errors: DeviceError when no folder can be written at all.
void prepare_pocl_work_folder();

/// The prepared folder; none where the user's own POCL_CACHE_DIR is in force.
std::optional<std::filesystem::path> pocl_work_folder();

}  // namespace photile::device
