#include "scene/light_emission.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "photile/scene.hpp"

namespace photile::scene {

namespace {

constexpr std::size_t most_cells = std::size_t{1} << 22;
constexpr double most_cuts = 256;
constexpr double least_fraction = 0.02;  // of the mean luminance

/// Cuts of an edge that make cells of about a texel.
std::uint32_t cuts_of(const Scene& scene, const Light& light, std::uint32_t triangle) {
  const Texture& texture = scene.textures[light.emission_texture];
  const auto& uv = scene.corner_emission_uv[triangle];
  const glm::vec2 size(texture.width(), texture.height());
  float longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    longest = std::max(longest, glm::length(size * (uv[(i + 1) % 3] - uv[i])));
  }
  const double fraction =
      static_cast<double>(most_cells) / static_cast<double>(light.triangles.size());
  const double limit = std::max(1.0, std::min(most_cuts, std::floor(std::sqrt(fraction))));
  // A NaN or infinity among the coordinates makes a single cell.
  return longest < 1e9f ? static_cast<std::uint32_t>(
                              std::clamp(std::ceil(static_cast<double>(longest)), 1.0, limit))
                        : 1;
}

/// A cell of a triangle of n cuts: row by row from the edge between the first two corners.
struct Cell {
  std::uint32_t column, row;
  bool inverted;  ///< its tip points to that edge

  std::size_t index(std::uint32_t n) const {
    return std::size_t{row} * (2 * n - row) + 2 * column + (inverted ? 1 : 0);
  }
  static Cell at(std::size_t index, std::uint32_t n) {
    const double left = static_cast<double>(std::size_t{n} * n - index);
    const auto row = n - static_cast<std::uint32_t>(std::ceil(std::sqrt(left)));
    const std::size_t within = index - std::size_t{row} * (2 * n - row);
    return {static_cast<std::uint32_t>(within / 2), row, within % 2 == 1};
  }
  /// Weights of the triangle's second and third corner, of a point in the cell given by those of
  /// the cell's.
  glm::dvec2 point(double u, double v, std::uint32_t n) const {
    if (inverted) return glm::dvec2(column + 1 - u, row + 1 - v) / static_cast<double>(n);
    return glm::dvec2(column + u, row + v) / static_cast<double>(n);
  }
};

/// The cell that holds a point of the triangle.
Cell cell_of(double u, double v, std::uint32_t n) {
  const double x = std::clamp(u, 0.0, 1.0) * n, y = std::clamp(v, 0.0, 1.0) * n;
  const auto row = std::min(static_cast<std::uint32_t>(y), n - 1);
  const auto column = std::min(static_cast<std::uint32_t>(x), n - 1 - row);
  const bool inverted = (x - column) + (y - row) > 1.0 && column + row + 1 < n;
  return {column, row, inverted};
}

/// Mean of the radiance in a cell, from the middles of its quarters.
glm::dvec3 mean_radiance(const Scene& scene, const Light& light, std::uint32_t triangle,
                         const Cell& cell, std::uint32_t n) {
  constexpr std::array<glm::dvec2, 4> middles{
      {{1.0 / 6, 1.0 / 6}, {4.0 / 6, 1.0 / 6}, {1.0 / 6, 4.0 / 6}, {2.0 / 6, 2.0 / 6}}};
  glm::dvec3 sum(0.0);
  for (const glm::dvec2& middle : middles) {
    const glm::dvec2 at = cell.point(middle.x, middle.y, n);
    sum += textured_radiance(scene, light, {triangle, at.x, at.y});
  }
  return 0.25 * sum;
}

}  // namespace

glm::dvec3 textured_radiance(const Scene& scene, const Light& light,
                             const EmissionCells::Point& point) {
  const auto& uv = scene.corner_emission_uv[point.triangle];
  const auto u = static_cast<float>(point.u), v = static_cast<float>(point.v);
  return glm::dvec3(light.texel_radiance * scene.textures[light.emission_texture].sample(
                                               (1.0f - u - v) * uv[0] + u * uv[1] + v * uv[2]));
}

EmissionCells::EmissionCells(const Scene& scene, const Light& light) : light_(&light) {
  double area = 0;
  std::vector<glm::dvec3> means;  // of the cells of a triangle
  std::vector<double> bright;     // luminance of each cell
  for (const std::uint32_t triangle : light.triangles) {
    const std::uint32_t n = cuts_of(scene, light, triangle);
    const double whole = triangle_area(scene, triangle);
    const double cell_area = whole / (static_cast<double>(n) * n);
    triangles_.push_back({n, bright.size(), cell_area});
    area += whole;
    means.resize(std::size_t{n} * n);
    tbb::parallel_for(std::size_t{0}, means.size(), [&](std::size_t i) {
      means[i] = mean_radiance(scene, light, triangle, Cell::at(i, n), n);
    });
    for (const glm::dvec3& mean : means) {
      bright.push_back(luminance(mean));
      integral_ += cell_area * mean;
    }
  }
  const double least = area > 0 ? least_fraction * luminance(integral_) / area : 0.0;
  double sum = 0;
  for (const Triangle& triangle : triangles_) {
    const std::size_t last = triangle.first_cell + std::size_t{triangle.cuts} * triangle.cuts;
    for (std::size_t cell = triangle.first_cell; cell < last; ++cell) {
      weight_up_to_.push_back(sum += triangle.cell_area * std::max(bright[cell], least));
    }
  }
  const std::size_t fractions = std::bit_ceil(weight_up_to_.size());
  first_of_fraction_.resize(fractions + 1, static_cast<std::uint32_t>(weight_up_to_.size()));
  tbb::parallel_for(std::size_t{0}, fractions, [&](std::size_t fraction) {
    first_of_fraction_[fraction] =
        first_beyond(0, weight_up_to_.size(),
                     static_cast<double>(fraction) / static_cast<double>(fractions) * sum);
  });
}

