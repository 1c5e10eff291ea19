#include "image/glare.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "image/light_layers.hpp"
#include "photile/errors.hpp"

namespace photile::image {
namespace {

/// A limit up to this value is a factor.
constexpr double largest_factor = 100;

double mean_luminance(const LightLayers& picture, const LightMix& mix) {
  std::vector<glm::vec3> rgb(static_cast<std::size_t>(picture.width) *
                             static_cast<std::size_t>(picture.height));
  combine_layers(picture, mix, rgb);
  double sum = 0;
  for (const glm::vec3& pixel : rgb) sum += luminance(pixel);
  return rgb.empty() ? 0 : sum / static_cast<double>(rgb.size());
}

}  // namespace

Glare find_glare(const LightLayers& picture, const LightLayers& reflections, const LightMix& mix,
                 double limit) {
  if (picture.width != reflections.width || picture.height != reflections.height) {
    throw UsageError("glare: the picture and its reflections differ in size");
  }
  Glare glare;
  glare.limit = limit > largest_factor ? limit : limit * mean_luminance(picture, mix);
  std::vector<double> powers;
  for (const MixedLight& light : mix.lights) {
    glare.lights.push_back({light.name});
    powers.push_back(mix.power_in_picture(light));
  }
  const auto width = static_cast<std::size_t>(picture.width);
  glare.marks.assign(width * static_cast<std::size_t>(picture.height), -1);
  for (std::size_t pixel = 0; pixel < glare.marks.size(); ++pixel) {
    double brightest = glare.limit;
    for_each_light(reflections, pixel % width, pixel / width,
                   [&](std::size_t light, float, const glm::vec3& radiance) {
                     const double reflected =
                         powers[light] *
                         luminance(glm::dvec3(mix.lights[light].tint) * glm::dvec3(radiance));
                     LightGlare& its = glare.lights[light];
                     its.peak = std::max(its.peak, reflected);
                     if (reflected <= glare.limit) return;
                     its.fraction += 1.0 / static_cast<double>(glare.marks.size());
                     if (reflected <= brightest) return;
                     brightest = reflected;
                     glare.marks[pixel] = static_cast<int>(light);
                   });
  }
  return glare;
}

std::array<std::uint8_t, 3> mark_colour(int light) {
  constexpr std::array<std::array<std::uint8_t, 3>, 7> colours{{{230, 159, 0},
                                                                {86, 180, 233},
                                                                {0, 158, 115},
                                                                {240, 228, 66},
                                                                {0, 114, 178},
                                                                {213, 94, 0},
                                                                {204, 121, 167}}};
  return colours[static_cast<std::size_t>(light) % colours.size()];
}

void draw_marks(const std::vector<int>& marks, std::vector<std::uint8_t>& rgb) {
  for (std::size_t pixel = 0; pixel < marks.size(); ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& value = rgb[3 * pixel + c];
      value =
          marks[pixel] >= 0 ? mark_colour(marks[pixel])[c] : static_cast<std::uint8_t>(value / 2);
    }
  }
}

std::vector<std::string> glare_lines(const Glare& glare, PowerUnit unit) {
  const char* symbol = unit == PowerUnit::lumen ? "cd/m2" : "W/(m2 sr)";
  std::vector<std::string> lines;
  for (const LightGlare& light : glare.lights) {
    if (!(light.fraction > 0)) continue;
    lines.push_back(fmt::format("glare: {}: {:.2g}% of the picture above {:.4g} {}, up to {:.4g}",
                                light.light, 100 * light.fraction, glare.limit, symbol,
                                light.peak));
  }
  if (lines.empty()) {
    lines.push_back(fmt::format("glare: no reflection is above {:.4g} {}", glare.limit, symbol));
  }
  return lines;
}

}  // namespace photile::image
