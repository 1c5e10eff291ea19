// Which lights of many have added to a sum.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace photile::estimate {

/// Beside sums with room for every light: those that were added to since the last clear(), so that
/// few are read and set back.
class LitLights {
 public:
  explicit LitLights(std::size_t lights) : is_lit_(lights) {}

  void add(std::uint32_t light) {
    if (is_lit_[light]) return;
    is_lit_[light] = 1;
    lit_.push_back(static_cast<std::uint16_t>(light));
  }
  std::size_t count() const { return lit_.size(); }
  /// Ascending.
  std::span<const std::uint16_t> sorted() {
    std::sort(lit_.begin(), lit_.end());
    return lit_;
  }
  void clear() {
    for (const std::uint16_t light : lit_) is_lit_[light] = 0;
    lit_.clear();
  }

 private:
  std::vector<std::uint8_t> is_lit_;
  std::vector<std::uint16_t> lit_;
};

}  // namespace photile::estimate
