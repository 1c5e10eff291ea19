// What a file beside the scene file can do wrong.
#pragma once

#include <stdexcept>

namespace photile::scene_io {

/// A texture, buffer or material library cannot be used. `what()` names the file and the reason;
/// the importer decides whether to go on with a warning or to fail.
struct ResourceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace photile::scene_io