std::uint32_t EmissionCells::first_beyond(std::size_t first, std::size_t last,
                                          double weight) const {
  const double* const cells = weight_up_to_.data();
  return static_cast<std::uint32_t>(std::upper_bound(cells + first, cells + last, weight) - cells);
}

EmissionCells::Point EmissionCells::sample(double target, double u1, double u2) const {
  const double below_one = std::min(target, 1.0 - 0x1p-53);
  const auto fraction = static_cast<std::size_t>(
      below_one * static_cast<double>(first_of_fraction_.size() - 1));  // exact: a power of two
  const std::size_t cell =
      first_beyond(first_of_fraction_[fraction], first_of_fraction_[fraction + 1],
                   below_one * weight_up_to_.back());
  const auto next = std::upper_bound(
      triangles_.begin(), triangles_.end(), cell,
      [](std::size_t value, const Triangle& triangle) { return value < triangle.first_cell; });
  const auto number = static_cast<std::size_t>(next - triangles_.begin()) - 1;
  const Triangle& triangle = triangles_[number];
  const double root = std::sqrt(u1);
  const glm::dvec2 at = Cell::at(cell - triangle.first_cell, triangle.cuts)
                            .point(root * (1 - u2), root * u2, triangle.cuts);
  return {light_->triangles[number], at.x, at.y};
}

double EmissionCells::density(const Point& point) const {
  const auto found =
      std::lower_bound(light_->triangles.begin(), light_->triangles.end(), point.triangle);
  const Triangle& triangle =
      triangles_[static_cast<std::size_t>(found - light_->triangles.begin())];
  const Cell cell = cell_of(point.u, point.v, triangle.cuts);
  return weight(triangle.first_cell + cell.index(triangle.cuts)) /
         (weight_up_to_.back() * triangle.cell_area);
}

bool set_light_color(const glm::dvec3& rgb, Light& light, double& luminance_of_rgb) {
  const glm::dvec3 positive = glm::max(rgb, glm::dvec3(0.0));
  luminance_of_rgb = luminance(positive);
  if (!std::isfinite(luminance_of_rgb) || luminance_of_rgb <= 0.0) return false;
  light.color = glm::vec3(positive / luminance_of_rgb);
  return true;
}

bool set_textured_emission(const Scene& scene, Light& light) {
  // Radiance times area in place of radiance.
  double bright = 0;
  if (!set_light_color(EmissionCells(scene, light).integral(), light, bright)) return false;
  light.power = area_flux(bright, 1.0, light.two_sided);
  light.texel_radiance = glm::vec3(glm::dvec3(light.texel_radiance) / light.power);
  return true;
}

double distant_flux(double irradiance, double angular_diameter, double radius) {
  // A disc of radiance L makes L pi sin^2 on a surface that faces it, while the flux counts its
  // solid angle L 2 pi (1 - cos).
  return directional_flux(irradiance, radius) * 2.0 / (1.0 + std::cos(0.5 * angular_diameter));
}

void add_environment_light(const std::string& name, EnvironmentMap map, Scene& scene) {
  Light light;
  light.name = name;
  light.kind = LightKind::environment;
  double bright = 0;
  set_light_color(map.integral(), light, bright);
  light.power = directional_flux(bright, bounding_sphere(scene).radius);
  light.environment = static_cast<std::uint32_t>(scene.environments.size());
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(std::move(light));
}

using std::numbers::pi;

double area_flux(double radiance, double area, bool two_sided) {
  return pi * area * radiance * (two_sided ? 2.0 : 1.0);
}

double point_flux(double intensity) { return 4.0 * pi * intensity; }

double spot_flux(double intensity, double inner_cone_angle, double outer_cone_angle) {
  const double inner = std::cos(inner_cone_angle);
  const double outer = std::cos(outer_cone_angle);
  // 2 pi times the integral over the cosine: 1 on the inner cap, and the mean of t^2 is 1/3 on the
  // ramp.
  return 2.0 * pi * intensity * ((1.0 - inner) + (inner - outer) / 3.0);
}

double directional_flux(double irradiance, double radius) {
  return irradiance * pi * radius * radius;
}

namespace {

/// Krystek, "An algorithm to calculate correlated colour temperature", 1985.
glm::dvec2 black_body(double t) {
  const double u = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) /
                   (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
  const double v = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) /
                   (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
  const double scale = 2 * u - 8 * v + 4;  // from CIE 1960 (u, v)
  return {3 * u / scale, 2 * v / scale};
}

glm::dvec2 daylight(double t) {
  const double x = t <= 7000 ? ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                             : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
  return {x, (-3 * x + 2.870) * x - 0.275};
}

}  // namespace

glm::dvec2 chromaticity_of_temperature(double kelvin) {
  const double fraction = std::clamp((kelvin - 4000) / 1000, 0.0, 1.0);  // of daylight
  return glm::mix(black_body(kelvin), daylight(std::max(kelvin, 4000.0)), fraction);
}

glm::dvec3 color_of_temperature(double kelvin) {
  const glm::dvec2 xy = chromaticity_of_temperature(kelvin);
  const double x = xy.x / xy.y, z = (1 - xy.x - xy.y) / xy.y;  // Y = 1
  const glm::dvec3 rgb(3.2404542 * x - 1.5371385 - 0.4985314 * z,
                       -0.9692660 * x + 1.8760108 + 0.0415560 * z,
                       0.0556434 * x - 0.2040259 + 1.0572252 * z);
  const glm::dvec3 inside = glm::max(rgb, glm::dvec3(0.0));
  return inside / luminance(inside);
}

}  // namespace photile::scene
