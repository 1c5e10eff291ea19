// Warnings of host/device: trouble with a cache, which never stops a run.
#pragma once

#include <string>

namespace photile::device {

/// Writes "photile: warning: <line>" to the standard error stream.
void warn(const std::string& line);

}  // namespace photile::device
