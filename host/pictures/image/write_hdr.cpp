// Radiance's pictures: G. Ward, "Real Pixels", Graphics Gems II, 1991. Pixels are not packed, which
// all of its programs read.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/scene.hpp"

namespace photile {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// lm/W of Radiance's white, and what its red, green and blue weigh in it (color.h).
constexpr double white_efficacy = 179;
double bright(const glm::dvec3& rgb) { return 0.265 * rgb.r + 0.670 * rgb.g + 0.065 * rgb.b; }

Rgbe encoded(const glm::dvec3& rgb) {
  const double largest = std::max({rgb.r, rgb.g, rgb.b});
  if (!(largest > 1e-32) || !std::isfinite(largest)) return {};
  int exponent = 0;
  const double scale = std::frexp(largest, &exponent) * 256.0 / largest;
  if (exponent > 127) return {255, 255, 255, 255};
  const auto mantissa = [&](double value) {
    return static_cast<std::uint8_t>(std::clamp(value * scale, 0.0, 255.0));
  };
  return {mantissa(rgb.r), mantissa(rgb.g), mantissa(rgb.b),
          static_cast<std::uint8_t>(exponent + 128)};
}

/// The colour of Radiance for this many cd/m2.
Rgbe texel_of(const glm::dvec3& rgb, double white_luminance) {
  const double weight = bright(rgb), seen = white_luminance * luminance(rgb);
  return weight > 0 && seen > 0 ? encoded(seen / (white_efficacy * weight) * rgb) : Rgbe{};
}

std::string header_of(const Image& picture) {
  std::string text = "#?RADIANCE\nSOFTWARE= photile\n";
  if (const auto view = picture.attributes.find("photile.view"); view != picture.attributes.end()) {
    text += "VIEW= " + view->second + "\n";
  }
  return text +
         fmt::format("FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", picture.height, picture.width);
}

}  // namespace

void write_hdr(const std::filesystem::path& file, const Image& scene_referred) {
  const auto white = scene_referred.numbers.find("whiteLuminance");
  const auto *r = scene_referred.find("R"), *g = scene_referred.find("G"),
             *b = scene_referred.find("B");
  if (white == scene_referred.numbers.end() || !r || !g || !b) {
    throw InputError(
        fmt::format("{}: the picture lacks R, G, B or the attribute whiteLuminance, which states "
                    "cd/m2; render it with photile, or write an .exr",
                    file.string()));
  }
  OutputFile output(file);
  const std::string header = header_of(scene_referred);
  output.write(header.data(), header.size());
  const auto width = static_cast<std::size_t>(scene_referred.width);
  std::vector<Rgbe> row(width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(scene_referred.height); ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      row[x] = texel_of(glm::max(glm::dvec3((*r)[i], (*g)[i], (*b)[i]), glm::dvec3(0.0)),
                        static_cast<double>(white->second));
    }
    output.write(row.data(), row.size() * sizeof(Rgbe));
  }
  output.commit();
}

}  // namespace photile
