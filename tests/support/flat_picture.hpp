// Pictures of one value.
#pragma once

#include <string>
#include <vector>

#include "photile/image.hpp"

namespace photile::test {

inline Image flat_picture(int width, int height, float value = 0,
                          const std::vector<std::string>& channels = {"R", "G", "B"}) {
  Image image;
  image.width = width;
  image.height = height;
  for (const std::string& channel : channels) image.add(channel).assign(image.pixels(), value);
  return image;
}

}  // namespace photile::test
