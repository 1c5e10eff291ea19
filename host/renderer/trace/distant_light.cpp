#include "trace/distant_light.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "photile/light_layers.hpp"
#include "photile/scene.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {

EnvironmentSampler::EnvironmentSampler(const EnvironmentMap& map)
    : EnvironmentSampler(map, [](const glm::dvec3&) { return 1.0; }) {}

EnvironmentSampler::EnvironmentSampler(
    const EnvironmentMap& map, const std::function<double(const glm::dvec3& direction)>& factor)
    : map_(&map) {
  texel_up_to_.reserve(static_cast<std::size_t>(map.width()) *
                       static_cast<std::size_t>(map.height()));
  double all = 0;
  for (int row = 0; row < map.height(); ++row) {
    double sum = 0;
    for (int column = 0; column < map.width(); ++column)
      texel_up_to_.push_back(sum += luminance(map.texel(column, row)) *
                                    factor(map.direction_at(column + 0.5, row, 0.5)));
    row_up_to_.push_back(all += sum * map.solid_angle(row));
  }
}

EnvironmentSampler::Sample EnvironmentSampler::sample(const RandomBlock& random) const {
  // The last entries are larger than the targets, so there always are a row and a texel.
  const double target = random.uniform_double(0) * row_up_to_.back();
  const auto row = static_cast<std::size_t>(
      std::upper_bound(row_up_to_.begin(), row_up_to_.end(), target) - row_up_to_.begin());
  const double before = row == 0 ? 0.0 : row_up_to_[row - 1];
  const double within = (target - before) / (row_up_to_[row] - before);  // uniform again
  const auto first = texel_up_to_.begin() + static_cast<std::ptrdiff_t>(row) * map_->width();
  const auto last = first + map_->width();
  const auto chosen = std::upper_bound(first, last, std::min(within, 1 - 0x1p-53) * *(last - 1));
  const auto column = static_cast<int>(std::min(chosen, last - 1) - first);
  const glm::vec3& radiance = map_->texel(column, static_cast<int>(row));
  const double bright = luminance(radiance);
  return {glm::vec3(map_->direction_at(column + double{random.uniform(2)}, static_cast<int>(row),
                                       double{random.uniform(3)})),
          glm::vec3(glm::dvec3(radiance) / bright),
          static_cast<float>(weight(column, static_cast<int>(row)) / row_up_to_.back())};
}

double EnvironmentSampler::weight(int column, int row) const {
  const std::size_t texel =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(map_->width()) +
      static_cast<std::size_t>(column);
  return texel_up_to_[texel] - (column == 0 ? 0.0 : texel_up_to_[texel - 1]);
}

float EnvironmentSampler::density(const glm::vec3& direction) const {
  const std::size_t texel = map_->texel_towards(direction);
  const auto width = static_cast<std::size_t>(map_->width());
  return static_cast<float>(
      weight(static_cast<int>(texel % width), static_cast<int>(texel / width)) / row_up_to_.back());
}

namespace {

// Cells of the sphere, by elevation and azimuth: some for each patch of the finest skies.
constexpr int sphere_rows = 90, sphere_columns = 180;
constexpr std::size_t few_lights = 4;  ///< that are not worth a table

/// Clockwise from -z as seen from above, in [0, 2 pi).
double azimuth_of(const glm::dvec3& direction) {
  const double azimuth = std::atan2(direction.x, -direction.z);
  return azimuth < 0 ? azimuth + glm::two_pi<double>() : azimuth;
}

glm::dvec3 sky_direction(double azimuth, double sine) {
  const double cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
  return {cosine * std::sin(azimuth), sine, -cosine * std::cos(azimuth)};
}

bool sees_patch(const glm::vec4& patch, const glm::dvec3& direction) {
  // The bounds are floats, and so is the sine.
  if (direction.y < static_cast<double>(patch.z)) return false;
  if (direction.y >= static_cast<double>(patch.w) && patch.w < 1.0f) return false;
  const double from = patch.x, width = static_cast<double>(patch.y) - from;
  if (width >= glm::two_pi<double>() - 1e-5) return true;
  double turned = std::fmod(azimuth_of(direction) - from, glm::two_pi<double>());
  if (turned < 0) turned += glm::two_pi<double>();
  return turned < width;
}

}  // namespace

bool sees_disc(const Light& sun, const glm::vec3& direction) {
  if (sun.is_sky_patch()) return sees_patch(sun.sky_patch, glm::dvec3(direction));
  // The sine is compared, because near 1 a cosine of floats cannot resolve the disc's border.
  const glm::dvec3 seen(direction), centre(-sun.direction);
  return glm::dot(seen, centre) > 0 &&
         glm::length(glm::cross(seen, centre)) <
             std::sin(0.5 * static_cast<double>(sun.angular_diameter));
}

double disc_solid_angle(const Light& sun) {
  const glm::dvec4 patch(sun.sky_patch);
  if (sun.is_sky_patch()) return (patch.y - patch.x) * (patch.w - patch.z);
  const double half_sine = std::sin(0.25 * static_cast<double>(sun.angular_diameter));
  return 4 * glm::pi<double>() * half_sine * half_sine;  // 2 pi (1 - cos)
}

DistantLight::DistantLight(const Scene& scene, std::uint32_t light, double fraction, double radius)
    : source_(&scene.lights[light]), light_(light) {
  const double disc = glm::pi<double>() * radius * radius;  // that each direction's light crosses
  if (source_->kind == LightKind::environment) {
    map_ = &scene.environments[source_->environment];
    factor_ = glm::vec3(static_cast<float>(fraction / (disc * luminance(map_->integral()))));
  } else {
    factor_ =
        glm::vec3(glm::dvec3(source_->color) * fraction / (disc * disc_solid_angle(*source_)));
  }
}

