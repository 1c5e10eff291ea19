#include "photile/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>
#include <vector>

#include "device/test_results.hpp"
#include "estimate/plane_sample.hpp"
#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/scene.hpp"

namespace photile {
namespace {

constexpr int neighbours = 50;
constexpr estimate::PlaneSampleSize size{.photons = 20'000, .hits_per_side = 32};

/// Distances that agree but for rounding, relative: which of two such photons is the nearer is
/// open.
constexpr double tie = 1e-5;

/// Roundings of a sum of 50 numbers in single precision and of a division, by far.
constexpr double irradiance_tolerance = 1e-4;

/// The mean of estimates over some 400 discs that do not overlap, each of 50 photons, is right to
/// 0.7%.
constexpr double mean_tolerance = 0.05;

/// Squared distances of a hit to all photons, with their indices, nearest first; ties by index.
std::vector<std::pair<double, std::uint32_t>> by_distance(const Photons& photons,
                                                          const glm::dvec3& hit) {
  std::vector<std::pair<double, std::uint32_t>> sorted;
  for (std::uint32_t i = 0; i < photons.position.size(); ++i) {
    const glm::dvec3 offset = glm::dvec3(photons.position[i]) - hit;
    sorted.emplace_back(glm::dot(offset, offset), i);
  }
  std::partial_sort(sorted.begin(), sorted.begin() + neighbours + 1, sorted.end());
  sorted.resize(neighbours + 1);
  return sorted;
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
                    const Estimates& estimates) {
  constexpr auto k = static_cast<std::size_t>(neighbours);
  const double flux = sample.photons.flux.front().g;
  double mean = 0;
  for (std::size_t i = 0; i < sample.hits.size(); ++i) {
    const glm::dvec3 hit(sample.hits.position[i]);
    const double irradiance = estimates.irradiance[i].g;
    mean += irradiance / static_cast<double>(sample.hits.size());
    const double border = std::min({hit.x, hit.y, 1 - hit.x, 1 - hit.y});
    const auto nearest = by_distance(sample.photons, hit);
    const double squared_radius = nearest[k - 1].first;
    if (squared_radius >= sample.radius * sample.radius)
      continue;  // fewer than k within the radius
    if (!are_nearest(std::span(lists.photons).subspan(i * k, k), sample.photons, hit,
                     squared_radius)) {
      return fmt::format("the {} photons found for hit {} are not the nearest", neighbours, i);
    }
    if (border * border <= squared_radius) continue;  // a part of the disc is off the surface
    const double expected = (neighbours - 1) * flux / (glm::pi<double>() * squared_radius);
    if (!(std::abs(irradiance - expected) <= irradiance_tolerance * expected)) {
      return fmt::format("the irradiance of hit {} is {:.6g} where {:.6g} is right", i, irradiance,
                         expected);
    }
  }
  if (!(std::abs(mean - 1) <= mean_tolerance)) {
    return fmt::format("the mean irradiance is {:.4g} where 1 is right", mean);
  }
  return {};
}

}  // namespace

std::string test_device(Device& device) {
  const SceneNeeds needs{.light_count = 1};
  const estimate::PlaneSample sample = estimate::make_plane_sample(needs, neighbours, size);
  try {
    const PhotonMaps maps(device, sample.scene, sample.photons,
                          find_neighbour_groups(sample.scene, {sample.radius}), {sample.radius});
    Estimator estimator(maps, sample.scene, {.neighbours = neighbours});
    const NeighbourLists lists = estimator.nearest(sample.hits);
    return compare(sample, lists, estimator.estimate(sample.hits));
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
