#include "report/palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "image/srgb.hpp"
#include "photile/errors.hpp"
#include "report/palette_colours.hpp"

namespace photile::report {
namespace {

constexpr int entries = 256;

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
  for (int i = 0; i < entries; ++i) {
    const double share = static_cast<double>(i) / (entries - 1);
    const glm::dvec3 rgb =
        is_radiance_palette(name) ? radiance_palette(name, share) : knot_colour(name, share);
    colours_.push_back({image::srgb8_from_linear(static_cast<float>(rgb.r)),
                        image::srgb8_from_linear(static_cast<float>(rgb.g)),
                        image::srgb8_from_linear(static_cast<float>(rgb.b))});
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

}  // namespace photile::report
