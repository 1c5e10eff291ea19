#include "maps/resident_maps.hpp"

#include <algorithm>
#include <utility>

namespace photile::maps {

void Residents::use(std::size_t item) {
  used_ = item;
  if (std::erase(in_use_order_, item) == 0) load(item);
  in_use_order_.push_back(item);
}

bool Residents::reclaim() {
  const auto last = std::find_if(in_use_order_.rbegin(), in_use_order_.rend(),
                                 [&](std::size_t item) { return item != used_; });
  if (last == in_use_order_.rend()) return false;
  unload(*last);
  in_use_order_.erase(std::next(last).base());
  return true;
}

std::uint64_t PageBuffers::device_bytes() const {
  std::uint64_t bytes = 0;
  for_each_buffer(*this, [&](const auto& buffer) { bytes += buffer.bytes(); });
  return bytes;
}

void ResidentMaps::add(MapPage page) {
  pages_.push_back({std::move(page), {}, true});
  add_resident(pages_.size() - 1);
}

const MapPage& ResidentMaps::use(std::size_t page) {
  Residents::use(page);
  return pages_[page].page;
}

std::uint64_t ResidentMaps::spilled_bytes() const {
  std::uint64_t bytes = 0;
  for (const Entry& entry : pages_) {
    if (entry.resident) continue;
    for (const auto& buffer : entry.copy) bytes += buffer.size();
  }
  return bytes;
}

void ResidentMaps::load(std::size_t page) {
  Entry& entry = pages_[page];
  PageBuffers buffers;
  auto content = entry.copy.begin();
  for_each_buffer(buffers, [&](auto& buffer) {
    if (!content->empty()) {
      context_.restore(buffer, *content, "photon map page", device::MemoryPages::large);
    }
    ++content;
  });
  static_cast<PageBuffers&>(entry.page) = std::move(buffers);
  entry.resident = true;
}

void ResidentMaps::unload(std::size_t page) {
  Entry& entry = pages_[page];
  if (entry.copy.empty()) {
    HostCopy copy;
    for_each_buffer(entry.page, [&](auto& buffer) { copy.push_back(context_.save(buffer)); });
    entry.copy = std::move(copy);
  }
  static_cast<PageBuffers&>(entry.page) = {};
  entry.resident = false;
}

}  // namespace photile::maps
