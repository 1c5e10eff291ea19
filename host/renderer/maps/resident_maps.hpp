// The pages of photon maps: on the device while there is memory, on the host otherwise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/context.hpp"
#include "maps/map_page.hpp"

namespace photile::maps {

/// Items that are loaded when they are used and unloaded when memory runs out. Users go through the
/// items in ascending order, again and again: so the item used last is the one needed latest and is
/// unloaded first, and as many as fit stay loaded through all rounds.
class Residents : public device::Reclaimer {
 public:
  explicit Residents(device::Context& context) : Reclaimer(context) {}

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

  std::vector<std::size_t> in_use_order_;  ///< those resident, the one used last at the end
  std::size_t used_ = nothing;
};

/// Pages in ascending order of their maps. Where the device's memory runs out, pages are copied to
/// the host, once, and released; they come back when they are used.
class ResidentMaps final : private Residents {
 public:
  explicit ResidentMaps(device::Context& context) : Residents(context), context_(context) {}

  /// Takes a page whose buffers are on the device.
  void add(MapPage page);

  std::size_t size() const { return pages_.size(); }
  bool empty() const { return pages_.empty(); }
  /// What a page covers. Its buffers are empty while it is on the host.
  const MapPage& operator[](std::size_t page) const { return pages_[page].page; }

  /// The page with its buffers, which stay until another page is used. Errors: DeviceMemoryError.
  const MapPage& use(std::size_t page);
  using Residents::release;

  /// Releases the page in use at the end of a block.
  struct Release {
    ResidentMaps& pages;
    ~Release() { pages.release(); }
  };

  /// Bytes of the pages that are not on the device.
  std::uint64_t spilled_bytes() const;

 private:
  using HostCopy = std::vector<std::vector<std::byte>>;  ///< one per buffer; empty: not copied

  struct Entry {
    MapPage page;
    HostCopy copy;
    bool resident = true;
  };

  void load(std::size_t page) override;
  void unload(std::size_t page) override;

  device::Context& context_;
  std::vector<Entry> pages_;
};

}  // namespace photile::maps
