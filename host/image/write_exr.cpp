#include <algorithm>
#include <functional>

#include "common/output_file.hpp"
#include "image/exr_spec.hpp"
#include "image/write_exr_parts.hpp"
#include "photile/layered_picture.hpp"
#include "photile/limits.hpp"

namespace photile {
namespace {

/// Rows that are interleaved and handed over at once; a multiple of the 16 rows of a ZIP block.
constexpr int rows_per_write = 64;

/// Fills rows [first, end), interleaved.
using FillRows = std::function<void(int first, int end, std::vector<float>& rows)>;

void write_single_part(const std::filesystem::path& file, const PictureHeader& header,
                       const std::vector<std::string>& channels, const FillRows& fill) {
  OutputFile output(file);
  if (header.width < 1 || header.height < 1 || channels.empty()) {
    output.fail("the picture has no pixels");
  }
  OIIO::ImageSpec spec = image::exr_spec(header, channels, "zip");
  image::add_attributes(header, spec);
  const auto encoder = OIIO::ImageOutput::create("exr", &output);
  if (!encoder || !encoder->open(file.string(), spec)) {
    output.fail(encoder ? encoder->geterror() : OIIO::geterror());
  }
  std::vector<float> rows;
  for (int first = 0; first < header.height; first += rows_per_write) {
    const int end = std::min(first + rows_per_write, header.height);
    rows.resize(static_cast<std::size_t>(end - first) * static_cast<std::size_t>(header.width) *
                channels.size());
    fill(first, end, rows);
    if (!encoder->write_scanlines(first, end, 0, OIIO::TypeDesc::FLOAT, rows.data())) {
      output.fail(encoder->geterror());
    }
  }
  if (!encoder->close()) output.fail(encoder->geterror());
  output.commit();
}

/// Sets one of several channels of interleaved rows.
void interleave(const float* values, std::size_t channel, std::size_t channels,
                std::vector<float>& rows) {
  for (std::size_t i = 0; i * channels < rows.size(); ++i) rows[i * channels + channel] = values[i];
}

/// Positions of the planes in the order of the file: R G B A of the root, then the others as they
/// stand, so that viewers without layers find the picture first.
std::vector<std::size_t> file_order(const Image& image) {
  std::vector<std::size_t> order;
  const auto is_root = [](const std::string& name) {
    return name == "R" || name == "G" || name == "B" || name == "A";
  };
  for (const char* root : {"R", "G", "B", "A"}) {
    const auto& names = image.channel_names;
    const auto found = std::find(names.begin(), names.end(), root);
    if (found != names.end()) order.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  for (std::size_t i = 0; i < image.channel_names.size(); ++i) {
    if (!is_root(image.channel_names[i])) order.push_back(i);
  }
  return order;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
  const std::vector<std::size_t> order = file_order(image);
  std::vector<std::string> names;
  for (const std::size_t i : order) names.push_back(image.channel_names[i]);
  write_single_part(file, image, names, [&](int first, int, std::vector<float>& rows) {
    const std::size_t offset =
        static_cast<std::size_t>(first) * static_cast<std::size_t>(image.width);
    for (std::size_t i = 0; i < order.size(); ++i) {
      interleave(&image.channels[order[i]][offset], i, order.size(), rows);
    }
  });
}

void write_exr(const std::filesystem::path& file, const LayeredPicture& picture) {
  const Image root = picture.root();
  if (picture.lights() > limits::max_single_part_lights) {
    image::write_exr_parts(file, picture, root);
    return;
  }
  std::vector<std::string> names = root.channel_names;
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    for (std::string& name : picture.channel_names(light)) names.push_back(std::move(name));
  }
  write_single_part(file, root, names, [&](int first, int end, std::vector<float>& rows) {
    const std::size_t offset =
        static_cast<std::size_t>(first) * static_cast<std::size_t>(root.width);
    std::size_t channel = 0;
    const auto add = [&](const float* values) {
      interleave(values, channel++, names.size(), rows);
    };
    for (const std::vector<float>& plane : root.channels) add(&plane[offset]);
    for (std::size_t light = 0; light < picture.lights(); ++light) {
      const LightRows values = picture.read(light, first, end);
      for (const std::vector<float>& plane : values.rgb) add(plane.data());
      if (!values.illuminance.empty()) add(values.illuminance.data());
    }
  });
}

}  // namespace photile
