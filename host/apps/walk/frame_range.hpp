// Which frames of a walk are made.
#pragma once

#include <optional>
#include <string_view>

namespace photile::walk {

/// Frames first, first + step ... up to last, by number.
struct FrameRange {
  int first = 0, last = 0, step = 1;

  bool contains(int number) const {
    return number >= first && number <= last && (number - first) % step == 0;
  }
};

/// "7", "1-240" or "1-240x10", as render farms write it. Nothing if it is none: numbers are whole,
/// the last is not below the first, and the step is above 0.
std::optional<FrameRange> parse_frame_range(std::string_view text);

}  // namespace photile::walk
