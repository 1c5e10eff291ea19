// The number of threads of the host and of OpenCL on the CPU.
#pragma once

#include <memory>

namespace photile::app {

/// While it lives, TBB uses at most `count` threads (0: as many as there are cores), and so does a
/// PoCL device that is opened later. The picture does not depend on it.
class ThreadLimit {
 public:
  explicit ThreadLimit(int count);
  ~ThreadLimit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace photile::app
