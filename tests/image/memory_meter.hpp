// How much memory the process holds, to the byte, whichever library asked for it with operator new.
#pragma once

#include <cstddef>

namespace photile::test {

/// Measures from its construction on. One at a time.
class MemoryMeter {
 public:
  MemoryMeter();
  /// Most bytes held at a time, beyond those held when the meter was made.
  std::size_t peak() const;

 private:
  std::size_t before_;
};

}  // namespace photile::test
