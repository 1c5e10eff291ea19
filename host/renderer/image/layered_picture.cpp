#include "photile/layered_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace photile {
namespace {

constexpr float largest = std::numeric_limits<float>::max();
constexpr int rows_per_read = 64;

float finite(float value) {
  return std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest);
}

}  // namespace

std::vector<std::string> LayeredPicture::channel_names(std::size_t light) const {
  const Layer& layer = layers_[light];
  std::vector<std::string> names;
  for (const char* component : {".R", ".G", ".B"}) {
    names.push_back("Combined_" + layer.light + component);
  }
  if (layer.illuminance) names.push_back("Illuminance_" + layer.light + ".Y");
  return names;
}

LightRows LayeredPicture::read(std::size_t light, int first, int end) const {
  LightRows rows = read_any(light, first, end);
  std::vector<bool> lost;  // pixels; empty as long as there are none
  for (std::vector<float>* plane : {&rows.rgb[0], &rows.rgb[1], &rows.rgb[2], &rows.illuminance}) {
    for (std::size_t pixel = 0; pixel < plane->size(); ++pixel) {
      float& value = (*plane)[pixel];
      if (std::isfinite(value)) continue;
      value = finite(value);
      lost.resize(plane->size());
      lost[pixel] = true;
    }
  }
  if (lost.empty()) return rows;
  overflows_[light].add(first, end,
                        static_cast<std::size_t>(std::count(lost.begin(), lost.end(), true)));
  return rows;
}

void LayeredPicture::Overflow::add(int first, int end, std::size_t lost) {
  if (first < counted) return;  // read once more, for another file
  counted = end;
  pixels += lost;
}

Image LayeredPicture::root(int first, int end) const {
  Image image = sum_any(first, end);
  for (float& alpha : image.channels[3]) alpha = finite(alpha);
  std::vector<std::size_t> lost;
  for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel) {
    if (!std::isfinite(image.channels[0][pixel]) || !std::isfinite(image.channels[1][pixel]) ||
        !std::isfinite(image.channels[2][pixel])) {
      lost.push_back(pixel);
    }
  }
  if (lost.empty()) return image;
  lost_sums_.add(first, end, lost.size());
  for (const std::size_t pixel : lost) {
    for (std::size_t i = 0; i < 3; ++i) image.channels[i][pixel] = 0.0f;
  }
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t light = 0; light < lights(); ++light) {
    auto pixel = lost.begin();
    for (int row = 0; row < image.height; row += rows_per_read) {
      const int row_end = std::min(row + rows_per_read, image.height);
      const LightRows rows = read(light, first + row, first + row_end);
      const std::size_t begin = static_cast<std::size_t>(row) * width;
      for (; pixel != lost.end() && *pixel < static_cast<std::size_t>(row_end) * width; ++pixel) {
        for (std::size_t i = 0; i < 3; ++i) {
          float& sum = image.channels[i][*pixel];
          sum = finite(sum + rows.rgb[i][*pixel - begin]);
        }
      }
    }
  }
  return image;
}

std::vector<std::string> LayeredPicture::overflows() const {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& what, std::uint64_t pixels) {
    lines.push_back(
        fmt::format("{}: {} of {} pixels are beyond {:.2g} or no number; they are written as that, "
                    "or as 0; turn it down",
                    what, pixels, header_.pixels(), largest));
  };
  for (const auto& [light, overflow] : overflows_) {
    add(fmt::format("light '{}'", layers_[light].light), overflow.pixels);
  }
  if (lines.empty() && lost_sums_.pixels > 0) add("the sum of the lights", lost_sums_.pixels);
  return lines;
}

Image to_image(const LayeredPicture& picture) {
  Image image = picture.root();
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    LightRows rows = picture.read(light, 0, image.height);
    std::vector<std::vector<float>> planes;
    for (std::vector<float>& plane : rows.rgb) planes.push_back(std::move(plane));
    planes.push_back(std::move(rows.illuminance));
    const std::vector<std::string> names = picture.channel_names(light);
    for (std::size_t i = 0; i < names.size(); ++i) image.add(names[i]) = std::move(planes[i]);
  }
  return image;
}

}  // namespace photile
