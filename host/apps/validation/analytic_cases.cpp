#include "validation/analytic_cases.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "photile/device/bsdf.h"
#include "photile/scene_builder.hpp"
#include "trace/opaque_bsdf.hpp"

namespace photile::validation {

Material diffuse(float albedo) {
  Material material;
  material.diffuse = glm::vec3(albedo);
  return material;
}

std::vector<Rectangle> box_walls(const glm::dvec3& size) {
  const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), zero(0);
  return {{zero, y, z}, {x, z, y}, {zero, z, x}, {y, x, z}, {zero, x, y}, {z, y, x}};
}

std::vector<Sensor> grid_of_sensors(const std::vector<Rectangle>& rectangles, double per_metre) {
  std::vector<Sensor> sensors;
  for (const Rectangle& rectangle : rectangles) {
    const auto columns = static_cast<int>(std::lround(per_metre * glm::length(rectangle.u)));
    const auto rows = static_cast<int>(std::lround(per_metre * glm::length(rectangle.v)));
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < columns; ++i) {
        sensors.push_back(
            {rectangle.at((i + 0.5) / columns, (j + 0.5) / rows), rectangle.normal()});
      }
    }
  }
  return sensors;
}

Room::Room(const std::string& name) : name_(name) {}

std::uint32_t Room::add_material(const Material& material) {
  materials_.push_back(material);
  return static_cast<std::uint32_t>(materials_.size() - 1);
}

std::uint32_t Room::add_light(LightKind kind) {
  Light& light = lights_.emplace_back();
  light.name = "lamp";
  light.kind = kind;
  light.power = 1;
  return static_cast<std::uint32_t>(lights_.size() - 1);
}

void Room::add(const Rectangle& rectangle, std::uint32_t material, std::uint32_t light) {
  const glm::dvec3 &a = rectangle.corner, b = a + rectangle.u, c = b + rectangle.v,
                   d = a + rectangle.v;
  add_triangle(a, b, c, material, light);
  add_triangle(a, c, d, material, light);
}

void Room::add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                        std::uint32_t material, std::uint32_t light) {
  triangles_.push_back({{a, b, c}, material, light});
}

void Room::add_ball(const glm::dvec3& centre, double radius, int rings, std::uint32_t material,
                    bool inwards) {
  const auto at = [&](int i, int j) {
    const double theta = glm::pi<double>() * i / rings;
    const double phi = glm::pi<double>() * (j % (2 * rings)) / rings;
    if (i == 0 || i == rings) return centre + glm::dvec3(0, 0, i == 0 ? radius : -radius);
    return centre + radius * glm::dvec3(std::sin(theta) * std::cos(phi),
                                        std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  const auto facet = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    inwards ? add_triangle(a, c, b, material) : add_triangle(a, b, c, material);
  };
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) facet(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) facet(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
}

Scene Room::build(double power) const {
  SceneBuilder builder(name_);
  for (const Material& material : materials_) builder.add(material);
  for (Light light : lights_) {
    light.power = power;
    builder.add(std::move(light));
  }
  for (const auto& [corners, material, light] : triangles_) {
    builder.triangle(glm::vec3(corners[0]), glm::vec3(corners[1]), glm::vec3(corners[2]), material,
                     light);
  }
  return std::move(builder).build();
}

double polygon_factor(const glm::dvec3& point, const glm::dvec3& normal,
                      std::span<const glm::dvec3> corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - point);
    const glm::dvec3 b = glm::normalize(corners[(i + 1) % corners.size()] - point);
    const glm::dvec3 across = glm::cross(a, b);
    const double sine = glm::length(across);
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(across, normal) / sine;
  }
  return sum / glm::two_pi<double>();
}

double rectangle_factor(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& origin,
                        const glm::dvec3& u, const glm::dvec3& v) {
  const std::array corners{origin, origin + u, origin + u + v, origin + v};
  return std::abs(polygon_factor(point, normal, corners));
}

double opposed_rectangles_factor(double a, double b, double c) {
  const double x = a / c, y = b / c;
  const double root_x = std::sqrt(1 + x * x), root_y = std::sqrt(1 + y * y);
  return 2 / (glm::pi<double>() * x * y) *
         (0.5 * std::log((1 + x * x) * (1 + y * y) / (1 + x * x + y * y)) +
          x * root_y * std::atan(x / root_y) + y * root_x * std::atan(y / root_x) -
          x * std::atan(x) - y * std::atan(y));
}

double perpendicular_rectangles_factor(double width, double height, double length) {
  const double h = height / length, w = width / length;
  const double h2 = h * h, w2 = w * w, both = h2 + w2, root = std::sqrt(both);
  const double logarithm = std::log((1 + w2) * (1 + h2) / (1 + both)) +
                           w2 * std::log(w2 * (1 + both) / ((1 + w2) * both)) +
                           h2 * std::log(h2 * (1 + both) / ((1 + h2) * both));
  return (w * std::atan(1 / w) + h * std::atan(1 / h) - root * std::atan(1 / root) +
          0.25 * logarithm) /
         (glm::pi<double>() * w);
}

namespace {

/// What the base and several facets reflect of light from all directions.
double diffuse_reflectance(double albedo, double f0, double alpha) {
  constexpr int steps = 20'000;
  const auto a = static_cast<float>(alpha), f = static_cast<float>(f0);
  const trace::DiffusePart part =
      trace::diffuse_part({glm::vec3(static_cast<float>(albedo)), glm::vec3(f), 1.0f, a}, 1.0f);
  PhotileAlbedoFit fit;
  photile_albedo_fit(a, &fit);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    float f0_weight = 0, f90_weight = 0;
    photile_lobe_albedo(&fit, static_cast<float>(std::sqrt((i + 0.5) / steps)), &f0_weight,
                        &f90_weight);
    sum += double{photile_diffuse(part[0].r, part[1].r, part[2].r, f0_weight, f90_weight)};
  }
  return double{PHOTILE_PI} * sum / steps;
}

}  // namespace

double glossy_reflectance(double albedo, double f0, double alpha) {
  constexpr int steps = 200'000;
  const double a2 = alpha * alpha;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps;
    // The lobe over half vectors h drawn with the density D (n.h), which inverts to this cosine.
    // The view is along n, so v.h = n.h and dw_i = 4 (v.h) dw_h: what is left of f (n.i) is F G2 /
    // n.i, where Smith's G2 with one direction along the normal is G1 of the other.
    const double n_dot_h = std::sqrt((1 - u) / (1 + (a2 - 1) * u));
    const double n_dot_i = 2 * n_dot_h * n_dot_h - 1;
    if (n_dot_i > 0) {
      const double masking = 2 / (1 + std::sqrt(1 - a2 + a2 / (n_dot_i * n_dot_i)));
      sum += (f0 + (1 - f0) * std::pow(1 - n_dot_h, 5)) * masking;
    }
  }
  return sum / steps + diffuse_reflectance(albedo, f0, alpha);
}

}  // namespace photile::validation
