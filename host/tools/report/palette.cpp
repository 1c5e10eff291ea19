#include "tools/report/palette.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/srgb.hpp"
#include "photile/errors.hpp"
#include "tools/report/radiance_palettes.hpp"

namespace photile::image {
namespace {

constexpr int entries = 256;

/// Blue, white, red, linear.
constexpr std::array<float, 9> blue_red{0.02f, 0.08f, 0.6f, 1.0f, 1.0f, 1.0f, 0.6f, 0.03f, 0.02f};

OIIO::ImageBuf ramp() {
  OIIO::ImageBuf values(OIIO::ImageSpec(entries, 1, 1, OIIO::TypeDesc::FLOAT));
  for (int i = 0; i < entries; ++i) {
    const float value = static_cast<float>(i) / (entries - 1);
    values.setpixel(i, 0, &value);
  }
  return values;
}

}  // namespace

const std::vector<std::string>& Palette::names() {
  static const std::vector<std::string> all{"turbo", "viridis",  "inferno",  "magma", "plasma",
                                            "heat",  "spectrum", "blue-red", "def",   "spec",
                                            "pm3d",  "hot",      "eco"};
  return all;
}

Palette::Palette(const std::string& name) {
  const auto& known = names();
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    throw UsageError(fmt::format("no palette '{}'; there are {}", name, fmt::join(known, ", ")));
  }
  for (int i = 0; i < entries && is_radiance_palette(name); ++i) {
    const glm::dvec3 rgb = radiance_palette(name, static_cast<double>(i) / (entries - 1));
    colours_.push_back({srgb8_from_linear(static_cast<float>(rgb.r)),
                        srgb8_from_linear(static_cast<float>(rgb.g)),
                        srgb8_from_linear(static_cast<float>(rgb.b))});
  }
  if (!colours_.empty()) return;
  const OIIO::ImageBuf mapped = name == "blue-red"
                                    ? OIIO::ImageBufAlgo::color_map(ramp(), 0, 3, 3, blue_red)
                                    : OIIO::ImageBufAlgo::color_map(ramp(), 0, name);
  for (int i = 0; i < entries; ++i) {
    std::array<float, 3> rgb{};
    mapped.getpixel(i, 0, rgb.data(), 3);
    auto& colour = colours_.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      colour[c] = srgb8_from_linear(rgb[c]);  // OpenImageIO's tables are linear
    }
  }
}

std::array<std::uint8_t, 3> Palette::at(double share) const {
  if (std::isnan(share)) return {128, 128, 128};
  return colours_[static_cast<std::size_t>(
      std::lround(std::clamp(share, 0.0, 1.0) * (entries - 1)))];
}

std::string Palette::hex(double share) const {
  const auto [r, g, b] = at(share);
  return fmt::format("#{:02x}{:02x}{:02x}", r, g, b);
}

}  // namespace photile::image
