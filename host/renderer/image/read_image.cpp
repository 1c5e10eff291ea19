#include <algorithm>
#include <new>

#include "image/picture_file.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"

namespace photile {

namespace {

constexpr int rows_per_channel_read = 256;

}  // namespace

PictureHeader read_header(const std::filesystem::path& file) {
  return image::PictureFile(file).header();
}

void check_pixels(const std::filesystem::path& file) {
  image::PictureFile source(file);
  const int height = source.header().height;
  for (const std::size_t channel : source.first_channels()) {
    for (int first = 0; first < height; first += rows_per_channel_read) {
      source.read(channel, first, std::min(first + rows_per_channel_read, height));
    }
  }
}

Image read_image(const std::filesystem::path& file) {
  image::PictureFile source(file);
  source.check_total();
  try {
    Image image;
    static_cast<PictureHeader&>(image) = source.header();
    image.channels.resize(image.channel_names.size());
    for (std::vector<float>& plane : image.channels) plane.reserve(image.pixels());
    // All channels of some rows, so that what is decoded at a time is little.
    for (int first = 0; first < image.height; first += rows_per_channel_read) {
      const int end = std::min(first + rows_per_channel_read, image.height);
      for (std::size_t i = 0; i < image.channels.size(); ++i) {
        const std::vector<float> rows = source.read(i, first, end);
        image.channels[i].insert(image.channels[i].end(), rows.begin(), rows.end());
      }
    }
    return image;
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() + ": there is not enough memory to read it; scale it down");
  }
}

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
