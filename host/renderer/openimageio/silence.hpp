// What a library prints to standard error though nobody asked.
#pragma once

namespace photile::openimageio {

/// While it lives, what its thread prints to C's `stderr` is dropped. libpng prints there what
/// OpenImageIO returns as an error, and warnings about pictures that are sound.
class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
};

}  // namespace photile::openimageio
