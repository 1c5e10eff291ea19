#include "glare/luminaires.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "geometry/disjoint_sets.hpp"
#include "photile/defaults.hpp"
#include "trace/emission_sampling.hpp"
#include "trace/ray_query.hpp"

namespace photile::glare {
namespace {

/// Triangles that share corners, as lists; corners at the same position are one.
std::vector<std::vector<std::uint32_t>> connected_parts(const Scene& scene,
                                                        std::span<const std::uint32_t> triangles) {
  geometry::DisjointSets joined(triangles.size());
  std::map<std::array<float, 3>, std::uint32_t> first_at;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    for (const glm::vec3& corner : scene.corners(triangles[i])) {
      joined.join(i, first_at.try_emplace({corner.x, corner.y, corner.z}, i).first->second);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> parts;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    parts[joined.find(i)].push_back(triangles[i]);
  }
  std::vector<std::vector<std::uint32_t>> lists;
  for (auto& [first, list] : parts) lists.push_back(std::move(list));
  return lists;
}

/// Position i of any number of them evenly spread over a triangle (Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018), as weights of its second and third corner.
glm::vec2 place_in_triangle(int i) {
  constexpr double plastic = 1.32471795724474602596;  // the root of x^3 = x + 1
  glm::dvec2 place = glm::fract(0.5 + (i + 1.0) * glm::dvec2(1 / plastic, 1 / (plastic * plastic)));
  if (place.x + place.y > 1) place = 1.0 - place;
  return glm::vec2(place);
}

/// cd/m2 (or lm for lux) of a layer's radiance at its power in the mix.
glm::dvec3 power_of(const LightMix& mix, std::uint32_t layer) {
  const MixedLight& light = mix.lights[layer];
  return mix.lumens_of(light) * glm::dvec3(light.tint);
}

/// The opening of an area light by a photometric file: the file's, which the flat surface stands
/// for where it is as large as that is from below, or the surface.
LuminousOpening opening_of_surface(const IntensityDistribution& distribution, double area) {
  const LuminousOpening& in_file = distribution.opening();
  const double below = in_file.projected_area({0, 0, -1});
  if (std::abs(below - area) <= 0.01 * area) return in_file;
  return {.x = area, .y = 1};
}

}  // namespace

Luminaires::Luminaires(const RayScene& rays, int samples)
    : rays_(rays), groups_(light_groups_of(rays.scene())) {
  const Scene& scene = rays.scene();
  const std::vector<glm::vec3> radiance = emitted_radiance_at_unit_power(scene);
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
    if (scene.lights[light].kind == LightKind::area) {
      add_area_light(light, radiance[light], samples);
    } else if (scene.lights[light].has_position()) {
      const std::uint32_t file = scene.lights[light].distribution;
      Luminaire luminaire{scene.lights[light].name, light, glm::vec3(0.0f), {{{}, 1.0f}}, {}};
      luminaire.patches.front().point.position = scene.lights[light].position;
      luminaire.opening = file == none ? LuminousOpening{} : scene.distributions[file].opening();
      luminaires_.push_back(std::move(luminaire));
    }
  }
}

void Luminaires::add_area_light(std::uint32_t light, const glm::vec3& radiance, int samples) {
  const Scene& scene = rays_.scene();
  const auto parts = connected_parts(scene, scene.lights[light].triangles);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Luminaire luminaire{scene.lights[light].name, light, radiance, {}, {}};
    if (parts.size() > 1) luminaire.name += fmt::format(" {}", i + 1);
    double whole = 0;
    for (const std::uint32_t triangle : parts[i]) whole += triangle_area(scene, triangle);
    const std::uint32_t file = scene.lights[light].distribution;
    if (file != none) luminaire.opening = opening_of_surface(scene.distributions[file], whole);
    for (const std::uint32_t triangle : parts[i]) {
      const double area = triangle_area(scene, triangle);
      const int count = std::max(1, static_cast<int>(std::ceil(samples * area / whole)));
      for (int place = 0; place < count; ++place) {
        const glm::vec2 uv = place_in_triangle(place);
        for (const std::uint32_t side : {0u, 1u}) {
          const trace::SurfacePoint point =
              trace::surface_point(scene, {triangle, uv.x, uv.y}, side);
          if (!trace::emits(scene, point)) continue;
          luminaire.patches.push_back({point, static_cast<float>(area / count)});
          if (luminaire.opening) break;  // its intensities distinguish the sides
        }
      }
    }
    if (!luminaire.patches.empty()) luminaires_.push_back(std::move(luminaire));
  }
}

