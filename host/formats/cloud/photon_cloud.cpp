#include "photile/photon_cloud.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>
#include <utility>

#include "cloud/voxels.hpp"
#include "common/value_range.hpp"
#include "geometry/box.hpp"
#include "groups/automatic_radius.hpp"
#include "maps/build_maps.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/statistics.hpp"
#include "scene/scene_queries.hpp"

namespace photile {
namespace {

void check_size(std::string_view what, std::size_t size, std::size_t expected,
                std::string_view owners, std::string_view who = "photon cloud") {
  if (size == expected) return;
  throw InputError(fmt::format("{}: {} {} for {} {}", who, size, what, expected, owners));
}

void check_places(std::string_view what, std::span<const glm::vec3> places) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec3& p = places[i];
    if (scene::within_limit(glm::dvec3(p))) continue;
    throw InputError(
        fmt::format("{} {} lies at ({}, {}, {}); coordinates must be numbers up to {:g} m", what, i,
                    p.x, p.y, p.z, limits::max_coordinate));
  }
}

void check_normals(std::string_view what, std::span<const glm::vec3> normals) {
  constexpr double slack = 1e-3;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const double length = glm::length(glm::dvec3(normals[i]));
    if (std::abs(length - 1.0) <= slack) continue;
    throw InputError(fmt::format("{} {} has a normal of length {}; it must be 1", what, i, length));
  }
}

void check(const CloudPhotons& photons, const CloudParameters& parameters) {
  const std::size_t count = photons.position.size();
  if (count > limits::max_stored_photons) {
    throw UsageError(fmt::format("photon cloud: {} photons; at most {} can be indexed", count,
                                 limits::max_stored_photons));
  }
  if (!(parameters.radius > 0) || !(parameters.radius <= limits::max_radius)) {
    throw UsageError(fmt::format("photon cloud: the radius is {} m; it must be a positive number",
                                 parameters.radius));
  }
  check_setting("angle_degrees", setting_value(parameters.angle_degrees));
  check_setting("photons_per_cell", setting_value(parameters.photons_per_cell));
  if (!photons.normal.empty()) check_size("normals", photons.normal.size(), count, "photons");
  if (!photons.flux.empty()) check_size("flux values", photons.flux.size(), count, "photons");
  if (!photons.light.empty()) check_size("lights", photons.light.size(), count, "photons");
  check_places("photon cloud: photon", photons.position);
  check_normals("photon cloud: photon", photons.normal);
  for (std::size_t i = 0; i < photons.flux.size(); ++i) {
    const glm::vec3& flux = photons.flux[i];
    if (std::isfinite(flux.x) && std::isfinite(flux.y) && std::isfinite(flux.z)) continue;
    throw InputError(fmt::format("photon cloud: photon {} has a flux that is not a number", i));
  }
}

std::uint32_t light_count(std::span<const std::uint16_t> lights) {
  const auto most = std::max_element(lights.begin(), lights.end());
  const std::uint32_t count = most == lights.end() ? 1u : 1u + *most;
  if (count > limits::max_lights) {
    throw InputError(fmt::format("photon cloud: light {}; at most {} lights are possible",
                                 count - 1, limits::max_lights));
  }
  return count;
}

/// Each photon stands for a separate oriented face, since tables of normals and maps are indexed by
/// faces.
Photons as_stored(const CloudPhotons& cloud, const SceneNeeds& needs) {
  Photons photons;
  photons.position.assign(cloud.position.begin(), cloud.position.end());
  photons.flux.assign(cloud.flux.begin(), cloud.flux.end());
  photons.flux.resize(photons.size(), glm::vec3(1.0f));
  if (needs.several_lights()) photons.light.assign(cloud.light.begin(), cloud.light.end());
  photons.oriented_face.resize(photons.size());
  std::iota(photons.oriented_face.begin(), photons.oriented_face.end(), 0u);
  photons.first_of.resize(photons.size() + 1);
  std::iota(photons.first_of.begin(), photons.first_of.end(), 0u);
  return photons;
}

void check(const NeighbourSearch& search) {
  if (search.points.empty()) throw InputError("neighbours: there are no points");
  check_setting("neighbours", setting_value(search.k));
  check_setting("angle_degrees", setting_value(search.angle_degrees));
  if (!(search.max_distance > 0)) {
    throw UsageError(
        fmt::format("neighbours: the largest distance is {} m; it must be a positive number",
                    search.max_distance));
  }
  if (!search.normals.empty() || !search.query_normals.empty()) {
    check_size("normals", search.normals.size(), search.points.size(), "points", "neighbours");
    check_size("normals", search.query_normals.size(), search.queries.size(), "queries",
               "neighbours");
  }
  check_places("neighbours: point", search.points);
  check_places("neighbours: query", search.queries);
  check_normals("neighbours: point", search.normals);
  check_normals("neighbours: query", search.query_normals);
}

/// From any query to any point it is no farther than this.
double largest_distance(const NeighbourSearch& search) {
  geometry::Box box;
  for (const glm::vec3& point : search.points) box.extend(point);
  for (const glm::vec3& query : search.queries) box.extend(query);
  const double diagonal = glm::distance(glm::dvec3(box.lower), glm::dvec3(box.upper));
  return std::max(diagonal * (1 + 1e-6), limits::min_radius);
}

