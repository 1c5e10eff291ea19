// Which of a number of items lie in the device's memory.
#pragma once

#include <cstddef>
#include <vector>

#include "device/context.hpp"

namespace photile::maps {

/// Items that are loaded when they are used and unloaded when memory runs out. Users go through the
/// items in ascending order, again and again: so the one used last is the one needed latest and is
/// unloaded first, and as many as fit stay through all rounds.
class Residents : public device::Reclaimer {
 public:
  explicit Residents(device::Context& context) : entry_(context, *this) {}

  std::size_t resident_count() const { return in_use_order_.size(); }

  /// Unloads an item other than the one in use.
  bool reclaim() override;

 protected:
  ~Residents() = default;

  /// Loads the item unless it is resident. It stays so until another is used or `release` is
  /// called.
  void use(std::size_t item);
  /// No item is in use.
  void release() { used_ = nothing; }
  /// The item is resident from now on, though not in use.
  void add_resident(std::size_t item) { in_use_order_.push_back(item); }

  virtual void load(std::size_t item) = 0;
  virtual void unload(std::size_t item) = 0;

 private:
  static constexpr std::size_t nothing = static_cast<std::size_t>(-1);

  device::ReclaimerEntry entry_;
  std::vector<std::size_t> in_use_order_;  ///< those resident, the one used last at the end
  std::size_t used_ = nothing;
};

}  // namespace photile::maps
