// Test cases that need what is not there.
#pragma once

#include <string>

namespace photile::test {

/// Says why a test case, or a part of one, is not run. The executable then exits with 77 unless a
/// test fails, and CTest counts its tests as skipped.
void skip(const std::string& reason);

}  // namespace photile::test
