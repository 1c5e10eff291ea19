#include "report/luminaires.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "report/tables.hpp"

namespace photile::report {
namespace {

constexpr double degrees = glm::pi<double>() / 180;

/// cd per 1000 lm in a plane, at an angle from the aim that is negative on the plane's other side.
double intensity_at(const IntensityDistribution& lamp, double plane, double angle) {
  const double across = std::sin(angle);
  const glm::dvec3 direction(across * std::cos(plane), across * std::sin(plane), -std::cos(angle));
  return 1000 * lamp.intensity(direction) / lamp.flux();
}

}  // namespace

std::vector<std::pair<std::string, std::string>> data_rows(const IntensityDistribution& lamp) {
  const LuminaireData& data = lamp.data();
  std::vector<std::pair<std::string, std::string>> rows;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) rows.emplace_back(name, value);
  };
  add("maker", data.maker);
  add("article", data.article);
  add("luminaire", data.luminaire);
  add("lamps", data.source);
  if (data.watts > 0) {
    add("power",
        fmt::format("{} W, {:.0f} lm/W", number_text(data.watts, 4), lamp.flux() / data.watts));
  }
  if (data.kelvin > 0) {
    const bool tunable = data.highest_kelvin > data.kelvin;
    add("colour temperature",
        fmt::format("{:.0f}{} K", data.kelvin,
                    tunable ? fmt::format(" to {:.0f}", data.highest_kelvin) : ""));
  }
  if (data.rendering > 0) add("colour rendering", fmt::format("Ra {:.0f}", data.rendering));
  return rows;
}

std::array<std::vector<double>, 2> intensities_of(const IntensityDistribution& lamp) {
  std::array<std::vector<double>, 2> planes;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (int angle = -180; angle <= 180; ++angle) {
      planes[i].push_back(
          intensity_at(lamp, static_cast<double>(i) * 90 * degrees, angle * degrees));
    }
  }
  return planes;
}

std::vector<Part> parts_of(const Scene& scene, const std::vector<double>& lumens) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::uint32_t distribution = scene.lights[i].distribution;
    if (distribution == none) continue;
    const IntensityDistribution* const lamp = &scene.distributions[distribution];
    auto part = std::find_if(parts.begin(), parts.end(),
                             [&](const Part& each) { return each.lamp->name() == lamp->name(); });
    if (part == parts.end()) part = parts.insert(part, Part{lamp});
    ++part->count;
    part->lumens += lumens[i];
    part->watts += lamp->electrical_watts(lumens[i]);
  }
  return parts;
}

}  // namespace photile::report
