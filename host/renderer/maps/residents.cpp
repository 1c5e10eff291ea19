#include "maps/residents.hpp"

#include <algorithm>

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

}  // namespace photile::maps
