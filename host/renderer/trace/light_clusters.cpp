#include "trace/light_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <numeric>
#include <string>

#include "common/ascii_text.hpp"
#include "geometry/box.hpp"
#include "photile/errors.hpp"

namespace photile::trace {

namespace {

/// The most clusters that a point weighs, which cost less than two rays.
constexpr std::size_t most_clusters = 64;
/// The fraction of light samples that are chosen by power alone.
constexpr double everywhere = 0.5;
/// Up to `most_by_strata` clusters get probabilities that are multiples of 1 / `strata`: of
/// `strata` Sobol points each cluster then gets exactly its number, where by chance it would get
/// one more or one less, which is all the noise that two suns have. Each cluster has at least one
/// stratum, so that at most three eighths of the samples are spread over the clusters regardless of
/// their weights.
constexpr std::size_t most_by_strata = 12, strata = 32;

/// Cosine of a - b, or 1 where b is larger, by cosines and sines of angles up to pi.
float cosine_of_difference(float cosine_a, float sine_a, float cosine_b, float sine_b) {
  return cosine_a >= cosine_b ? 1.0f : cosine_a * cosine_b + sine_a * sine_b;
}

float sine_of(float cosine) { return std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)); }

glm::dvec3 middle_of(const Scene& scene, std::uint32_t triangle) {
  const auto [a, b, c] = scene.corners(triangle);
  return (glm::dvec3(a) + glm::dvec3(b) + glm::dvec3(c)) / 3.0;
}

using Box = geometry::BoxOf<double>;

}  // namespace

LightClusters::LightClusters(const Scene& scene, std::span<const double> fractions,
                             const BoundingSphere& bounds, std::span<const std::uint32_t> left_out)
    : whole_(scene.lights.size(), none),
      far_(static_cast<float>(1 / (bounds.radius * bounds.radius))) {
  if (scene.lights.size() > most_lights) return;
  double all = 1;
  for (const std::uint32_t light : left_out) all -= fractions[light];
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
    if (std::binary_search(left_out.begin(), left_out.end(), light)) continue;
    const Light& source = scene.lights[light];
    Cluster cluster{.light = light, .fraction = static_cast<float>(fractions[light] / all)};
    if (source.kind == LightKind::area) {
      add_area_light(scene, cluster);
      continue;
    }
    cluster.is_far = source.is_distant();
    cluster.center = source.position;
    whole_[light] = static_cast<std::uint32_t>(clusters_.size());
    clusters_.push_back(cluster);
  }
  std::vector<float> extent;  // weighed by the share; 0 of what cannot be cut
  const auto extent_of = [&](const Cluster& cluster) {
    return cluster.last - cluster.first > 1 ? cluster.fraction * cluster.radius : 0.0f;
  };
  for (const Cluster& cluster : clusters_) extent.push_back(extent_of(cluster));
  while (clusters_.size() < most_clusters) {
    const auto largest = std::max_element(extent.begin(), extent.end());
    if (largest == extent.end() || !(*largest > 0.0f)) break;
    const auto index = static_cast<std::size_t>(largest - extent.begin());
    if (!cut(scene, index)) {
      *largest = 0.0f;
      continue;
    }
    *largest = extent_of(clusters_[index]);
    extent.push_back(extent_of(clusters_.back()));
  }
  for (std::uint32_t cluster = 0; cluster < clusters_.size(); ++cluster) {
    const std::vector<std::uint32_t>& of_light = scene.lights[clusters_[cluster].light].triangles;
    for (std::uint32_t i = clusters_[cluster].first; i < clusters_[cluster].last; ++i) {
      of_triangle_[of_light[triangles_[i].number]] = cluster;
    }
  }
}

void LightClusters::add_area_light(const Scene& scene, Cluster cluster) {
  const Light& light = scene.lights[cluster.light];
  cluster.first = static_cast<std::uint32_t>(triangles_.size());
  for (std::uint32_t number = 0; number < light.triangles.size(); ++number) {
    triangles_.push_back({number, 0});
  }
  cluster.last = static_cast<std::uint32_t>(triangles_.size());
  enclose(scene, cluster);
  if (light.emission_texture != none) {
    triangles_.resize(cluster.first);
    cluster.last = cluster.first;
    whole_[cluster.light] = static_cast<std::uint32_t>(clusters_.size());
  } else {
    of_triangle_.resize(scene.triangle_count(), none);
    sum_areas(scene, cluster);
  }
  clusters_.push_back(cluster);
}

