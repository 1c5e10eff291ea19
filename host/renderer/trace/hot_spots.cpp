#include "trace/hot_spots.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "photile/defaults.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/light_clusters.hpp"
#include "trace/ray_query.hpp"
#include "trace/ray_scene.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {
namespace {

/// A hot spot reaches to this part of the distance to what surrounds the light: the fourth root of
/// the mean fourth power, which tells the room from a housing that is open to it. A light that
/// hangs lower lights so much of a ceiling that rays meet it anyway.
constexpr double reach_of_surroundings = 1.0 / 8;
/// Lights whose close surface reflects less of their flux have no hot spot.
constexpr double least_flux = 1e-3;
/// The fraction of rays that is aimed at hot spots is the fraction of the lights' flux that they
/// reflect, within bounds.
constexpr double least_rays = 0.25, most_rays = 0.5;
/// Directions in which surface around a light is looked for.
constexpr std::uint32_t directions_around = 256;
/// Cells of a light's directions: rows of the polar angle, columns of the azimuth.
constexpr std::size_t rows = 96, columns = 48;
/// Panes and cutouts that light may pass on its way.
constexpr int most_surfaces = 4096;

/// By a number in [0, 1) that is as even afterwards.
std::size_t choose(const std::vector<double>& up_to, double& u) {
  const double target = u * up_to.back();
  // The last entry is larger than the target, up to rounding.
  const auto chosen =
      std::min(static_cast<std::size_t>(std::upper_bound(up_to.begin(), up_to.end(), target) -
                                        up_to.begin()),
               up_to.size() - 1);
  const double before = chosen == 0 ? 0.0 : up_to[chosen - 1];
  u = std::clamp((target - before) / (up_to[chosen] - before), 0.0, 1 - 0x1p-24);
  return chosen;
}

/// About z, precise for narrow beams.
///   turn   of a whole one
glm::vec3 local_direction(double cosine, double turn) {
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  const double azimuth = glm::two_pi<double>() * turn;
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

}  // namespace

double HotSpots::Spot::solid_angle(std::size_t row) const {
  const auto from = static_cast<double>(row);
  return glm::two_pi<double>() / columns *
         (std::cos(from * cell_angle) - std::cos((from + 1) * cell_angle));
}

HotSpots::HotSpots(const RayScene::Impl& rays) : rays_(&rays) {
  const Scene& scene = *rays.scene;
  if (std::none_of(scene.lights.begin(), scene.lights.end(),
                   [](const Light& light) { return light.has_position(); })) {
    return;
  }
  const std::vector<double> fractions = light_fractions(scene.lights, PhotonQuota::balanced);
  std::vector<std::optional<Spot>> found(scene.lights.size());
  std::vector<double> reach(scene.lights.size(), 0.0);
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(found.size()),
                    [&](std::uint32_t light) {
                      const FlushDenormals flush_denormals;
                      if (!scene.lights[light].has_position()) return;
                      reach[light] = reach_of_surroundings * surroundings_of(light);
                      if (reach[light] > 0) found[light] = spot_of(light, reach[light]);
                    });
  double all = 0;
  for (std::uint32_t light = 0; light < found.size(); ++light) {
    if (!found[light]) {
      reach[light] = 0;
      continue;
    }
    found[light]->share = fractions[light] * found[light]->up_to.back();
    all += found[light]->share;
    spots_.push_back(std::move(*found[light]));
  }
  reach_ = std::move(reach);
  rays_to_spots_ = std::clamp(all, least_rays, most_rays);
}

const Light& HotSpots::scene_light(std::uint32_t light) const {
  return rays_->scene->lights[light];
}