VisibleLuminaire Luminaires::seen_in_parts(
    const Luminaire& luminaire, const Observer& observer, const glm::dvec3& eye,
    const std::function<PatchSeen(const Patch&, const glm::dvec3& direction)>& of_patch) const {
  VisibleLuminaire seen{luminaire.name};
  double light = 0, weighed = 0;
  for (const Patch& patch : luminaire.patches) {
    const glm::dvec3 way = glm::dvec3(patch.point.position) - eye;
    const double distance = glm::length(way);
    const glm::dvec3 direction = way / distance;
    const double ahead = glm::dot(direction, observer.forward);
    if (!(distance > 0) || !(ahead > 0)) continue;
    const auto [area, candela] = of_patch(patch, direction);
    if (!(candela > 0)) continue;
    const double solid_angle = area / (distance * distance), lux = candela / (distance * distance);
    const double p = position_index(observer, direction);
    seen.projected_area += area;
    seen.solid_angle += solid_angle;
    seen.illuminance += ahead * lux;
    seen.direction += solid_angle * direction;
    light += lux;
    weighed += solid_angle / (p * p);
  }
  if (!(light > 0)) return seen;
  seen.luminance = light / seen.solid_angle;
  seen.position_index = std::sqrt(seen.solid_angle / weighed);
  seen.direction = glm::normalize(seen.direction);
  return seen;
}

VisibleLuminaire Luminaires::surface_seen(const Luminaire& luminaire, const Observer& observer,
                                          const glm::dvec3& eye, const glm::dvec3& power) const {
  return seen_in_parts(luminaire, observer, eye, [&](const Patch& patch, const glm::dvec3& way) {
    const glm::vec3 back(-way);
    const double cosine = -glm::dot(way, glm::dvec3(patch.point.normal));
    if (!(cosine > 0)) return PatchSeen{};
    const glm::dvec3 passes(
        trace::transmittance(rays_, glm::vec3(eye), patch.point.origin_towards(back)));
    if (passes == glm::dvec3(0.0)) return PatchSeen{};
    const glm::vec3 radiance =
        luminaire.radiance * trace::emission_towards(rays_.scene(), patch.point, back);
    const double area = cosine * static_cast<double>(patch.area);
    return PatchSeen{area, area * luminance(power * glm::dvec3(radiance) * passes)};
  });
}

VisibleLuminaire Luminaires::lamp_seen(const Luminaire& luminaire, const Observer& observer,
                                       const glm::dvec3& eye, const glm::dvec3& power) const {
  const Scene& scene = rays_.scene();
  const Light& lamp = scene.lights[luminaire.light];
  const trace::LightAxes axes(lamp);
  double whole = 0;
  for (const Patch& patch : luminaire.patches) whole += static_cast<double>(patch.area);
  return seen_in_parts(luminaire, observer, eye, [&](const Patch& patch, const glm::dvec3& way) {
    const glm::vec3 place = lamp.kind == LightKind::area
                                ? patch.point.origin_towards(glm::vec3(-way)).position
                                : lamp.position;
    const double share = static_cast<double>(patch.area) / whole;
    const double area = share * std::max(luminaire.opening->projected_area(axes.to_light(-way)),
                                         defaults::small_source_area);
    return PatchSeen{area,
                     share * groups_.fraction[luminaire.light] *
                         trace::candela_per_lumen(scene, lamp, -way) *
                         luminance(power * glm::dvec3(lamp.color) *
                                   glm::dvec3(trace::transmittance(rays_, glm::vec3(eye), place)))};
  });
}

std::vector<VisibleLuminaire> Luminaires::seen_by(const Observer& in_file,
                                                  const LightMix& mix) const {
  const trace::FlushDenormals flush_denormals;
  const Observer observer = in_scene(rays_.scene(), in_file);
  const glm::dvec3& eye = observer.position;
  std::vector<VisibleLuminaire> all;
  for (const Luminaire& luminaire : luminaires_) {
    const glm::dvec3 power = power_of(mix, groups_.group_of[luminaire.light]);
    if (!(luminance(power) > 0)) continue;
    VisibleLuminaire seen = luminaire.opening ? lamp_seen(luminaire, observer, eye, power)
                                              : surface_seen(luminaire, observer, eye, power);
    if (!(seen.luminance > 0)) continue;
    seen.direction = direction_in_world(rays_.scene(), seen.direction);
    all.push_back(std::move(seen));
  }
  return all;
}

double Luminaires::large_area(const glm::dvec3& up) const {
  double sum = 0;
  for (const Luminaire& luminaire : luminaires_) {
    double area = 0, downwards = 0;
    if (luminaire.opening) {
      const trace::LightAxes axes(rays_.scene().lights[luminaire.light]);
      area = downwards = luminaire.opening->projected_area(axes.to_light(-up));
    } else {
      for (const Patch& patch : luminaire.patches) {
        area += static_cast<double>(patch.area);
        downwards += static_cast<double>(patch.area) *
                     std::max(0.0, -glm::dot(glm::dvec3(patch.point.normal), up));
      }
    }
    if (area > defaults::large_source_area) sum += downwards;
  }
  return sum;
}

}  // namespace photile::glare
