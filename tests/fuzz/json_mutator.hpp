// Changes to JSON that leave it JSON.
#pragma once

#include <string>

#include "targets.hpp"

namespace photile::test {

/// The text with a few values replaced by wild ones, copied from elsewhere in it, removed, repeated
/// or moved. "" where it is no JSON.
std::string mutated_json(Bytes text, unsigned seed);

}  // namespace photile::test