/// Twice the distance to the k-th nearest point, where that is less than around most queries: cubes
/// as wide as sparse points need would have dense ones in few cells of their grids.
double radius_for(const NeighbourSearch& search, std::span<const std::uint32_t> open) {
  constexpr std::size_t most_points = 1 << 18, most_queries = 64, least_rank = 4;
  const std::size_t all = search.points.size(), count = std::min(all, most_points);
  const std::size_t sample = std::min(open.size(), most_queries);
  // In an even part of the points that many stand for k.
  const std::size_t rank =
      std::min(std::max(static_cast<std::size_t>(search.k) * count / all, least_rank), count);
  std::vector<float> distances(sample);
  tbb::parallel_for(std::size_t{0}, sample, [&](std::size_t i) {
    const glm::vec3& query = search.queries[open[groups::spread_index(i, sample, open.size())]];
    std::vector<float> of_points(count);
    for (std::size_t j = 0; j < count; ++j) {
      of_points[j] = glm::distance(query, search.points[groups::spread_index(j, count, all)]);
    }
    const auto kth = of_points.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(of_points.begin(), kth, of_points.end());
    distances[i] = *kth;
  });
  const auto eighth = distances.begin() + static_cast<std::ptrdiff_t>(sample / 8);
  std::nth_element(distances.begin(), eighth, distances.end());
  return 2 * static_cast<double>(*eighth);
}

}  // namespace

struct PhotonCloud::Impl {
  std::vector<glm::vec3> positions;
  bool has_normals;
  cloud::Voxels voxels;
  maps::MapStore* store = nullptr;  ///< of `photon_maps`
  PhotonMaps photon_maps;

  Impl(Device& device, const CloudPhotons& photons, const CloudParameters& parameters,
       Progress& progress)
      : positions(photons.position.begin(), photons.position.end()),
        has_normals(!photons.normal.empty()),
        voxels(photons.position, photons.normal, parameters.radius, parameters.angle_degrees),
        photon_maps(build(device, photons, parameters, progress)) {}

  PhotonMaps build(Device& device, const CloudPhotons& cloud, const CloudParameters& parameters,
                   Progress& progress);

  /// Places points beyond the photons, where their maps and normals are queried.
  PrimaryHits place(std::span<const glm::vec3> points, std::span<const glm::vec3> normals);
};

PhotonMaps PhotonCloud::Impl::build(Device& device, const CloudPhotons& cloud,
                                    const CloudParameters& parameters, Progress& progress) {
  SceneNeeds needs;
  needs.light_count = light_count(cloud.light);
  const Photons photons = as_stored(cloud, needs);
  progress.begin("build photon maps", 0, "references");
  const Stopwatch stopwatch;
  auto owned = std::make_unique<maps::MapStore>(
      device, needs, PhotonMapParameters{parameters.radius, parameters.photons_per_cell});
  store = owned.get();
  // Without normals all agree.
  store->angle_degrees = has_normals ? parameters.angle_degrees : 180.0;
  store->cos_angle = has_normals ? std::cos(glm::radians(parameters.angle_degrees)) : -1.0;
  store->statistics.photons = photons.size();
  store->normals.assign(cloud.normal.begin(), cloud.normal.end());
  if (photons.size() > 0) {
    store->map_of = voxels.take_own_maps();
    maps::build_maps(*store, photons, nullptr, voxels.take_plan(), progress);
  }
  store->statistics.spilled_bytes = store->pages.spilled_bytes();
  store->statistics.seconds = stopwatch.seconds();
  progress.end();
  return maps::maps_in(std::move(owned));
}

PrimaryHits PhotonCloud::Impl::place(std::span<const glm::vec3> points,
                                     std::span<const glm::vec3> normals) {
  if (has_normals || !normals.empty())
    check_size("normals", normals.size(), points.size(), "points");
  if (!has_normals && !normals.empty()) {
    throw InputError(
        "photon cloud: the points have normals, but the photons have none; leave out the normals "
        "of the points");
  }
  check_places("photon cloud: point", points);
  check_normals("photon cloud: point", normals);
  const std::size_t photons = positions.size();
  if (points.size() > limits::max_stored_photons - photons) {
    throw UsageError(fmt::format(
        "photon cloud: {} points and {} photons are too many at once; pass fewer points",
        points.size(), photons));
  }
  const auto normal_of = [&](std::size_t i) {
    return normals.empty() ? glm::vec3(0, 0, 1) : normals[i];
  };
  PrimaryHits hits;
  hits.position.assign(points.begin(), points.end());
  hits.oriented_face.resize(points.size());
  std::iota(hits.oriented_face.begin(), hits.oriented_face.end(),
            static_cast<std::uint32_t>(photons));
  store->map_of.resize(photons + points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    store->map_of[photons + i] = voxels.map_at(points[i], normal_of(i));
  }
  if (!store->normals.empty()) {
    store->normals.resize(photons + points.size());
    for (std::size_t i = 0; i < points.size(); ++i) store->normals[photons + i] = normal_of(i);
  }
  return hits;
}

