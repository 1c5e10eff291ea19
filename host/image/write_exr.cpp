#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>

#include "image/output_file.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"

namespace photile {
namespace {

/// Rows that are interleaved and handed over at once; a multiple of the 16 rows of a ZIP block.
constexpr int rows_per_write = 64;

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

OIIO::ImageSpec header_of(const Image& image, const std::vector<std::size_t>& order) {
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(order.size()),
                       OIIO::TypeDesc::FLOAT);
  for (std::size_t i = 0; i < order.size(); ++i) {
    spec.channelnames[i] = image.channel_names[order[i]];
  }
  spec.attribute("compression", "zip");
  // OpenImageIO would write the present time, and the same render would give other bytes each time.
  spec.attribute("DateTime", "");

  constexpr std::array<float, 8> rec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709.data());
  spec.attribute("colorInteropID", "lin_rec709_scene");
  for (const auto& [name, value] : image.attributes) spec.attribute(name, value);
  for (const auto& [name, value] : image.numbers) spec.attribute(name, value);
  for (const auto& [name, matrix] : image.matrices) {
    spec.attribute(name, OIIO::TypeDesc::TypeMatrix, matrix.data());
  }
  return spec;
}

}  // namespace

void write_exr(const std::filesystem::path& file, const Image& image) {
  image::OutputFile output(file);
  if (image.width < 1 || image.height < 1 || image.channels.empty()) {
    output.fail("the picture has no pixels");
  }
  const std::vector<std::size_t> order = file_order(image);
  const auto encoder = OIIO::ImageOutput::create("exr", &output);
  if (!encoder || !encoder->open(file.string(), header_of(image, order))) {
    output.fail(encoder ? encoder->geterror() : OIIO::geterror());
  }

  const std::size_t width = static_cast<std::size_t>(image.width);
  std::vector<float> rows;
  for (int first = 0; first < image.height; first += rows_per_write) {
    const int last = std::min(first + rows_per_write, image.height);
    const std::size_t offset = static_cast<std::size_t>(first) * width;
    const std::size_t pixels = static_cast<std::size_t>(last - first) * width;
    rows.resize(pixels * order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::vector<float>& plane = image.channels[order[i]];
      for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        rows[pixel * order.size() + i] = plane[offset + pixel];
      }
    }
    if (!encoder->write_scanlines(first, last, 0, OIIO::TypeDesc::FLOAT, rows.data())) {
      output.fail(encoder->geterror());
    }
  }
  if (!encoder->close()) output.fail(encoder->geterror());
  output.commit();
}

}  // namespace photile