/// Distance to surface around a light, metres; 0 where nothing is, or all of it is
/// farther than the part of it that may be close.
double HotSpots::surroundings_of(std::uint32_t light) const {
  const RandomBlock scramble({0, 0, 0, 0});
  double fourth_powers = 0, least = std::numeric_limits<double>::infinity();
  int met = 0;
  for (std::uint32_t i = 0; i < directions_around; ++i) {
    const glm::dvec2 u = sobol_point(i, scramble);
    const glm::vec3 direction = sample_sphere(static_cast<float>(u.x), static_cast<float>(u.y));
    const auto hit = rays_->intersect(scene_light(light).position, direction);
    if (!hit) continue;
    const glm::dvec3 way =
        position_of(*rays_->scene, *hit) - glm::dvec3(scene_light(light).position);
    fourth_powers += glm::dot(way, way) * glm::dot(way, way);
    least = std::min(least, glm::length(way));
    ++met;
  }
  const double surroundings = met > 0 ? std::pow(fourth_powers / met, 0.25) : 0;
  return least < reach_of_surroundings * surroundings ? surroundings : 0;
}

/// Where light from a light ends, if that is an opaque surface within reach.
std::optional<SurfacePoint> HotSpots::first_surface(std::uint32_t light, const glm::vec3& direction,
                                                    double reach) const {
  const Scene& scene = *rays_->scene;
  const glm::vec3& start = scene_light(light).position;
  RayOrigin origin(start);
  for (int passed = 0; passed <= most_surfaces; ++passed) {
    const auto hit = rays_->intersect(origin, direction);
    if (!hit) return std::nullopt;
    const SurfacePoint point = surface_hit(scene, *hit, direction);
    if (!(glm::distance(point.position, start) < reach)) return std::nullopt;
    if (transmittance(scene, point, direction) == glm::vec3(0.0f)) {
      if (material_of(scene, point).interaction != Interaction::opaque) return std::nullopt;
      return point;
    }
    origin = point.origin_towards(direction);
  }
  return std::nullopt;
}

/// The hot spot of a light, if it sends enough of its flux there.
std::optional<HotSpots::Spot> HotSpots::spot_of(std::uint32_t light, double reach) const {
  const Scene& scene = *rays_->scene;
  const Light& source = scene_light(light);
  const double widest = source.kind == LightKind::spot && source.distribution == none
                            ? static_cast<double>(source.outer_cone_angle)
                            : glm::pi<double>();
  Spot spot{
      .light = light, .axes = Frame(source.direction), .cell_angle = widest / rows, .up_to = {}};
  double sum = 0, squares = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const auto in_cell = [&](double u, double v) {
        return spot.axes.to_world(
            local_direction(std::cos((static_cast<double>(row) + u) * spot.cell_angle),
                            (static_cast<double>(column) + v) / columns));
      };
      double intensity = 0;
      for (const double u : {1.0 / 6, 0.5, 5.0 / 6}) {
        for (const double v : {0.25, 0.75}) {
          intensity += candela_per_lumen(scene, source, glm::dvec3(in_cell(u, v))) / 6;
        }
      }
      double reflected = 0;
      if (intensity > 0) {
        if (const auto point = first_surface(light, in_cell(0.5, 0.5), reach)) {
          const scene::Reflectance surface = reflectance(scene, *point);
          const glm::dvec3 all = glm::min(surface.albedo + surface.f0, glm::vec3(1.0f));
          reflected = luminance(all) * intensity * spot.solid_angle(row);
          spot.centre += reflected * glm::dvec3(point->position);
          squares += reflected * glm::dot(glm::dvec3(point->position), glm::dvec3(point->position));
        }
      }
      spot.up_to.push_back(sum += reflected);
    }
  }
  if (!(sum > least_flux)) return std::nullopt;
  spot.centre /= sum;
  spot.radius = std::sqrt(std::max(0.0, squares / sum - glm::dot(spot.centre, spot.centre)));
  return spot;
}

