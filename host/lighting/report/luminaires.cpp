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

std::string polar_curve_svg(const IntensityDistribution& lamp) {
  constexpr double radius = 78, size = 200;  // pixels
  constexpr int steps = 180;
  double most = 0;
  for (const double plane : {0.0, 90 * degrees}) {
    for (int i = -steps; i <= steps; ++i) {
      most = std::max(most, intensity_at(lamp, plane, i * 180 * degrees / steps));
    }
  }
  if (!(most > 0)) return {};
  const double ring = rounded_up(most / 4, {1.0, 2.0, 2.5, 5.0}), scale = radius / (4 * ring),
               middle = size / 2;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {0}\" width=\"{0}\" "
      "height=\"{0}\" font-family=\"sans-serif\" font-size=\"8\">\n",
      size);
  for (int i = 1; i <= 4; ++i) {
    text += fmt::format(
        "<circle cx=\"{0}\" cy=\"{0}\" r=\"{1:.2f}\" fill=\"none\" stroke=\"#bbbbbb\" "
        "stroke-width=\"0.6\"/>\n<text x=\"{2}\" y=\"{3:.2f}\">{4:g}</text>\n",
        middle, i * radius / 4, middle + 2, middle + i * radius / 4 - 2, i * ring);
  }
  for (int angle = 0; angle < 360; angle += 30) {
    const double x = std::sin(angle * degrees), y = std::cos(angle * degrees);
    const int shown = angle <= 180 ? angle : 360 - angle;
    text += fmt::format(
        "<path stroke=\"#dddddd\" stroke-width=\"0.6\" d=\"M{0} {0}L{1:.2f} {2:.2f}\"/>\n"
        "<text x=\"{3:.2f}\" y=\"{4:.2f}\" text-anchor=\"middle\" "
        "fill=\"#777777\">{5}\u00b0</text>\n",
        middle, middle + radius * x, middle + radius * y, middle + (radius + 11) * x,
        middle + (radius + 11) * y + 3, shown);
  }
  for (const auto& [plane, style] :
       {std::pair(0.0, "stroke=\"#b00020\""),
        std::pair(90.0, "stroke=\"#0050b0\" stroke-dasharray=\"4 2\"")}) {
    text += fmt::format("<path fill=\"none\" stroke-width=\"1.4\" {} d=\"", style);
    for (int i = -steps; i <= steps; ++i) {
      const double angle = i * 180 * degrees / steps;
      const double reach = scale * intensity_at(lamp, plane * degrees, angle);
      text += fmt::format("{}{:.2f} {:.2f}", i == -steps ? "M" : "L",
                          middle + reach * std::sin(angle), middle + reach * std::cos(angle));
    }
    text += "\"/>\n";
  }
  return text + fmt::format("<text x=\"2\" y=\"{}\">cd/klm</text>\n</svg>\n", size - 2);
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