/// Finds the sphere and the cone of a cluster.
void LightClusters::enclose(const Scene& scene, Cluster& cluster) const {
  const Light& light = scene.lights[cluster.light];
  const auto visit = [&](const auto& with) {
    for (std::uint32_t i = cluster.first; i < cluster.last; ++i) {
      with(light.triangles[triangles_[i].number]);
    }
  };
  Box box;
  glm::dvec3 normals(0.0);
  visit([&](std::uint32_t triangle) {
    for (const glm::vec3& corner : scene.corners(triangle)) box.extend(glm::dvec3(corner));
    const double area = triangle_area(scene, triangle);
    if (area > 0)
      normals += area * face_normal(scene, oriented(triangle, scene.front_side[triangle]));
  });
  cluster.center = glm::vec3(box.centre());
  double squared_radius = 0;
  visit([&](std::uint32_t triangle) {
    for (const glm::vec3& corner : scene.corners(triangle)) {
      const glm::dvec3 offset = glm::dvec3(corner) - glm::dvec3(cluster.center);
      squared_radius = std::max(squared_radius, glm::dot(offset, offset));
    }
  });
  cluster.radius = static_cast<float>(std::sqrt(squared_radius));
  cluster.cone_cosine = -1;
  cluster.cone_sine = 0;
  if (light.two_sided || !(glm::length(normals) > 0)) return;
  const glm::dvec3 axis = glm::normalize(normals);
  double cosine = 1;
  visit([&](std::uint32_t triangle) {
    if (!(triangle_area(scene, triangle) > 0)) return;
    const glm::dvec3 normal = face_normal(scene, oriented(triangle, scene.front_side[triangle]));
    cosine = std::min(cosine, glm::dot(axis, normal));
  });
  cluster.axis = glm::vec3(axis);
  cluster.cone_cosine = static_cast<float>(cosine);
  cluster.cone_sine = sine_of(cluster.cone_cosine);
}

/// Sums the areas of the triangles of a cluster, in their order.
void LightClusters::sum_areas(const Scene& scene, const Cluster& cluster) {
  double area = area_before(cluster);
  for (std::uint32_t i = cluster.first; i < cluster.last; ++i) {
    const Light& light = scene.lights[cluster.light];
    area += triangle_area(scene, light.triangles[triangles_[i].number]);
    triangles_[i].area_up_to = area;
  }
}

/// The area of the clusters of the light before this one.
double LightClusters::area_before(const Cluster& cluster) const {
  return cluster.first == 0 ? 0.0 : triangles_[cluster.first - 1].area_up_to;
}

/// In the middle of its longest side. Returns false where nothing can be parted.
bool LightClusters::cut(const Scene& scene, std::size_t index) {
  Cluster cluster = clusters_[index];
  const Light& light = scene.lights[cluster.light];
  const auto middle = [&](const Triangle& triangle) {
    return middle_of(scene, light.triangles[triangle.number]);
  };
  const auto begin = triangles_.begin() + cluster.first, end = triangles_.begin() + cluster.last;
  Box box;
  std::for_each(begin, end, [&](const Triangle& triangle) { box.extend(middle(triangle)); });
  const int axis = box.longest_axis();
  const double cut = 0.5 * (box.lower[axis] + box.upper[axis]);
  const double whole_area = area(static_cast<std::uint32_t>(index));  // while its order stands
  const auto second = std::stable_partition(
      begin, end, [&](const Triangle& triangle) { return middle(triangle)[axis] < cut; });
  sum_areas(scene, cluster);
  Cluster rest = cluster;
  cluster.last = rest.first = static_cast<std::uint32_t>(second - triangles_.begin());
  if (cluster.first == cluster.last) return false;  // what lies farthest is in the rest
  const double part = triangles_[cluster.last - 1].area_up_to - area_before(cluster);
  if (!(part > 0) || !(part < whole_area)) return false;
  cluster.fraction *= static_cast<float>(part / whole_area);
  rest.fraction *= static_cast<float>(1 - part / whole_area);
  enclose(scene, cluster);
  enclose(scene, rest);
  clusters_[index] = cluster;
  clusters_.push_back(rest);
  return true;
}

/// An upper bound of the illuminance by a cluster, up to its colour and a factor that is the same
/// for all clusters.
float LightClusters::weight(const Cluster& cluster, const glm::vec3& position,
                            const glm::vec3& normal) const {
  if (cluster.is_far) return cluster.fraction * far_;
  const glm::vec3 offset = cluster.center - position;
  const float squared_distance = glm::dot(offset, offset);
  const float squared_radius = cluster.radius * cluster.radius;
  if (squared_distance <= squared_radius) return cluster.fraction / squared_radius;
  const float distance = std::sqrt(squared_distance);
  const float sphere_sine = cluster.radius / distance;
  const float sphere_cosine = sine_of(sphere_sine);
  const float arriving = glm::dot(offset, normal) / distance;
  const float cosine =
      cosine_of_difference(arriving, sine_of(arriving), sphere_cosine, sphere_sine);
  if (!(cosine > 0.0f)) return 0.0f;
  float leaving = 0.25f;  // to all sides
  if (cluster.cone_cosine > -1.0f) {
    const float towards = -glm::dot(offset, cluster.axis) / distance, sine = sine_of(towards);
    leaving = cosine_of_difference(towards, sine, cluster.cone_cosine, cluster.cone_sine);
    if (leaving < 1.0f) {
      leaving = cosine_of_difference(leaving, sine_of(leaving), sphere_cosine, sphere_sine);
    }
    if (!(leaving > 0.0f)) return 0.0f;
  }
  return cluster.fraction * cosine * leaving / squared_distance;
}

