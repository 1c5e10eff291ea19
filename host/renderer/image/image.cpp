#include "photile/image.hpp"

#include <algorithm>

namespace photile {

const std::vector<float>* Image::find(const std::string& channel) const {
  const auto found = std::find(channel_names.begin(), channel_names.end(), channel);
  if (found == channel_names.end()) return nullptr;
  return &channels[static_cast<std::size_t>(found - channel_names.begin())];
}

std::vector<float>& Image::add(const std::string& channel) {
  channel_names.push_back(channel);
  return channels.emplace_back(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

}  // namespace photile