/// Of the light's directions, per steradian, of the one that leads to a point; 0 where the point is
/// not in the hot spot.
double HotSpots::density(const Spot& spot, const SurfacePoint& point) const {
  const glm::vec3& position = scene_light(spot.light).position;
  if (!holds(spot.light, point.position)) return 0;
  const glm::dvec3 way = glm::dvec3(position) - glm::dvec3(point.position);
  if (!(glm::dot(way, glm::dvec3(point.normal)) > 0)) return 0;
  const glm::dvec3 local = glm::dvec3(spot.axes.to_local(glm::vec3(-glm::normalize(way))));
  const double polar = std::atan2(std::hypot(local.x, local.y), local.z);
  const double azimuth = std::atan2(local.y, local.x) / glm::two_pi<double>();
  const auto row = static_cast<std::size_t>(polar / spot.cell_angle);
  const auto column = static_cast<std::size_t>((azimuth - std::floor(azimuth)) * columns);
  if (row >= rows) return 0;
  const double weight = spot.weight(row * columns + std::min(column, columns - 1));
  if (!(weight > 0)) return 0;
  if (transmittance(*rays_, point.origin_towards(glm::vec3(way)), position) == glm::vec3(0.0f)) {
    return 0;
  }
  return weight / (spot.up_to.back() * spot.solid_angle(row));
}

const HotSpots& hot_spots_of(const RayScene& rays) { return hot_spots_of(impl_of(rays)); }

HotSpotAim::HotSpotAim(const HotSpots& spots, const glm::vec3& from, const glm::vec3* normal)
    : spots_(&spots), from_(from) {
  up_to_.reserve(spots.spots_.size());
  for (const HotSpots::Spot& spot : spots.spots_) {
    const glm::dvec3 way = spot.centre - from_;
    const double distance = std::max(glm::length(way), 2 * spot.radius);
    double cosine = 1;
    if (normal) {
      cosine =
          std::clamp((glm::dot(way, glm::dvec3(*normal)) + 2 * spot.radius) / distance, 0.0, 1.0);
    }
    up_to_.push_back(all_ += spot.share * cosine / (distance * distance));
  }
}

std::optional<HotSpotAim::Target> HotSpotAim::sample(glm::dvec2 u) const {
  const HotSpots::Spot& spot = spots_->spots_[choose(up_to_, u.x)];
  const std::size_t cell = choose(spot.up_to, u.x);
  const std::size_t row = cell / columns;
  const double from = std::cos(static_cast<double>(row) * spot.cell_angle);
  const double to = std::cos(static_cast<double>(row + 1) * spot.cell_angle);
  const double turn = (static_cast<double>(cell % columns) + u.y) / columns;
  const glm::vec3 leaves = spot.axes.to_world(local_direction(glm::mix(from, to, u.x), turn));
  const auto point = spots_->first_surface(spot.light, leaves, spots_->reach_[spot.light]);
  if (!point) return std::nullopt;
  const glm::dvec3 way = glm::dvec3(point->position) - from_;
  if (!(glm::dot(way, glm::dvec3(point->normal)) < 0)) return std::nullopt;
  // Hot spots of other lights may hold it as well.
  const double density = this->density(*point);
  if (!(density > 0)) return std::nullopt;
  return Target{*point, glm::vec3(glm::normalize(way)), density};
}

/// Directions of a light as directions from the point.
double HotSpotAim::per_steradian(double per_steradian_of_light, const HotSpots::Spot& spot,
                                 const SurfacePoint& point) const {
  const glm::dvec3 at(point.position), normal(point.normal);
  const glm::dvec3 to_light = glm::dvec3(spots_->scene_light(spot.light).position) - at;
  const glm::dvec3 back = from_ - at;
  const auto over_cosine = [&](const glm::dvec3& way) {
    return std::pow(glm::dot(way, way), 1.5) / glm::dot(way, normal);
  };
  return per_steradian_of_light * over_cosine(back) / over_cosine(to_light);
}

double HotSpotAim::density(const SurfacePoint& met) const {
  if (!(all_ > 0) || !(glm::dot(from_ - glm::dvec3(met.position), glm::dvec3(met.normal)) > 0)) {
    return 0;
  }
  double density = 0;
  for (std::size_t i = 0; i < up_to_.size(); ++i) {
    const double chosen = (up_to_[i] - (i == 0 ? 0.0 : up_to_[i - 1])) / all_;
    if (!(chosen > 0)) continue;
    const HotSpots::Spot& spot = spots_->spots_[i];
    const double of_light = spots_->density(spot, met);
    if (of_light > 0) density += chosen * per_steradian(of_light, spot, met);
  }
  return density;
}

}  // namespace photile::trace