void LightClusters::weigh(const glm::vec3& position, const glm::vec3& normal,
                          SelectionProbabilities& probabilities) const {
  probabilities.up_to.resize(clusters_.size());
  double weights = 0;
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    weights += probabilities.up_to[i] = double{weight(clusters_[i], position, normal)};
  }
  const bool near = weights > 0 && std::isfinite(weights);
  double sum = 0;
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    const double fraction = double{clusters_[i].fraction};
    const double probability =
        near ? everywhere * fraction + (1 - everywhere) * probabilities.up_to[i] / weights
             : fraction;
    sum += probability;
    probabilities.up_to[i] =
        clusters_.size() > most_by_strata
            ? sum
            : (static_cast<double>(i + 1) +
               std::round(static_cast<double>(strata - clusters_.size()) * sum)) /
                  strata;
  }
}

LightClusters::Choice LightClusters::choose(const SelectionProbabilities& probabilities,
                                            const RandomBlock& choice,
                                            const RandomBlock& on_light) const {
  // The last entry is larger than the target, so there always is one.
  const double target = choice.uniform_double(0) * probabilities.up_to.back();
  const auto found =
      std::upper_bound(probabilities.up_to.begin(), probabilities.up_to.end(), target) -
      probabilities.up_to.begin();
  const auto index = static_cast<std::uint32_t>(found);
  const Cluster& cluster = clusters_[index];
  if (cluster.first == cluster.last) return {cluster.light, index, none};
  const double before = area_before(cluster);
  const double area_target = before + on_light.uniform_double(0) * area(index);
  const auto triangle = std::upper_bound(
      triangles_.begin() + cluster.first, triangles_.begin() + cluster.last - 1, area_target,
      [](double requested, const Triangle& other) { return requested < other.area_up_to; });
  return {cluster.light, index, triangle->number};
}

}  // namespace photile::trace

namespace photile {

namespace trace {

std::vector<double> light_fractions(const std::vector<Light>& lights, PhotonQuota quota) {
  const double count = static_cast<double>(lights.size());
  double power = 0;
  for (const Light& light : lights) power += light.power;
  // Lights that are all off can still be turned up by relighting.
  if (!(power > 0)) quota = PhotonQuota::equal;
  const double by_power = quota == PhotonQuota::power      ? 1.0
                          : quota == PhotonQuota::balanced ? 0.5
                                                           : 0.0;
  std::vector<double> fraction;
  for (const Light& light : lights)
    fraction.push_back((by_power > 0 ? by_power * (light.power / power) : 0.0) +
                       (1.0 - by_power) / count);
  return fraction;
}

}  // namespace trace

std::string_view name_of(PhotonQuota quota) {
  return name_in({"balanced", "power", "equal"}, quota);
}

namespace {

/// Adds what rounding down left over, one path each, by the largest remainder first.
void give_remainder(std::vector<std::uint64_t>& paths, const std::vector<double>& requested,
                    std::uint64_t remainder) {
  std::vector<std::size_t> order(paths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return requested[a] - std::floor(requested[a]) > requested[b] - std::floor(requested[b]);
  });
  for (std::uint64_t i = 0; i < remainder; ++i) ++paths[order[i % order.size()]];
}

}  // namespace

std::vector<std::uint64_t> photons_per_light(const Scene& scene, std::uint64_t total,
                                             PhotonQuota quota) {
  const std::size_t count = scene.lights.size();
  if (count == 0)
    throw InputError(scene.source.string() +
                     ": the scene has no lights; add a light or an emissive material");
  // Each light is given its first path, and shares decide about the paths beyond it.
  total = std::max<std::uint64_t>(total, count);
  const std::vector<double> fraction = trace::light_fractions(scene.lights, quota);
  std::vector<double> requested(count);
  std::vector<std::uint64_t> paths(count);
  for (std::size_t l = 0; l < count; ++l)
    requested[l] = std::max(0.0, fraction[l] * static_cast<double>(total) - 1.0);
  // What the smallest lights get beyond their fraction is taken from the others in proportion.
  const double beyond = std::accumulate(requested.begin(), requested.end(), 0.0);
  const double available = static_cast<double>(total - count);
  for (std::size_t l = 0; l < count; ++l) {
    if (beyond > 0) requested[l] *= available / beyond;
    paths[l] = 1 + static_cast<std::uint64_t>(requested[l]);
  }
  const std::uint64_t given = std::accumulate(paths.begin(), paths.end(), std::uint64_t{0});
  give_remainder(paths, requested, total - given);
  return paths;
}

}  // namespace photile
