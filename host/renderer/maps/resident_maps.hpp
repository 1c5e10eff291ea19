// The pages of photon maps: on the device while there is memory, on the host otherwise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "maps/map_page.hpp"
#include "maps/residents.hpp"

namespace photile::maps {

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

  /// Lets go of the page in use at the end of a block.
  struct Release {
    ResidentMaps& pages;
    ~Release() { pages.release(); }
  };

  /// Bytes of the pages that are not on the device.
  std::uint64_t spilled_bytes() const;

 private:
  using HostCopy = std::vector<std::vector<std::byte>>;  ///< a buffer each; empty: none was made

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
