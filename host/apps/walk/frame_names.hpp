// Names of numbered frames.
#pragma once

#include <filesystem>
#include <string>

namespace photile::walk {

/// A file's name with a place for the number of a frame: a run of '#', as long as the number is
/// wide at least, or %d, %4d, %04d as in printf. A name without one gets .#### before its ending.
class FrameNames {
 public:
  /// Errors: UsageError where there are several places, or what looks like one that is meant.
  explicit FrameNames(const std::string& pattern);

  std::filesystem::path of(int frame) const;

 private:
  std::string before_, after_;
  int width_ = 1;  ///< digits at least
  char fill_ = '0';
};

}  // namespace photile::walk