PhotonCloud::PhotonCloud(Device& device, const CloudPhotons& photons,
                         const CloudParameters& parameters, Progress& progress) {
  check(photons, parameters);
  impl_ = std::make_unique<Impl>(device, photons, parameters, progress);
}
PhotonCloud::~PhotonCloud() = default;
PhotonCloud::PhotonCloud(PhotonCloud&&) noexcept = default;
PhotonCloud& PhotonCloud::operator=(PhotonCloud&&) noexcept = default;

std::size_t PhotonCloud::size() const { return impl_->positions.size(); }
const PhotonMapStatistics& PhotonCloud::statistics() const {
  return impl_->photon_maps.statistics();
}

CloudNeighbours PhotonCloud::nearest(std::span<const glm::vec3> points,
                                     std::span<const glm::vec3> normals, int k, double radius) {
  Estimator estimator(impl_->photon_maps, Scene(),
                      {.neighbours = k, .radius = radius, .area = AreaMode::disc});
  NeighbourLists lists = estimator.nearest(impl_->place(points, normals), ListOrder::any);
  CloudNeighbours result;
  result.k = k;
  result.photons = std::move(lists.photons);
  result.squared_distance.resize(result.photons.size(), std::numeric_limits<float>::infinity());
  const auto width = static_cast<std::size_t>(k);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()), [&](const auto& range) {
    // Distance and photon in one number: floats that are not negative sort as their bits do.
    std::vector<std::uint64_t> row;
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      row.clear();
      for (std::size_t j = i * width; j < (i + 1) * width && result.photons[j] != none; ++j) {
        const glm::dvec3 offset =
            glm::dvec3(impl_->positions[result.photons[j]]) - glm::dvec3(points[i]);
        const auto distance = static_cast<float>(glm::dot(offset, offset));
        row.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 |
                      result.photons[j]);
      }
      std::sort(row.begin(), row.end());
      for (std::size_t j = 0; j < row.size(); ++j) {
        result.squared_distance[i * width + j] =
            std::bit_cast<float>(static_cast<std::uint32_t>(row[j] >> 32));
        result.photons[i * width + j] = static_cast<std::uint32_t>(row[j]);
      }
    }
  });
  return result;
}

LightTable PhotonCloud::irradiance(std::span<const glm::vec3> points,
                                   std::span<const glm::vec3> normals,
                                   const CloudEstimateParameters& parameters) {
  Estimator estimator(impl_->photon_maps, Scene(),
                      {.neighbours = parameters.neighbours,
                       .radius = parameters.radius,
                       .area = AreaMode::disc,
                       .kernel = parameters.kernel});
  return estimator.estimate(impl_->place(points, normals));
}

CloudNeighbours find_neighbours(Device& device, const NeighbourSearch& search, Progress& progress) {
  check(search);
  const auto k = static_cast<std::size_t>(search.k);
  const std::size_t most = std::min(k, search.points.size());  // that any query finds
  CloudNeighbours result;
  result.k = search.k;
  result.photons.resize(search.queries.size() * k, none);
  result.squared_distance.resize(result.photons.size(), std::numeric_limits<float>::infinity());

  const double largest = largest_distance(search);
  const double last = std::min(search.max_distance, largest);
  std::vector<std::uint32_t> open(search.queries.size());  // queries that found too few so far
  std::iota(open.begin(), open.end(), 0u);
  for (double radius = limits::min_radius; !open.empty();) {
    constexpr double least_growth = 4;
    radius = std::min(std::max(radius_for(search, open), least_growth * radius), largest);
    PhotonCloud maps(device, {.position = search.points, .normal = search.normals},
                     {.radius = radius, .angle_degrees = search.angle_degrees}, progress);
    std::vector<std::uint32_t> still_open;
    progress.begin("find neighbours", open.size(), "queries");
    constexpr std::size_t at_a_time = 1 << 18;  // requests to stop are heard between them
    for (std::size_t first = 0; first < open.size(); first += at_a_time) {
      const auto part = std::span(open).subspan(first, std::min(at_a_time, open.size() - first));
      std::vector<glm::vec3> places, normals;
      for (const std::uint32_t query : part) {
        places.push_back(search.queries[query]);
        if (!search.normals.empty()) normals.push_back(search.query_normals[query]);
      }
      const CloudNeighbours found =
          maps.nearest(places, normals, static_cast<int>(most), std::min(radius, last));
      for (std::size_t i = 0; i < part.size(); ++i) {
        std::copy_n(&found.photons[i * most], most, &result.photons[part[i] * k]);
        std::copy_n(&found.squared_distance[i * most], most, &result.squared_distance[part[i] * k]);
        if (found.photons[(i + 1) * most - 1] == none) still_open.push_back(part[i]);
      }
      progress.advance(part.size());
      progress.throw_if_cancelled();
    }
    progress.end();
    if (radius >= last) break;
    open = std::move(still_open);
  }
  return result;
}

}  // namespace photile
