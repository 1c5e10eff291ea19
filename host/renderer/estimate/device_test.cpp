#include "estimate/device_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <random>
#include <utility>
#include <vector>

#include "device/cache_folder.hpp"
#include "photile/device.hpp"
#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/scene.hpp"
#include "photile/scene_builder.hpp"

namespace photile::estimate {

namespace {

/// Uniform in [0, 1). Not std::uniform_real_distribution, which differs between libraries.
float uniform(std::mt19937_64& random) { return static_cast<float>(random() >> 40) * 0x1p-24f; }

/// A picture of one normal, that of the surface.
Texture flat_normal_map() { return Texture("flat", 1, 1, {{128, 128, 255, 255}}); }

/// The unit square as two triangles, with a material and lights as needed.
Scene unit_square(const SceneNeeds& needs) {
  SceneBuilder builder("plane");
  Material material;
  material.diffuse = glm::vec3(0.5f);
  if (needs.glossy) {
    material.specular = glm::vec3(0.04f);
    material.roughness = 0.3f;
  }
  if (needs.normal_maps) material.normal_texture = builder.add(flat_normal_map());
  Light light;
  light.kind = LightKind::point;
  light.power = 1;
  for (std::uint32_t i = 0; i < needs.light_count; ++i) builder.add(light);
  constexpr std::array<glm::vec3, 4> vertices{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  constexpr std::array<glm::uvec3, 2> triangles{{{0, 1, 2}, {0, 2, 3}}};
  constexpr std::array<glm::vec2, 4> uv{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  builder.add(MeshArrays{
      .vertices = vertices, .triangles = triangles, .uv = uv, .material = builder.add(material)});
  return std::move(builder).build();
}

/// The oriented face of unit_square that a point lies on, seen from above.
std::uint32_t front_at(const glm::vec3& point) {
  return point.x > point.y ? oriented(0, 0) : oriented(1, 1);
}

Photons random_photons(const SceneNeeds& needs, std::size_t count, std::mt19937_64& random) {
  Photons photons;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = uniform(random), y = uniform(random);
    photons.position.emplace_back(x, y, 0.0f);
    photons.flux.emplace_back(1.0f / static_cast<float>(count));
    photons.oriented_face.push_back(front_at(photons.position.back()));
    if (needs.light_count > 1) {
      photons.light.push_back(static_cast<std::uint16_t>(random() % needs.light_count));
    }
    if (needs.glossy) {
      const float tilt_x = uniform(random) - 0.5f, tilt_y = uniform(random) - 0.5f;
      photons.incoming.push_back(glm::normalize(glm::vec3(tilt_x, tilt_y, 1.0f)));
    }
  }
  return sort_by_oriented_face(std::move(photons), 4);
}

/// Every second bit of a Morton code.
std::uint32_t every_second_bit(std::uint32_t code) {
  std::uint32_t bits = 0;
  for (int bit = 0; bit < 16; ++bit) bits |= (code >> (2 * bit) & 1u) << bit;
  return bits;
}

PrimaryHits grid_of_hits(const Scene& scene, const SceneNeeds& needs, int per_side,
                         std::mt19937_64& random) {
  PrimaryHits hits;
  const auto side = static_cast<std::uint32_t>(per_side);
  std::uint32_t padded = 1;
  while (padded < side) padded *= 2;
  for (std::uint32_t code = 0; code < padded * padded; ++code) {
    const std::uint32_t column = every_second_bit(code), row = every_second_bit(code >> 1);
    if (column >= side || row >= side) continue;
    const float x = (static_cast<float>(column) + uniform(random)) / static_cast<float>(side);
    const float y = (static_cast<float>(row) + uniform(random)) / static_cast<float>(side);
    hits.position.emplace_back(x, y, 0.0f);
  }
  std::stable_partition(hits.position.begin(), hits.position.end(),
                        [](const glm::vec3& point) { return front_at(point) == oriented(0, 0); });
  const Material& material = scene.materials.front();
  for (const glm::vec3& position : hits.position) {
    hits.oriented_face.push_back(front_at(position));
    hits.pixel.push_back(0);
    hits.throughput.emplace_back(1.0f);
    hits.diffuse_albedo.push_back(material.diffuse);
    if (!needs.glossy) continue;
    hits.outgoing.emplace_back(0.6f, 0.0f, 0.8f);
    hits.lobe.push_back({material.specular, material.roughness, {0, 0, 1}});
    if (needs.normal_maps) hits.lobe.back().smooth_normal = {0, 0, 1};
  }
  return hits;
}

}  // namespace

PlaneSample make_plane_sample(const SceneNeeds& needs, int neighbours,
                              const PlaneSampleSize& size) {
  std::mt19937_64 random(1);
  PlaneSample sample;
  sample.scene = unit_square(needs);
  sample.photons = random_photons(needs, size.photons, random);
  sample.hits = grid_of_hits(sample.scene, needs, size.hits_per_side, random);
  sample.radius =
      2 * std::sqrt(neighbours / (glm::pi<double>() * static_cast<double>(size.photons)));
  return sample;
}

}  // namespace photile::estimate

namespace photile {

namespace {

/// A single neighbour uses other branches of the kernels.
constexpr std::array tested_neighbours = {50, 1};
constexpr estimate::PlaneSampleSize size{.photons = 20'000, .hits_per_side = 32};

/// The relative difference of distances that agree within rounding: either of two such photons may
/// be the nearer one.
constexpr double tie = 1e-5;

/// A generous bound for the rounding of a sum of 50 numbers in single precision and of a division.
constexpr double irradiance_tolerance = 1e-4;

/// The mean of estimates over some 400 discs that do not overlap, each of 50 photons, is right to
/// 0.7%. Those of one photon have no mean: their expectation is infinite.
constexpr double mean_tolerance = 0.05;

/// The squared distance of a hit to the k-th nearest of all photons.
double kth_squared_distance(const Photons& photons, const glm::dvec3& hit, std::size_t k) {
  std::vector<double> squared;
  for (const glm::vec3& position : photons.position) {
    const glm::dvec3 offset = glm::dvec3(position) - hit;
    squared.push_back(glm::dot(offset, offset));
  }
  const auto kth = squared.begin() + static_cast<std::ptrdiff_t>(k - 1);
  std::nth_element(squared.begin(), kth, squared.end());
  return *kth;
}

/// Whether the photons of a list are the nearest, ties excepted.
bool are_nearest(std::span<const std::uint32_t> list, const Photons& photons, const glm::dvec3& hit,
                 double squared_radius) {
  std::vector<std::uint32_t> sorted(list.begin(), list.end());
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) return false;
  return std::all_of(sorted.begin(), sorted.end(), [&](std::uint32_t photon) {
    if (photon >= photons.size()) return false;
    const glm::dvec3 offset = glm::dvec3(photons.position[photon]) - hit;
    return glm::dot(offset, offset) <= squared_radius * (1 + tie);
  });
}

std::string compare(const estimate::PlaneSample& sample, const NeighbourLists& lists,
                    const LightTable& estimates) {
  const auto k = static_cast<std::size_t>(lists.k);
  const double flux = sample.photons.flux.front().g;
  double mean = 0;
  for (std::size_t i = 0; i < sample.hits.size(); ++i) {
    const glm::dvec3 hit(sample.hits.position[i]);
    const double irradiance = estimates.irradiance[i].g;
    mean += irradiance / static_cast<double>(sample.hits.size());
    const double border = std::min({hit.x, hit.y, 1 - hit.x, 1 - hit.y});
    const double squared_radius = kth_squared_distance(sample.photons, hit, k);
    if (squared_radius >= sample.radius * sample.radius)
      continue;  // fewer than k within the radius
    if (!are_nearest(std::span(lists.photons).subspan(i * k, k), sample.photons, hit,
                     squared_radius)) {
      return fmt::format("the {} photons found for hit {} are not the nearest", k, i);
    }
    if (border * border <= squared_radius) continue;  // a part of the disc is off the surface
    // The k-th lies on the border of the disc, and counts where it is alone.
    const double counted = k > 1 ? static_cast<double>(k - 1) : 1.0;
    const double expected = counted * flux / (glm::pi<double>() * squared_radius);
    if (!(std::abs(irradiance - expected) <= irradiance_tolerance * expected)) {
      return fmt::format("the irradiance of hit {} from {} photons is {:.6g} instead of {:.6g}", i,
                         k, irradiance, expected);
    }
  }
  if (k > 1 && !(std::abs(mean - 1) <= mean_tolerance)) {
    return fmt::format("the mean irradiance is {:.4g} instead of 1", mean);
  }
  return {};
}

}  // namespace

std::string test_device(Device& device) {
  const SceneNeeds needs{.light_count = 1};
  const estimate::PlaneSample sample =
      estimate::make_plane_sample(needs, tested_neighbours.front(), size);
  try {
    const PhotonMaps maps(device, sample.scene, sample.photons,
                          find_neighbour_groups(sample.scene, {sample.radius}), {sample.radius});
    for (const int neighbours : tested_neighbours) {
      Estimator estimator(maps, sample.scene, {.neighbours = neighbours});
      const NeighbourLists lists = estimator.nearest(sample.hits);
      const std::string problem = compare(sample, lists, estimator.estimate(sample.hits));
      if (!problem.empty()) return problem;
    }
    return {};
  } catch (const DeviceError& error) {
    return error.what();
  }
}

std::string test_device_and_remember(Device& device) {
  std::string problem = test_device(device);
  device::keep_test_result(device.info(), problem.empty() ? device::passed : problem);
  return problem;
}

}  // namespace photile