glm::vec3 DistantLight::radiance(const glm::vec3& direction) const {
  if (map_ != nullptr) return factor_ * map_->radiance(direction);
  return sees_disc(*source_, direction) ? factor_ : glm::vec3(0.0f);
}

DistantLights::DistantLights(const Scene& scene) {
  const LightGroups groups = light_groups_of(scene);
  const double radius = bounding_sphere(scene).radius;
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    if (light.has_size() && light.kind != LightKind::area)
      lights_.emplace_back(scene, i, groups.fraction[i], radius);
  }
  const auto count = static_cast<std::uint32_t>(lights_.size());
  cells_.resize(count <= few_lights ? 1 : sphere_rows * sphere_columns);
  for (std::uint32_t index = 0; index < count; ++index) {
    const Light& light = lights_[index].source();
    if (cells_.size() == 1 || light.kind == LightKind::environment) {
      for (auto& cell : cells_) cell.push_back(index);
      continue;
    }
    // Whatever is nearer to a cell's middle than the light and the cell reach.
    const DistantSampler sampler(scene, light);
    const glm::dvec3 middle = sampler.middle();
    const glm::dvec4 patch(light.sky_patch);
    double reach = 0.5 * static_cast<double>(light.angular_diameter);
    if (light.is_sky_patch()) {
      for (const double azimuth : {patch.x, 0.5 * (patch.x + patch.y), patch.y}) {
        for (const double sine : {patch.z, patch.w}) {
          const double cosine = glm::dot(middle, sky_direction(azimuth, sine));
          reach = std::max(reach, std::acos(std::clamp(cosine, -1.0, 1.0)));
        }
      }
      // The borders between corners bulge where a patch goes far round.
      if (patch.y - patch.x > 1.1) reach = glm::pi<double>();
    }
    constexpr double cell_reach = 0.7072 * glm::pi<double>() / sphere_rows + 1e-4;
    for (int row = 0; row < sphere_rows; ++row) {
      const double polar = glm::pi<double>() * (row + 0.5) / sphere_rows;
      for (int column = 0; column < sphere_columns; ++column) {
        const double azimuth = glm::two_pi<double>() * (column + 0.5) / sphere_columns;
        const double cosine = glm::dot(middle, sky_direction(azimuth, std::cos(polar)));
        if (std::acos(std::clamp(cosine, -1.0, 1.0)) > reach + cell_reach) continue;
        cells_[static_cast<std::size_t>(row * sphere_columns + column)].push_back(index);
      }
    }
  }
}

std::size_t DistantLights::cell_towards(const glm::vec3& direction) {
  const double polar = std::acos(std::clamp(static_cast<double>(direction.y), -1.0, 1.0));
  const double azimuth = azimuth_of(glm::dvec3(direction));
  const int row =
      std::min(sphere_rows - 1, static_cast<int>(polar / glm::pi<double>() * sphere_rows));
  const int column = std::min(sphere_columns - 1,
                              static_cast<int>(azimuth / glm::two_pi<double>() * sphere_columns));
  return static_cast<std::size_t>(row * sphere_columns + column);
}

DistantSampler::DistantSampler(const Scene& scene, const Light& light) : light_(&light) {
  if (light.kind == LightKind::environment) map_.emplace(scene.environments[light.environment]);
}

DistantSampler::Sample DistantSampler::sample(const RandomBlock& random) const {
  if (map_) return map_->sample(random);
  if (light_->is_sky_patch()) {
    const glm::dvec4 patch(light_->sky_patch);
    const double sine = patch.z + random.uniform_double(0) * (patch.w - patch.z);
    const double azimuth = patch.x + double{random.uniform(2)} * (patch.y - patch.x);
    return {glm::vec3(sky_direction(azimuth, sine)), light_->color,
            static_cast<float>(1 / disc_solid_angle(*light_))};
  }
  const double half_sine = std::sin(0.25 * static_cast<double>(light_->angular_diameter));
  const double below_one = random.uniform_double(0) * 2 * half_sine * half_sine;  // 1 - cosine
  const double sine = std::sqrt(below_one * (2 - below_one));
  const double phi = glm::two_pi<double>() * random.uniform(2);
  const Frame frame(-light_->direction);
  const glm::vec3 direction =
      frame.to_world(glm::vec3(sine * std::cos(phi), sine * std::sin(phi), 1 - below_one));
  return {glm::normalize(direction), light_->color,
          static_cast<float>(1 / disc_solid_angle(*light_))};
}

glm::dvec3 DistantSampler::middle() const {
  if (!light_->is_sky_patch()) return -glm::dvec3(light_->direction);
  const glm::dvec4 patch(light_->sky_patch);
  if (patch.y - patch.x >= glm::two_pi<double>() - 1e-5) {
    return {0.0, patch.z + patch.w < 0 ? -1.0 : 1.0, 0.0};  // a cap
  }
  return sky_direction(0.5 * (patch.x + patch.y),
                       std::sin(0.5 * (std::asin(patch.z) + std::asin(std::min(1.0, patch.w)))));
}

float DistantSampler::density(const glm::vec3& direction) const {
  if (map_) return map_->density(direction);
  return sees_disc(*light_, direction) ? static_cast<float>(1 / disc_solid_angle(*light_)) : 0.0f;
}

}  // namespace photile::trace
