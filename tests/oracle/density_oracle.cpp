#include "oracle/density_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <utility>

#include "oracle/kernel_weights.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::reference {
namespace {

/// Leaves the photons whose flux counts.
void leave_out_last(OracleNeighbours& near, int k) {
  if (k == 1 || near.photons.size() < static_cast<std::size_t>(k)) return;
  near.photons.pop_back();
  near.squared_distance.pop_back();
}

double diagonal_of(const Scene& scene) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const glm::vec3& vertex : scene.vertices) {
    low = glm::min(low, glm::dvec3(vertex));
    high = glm::max(high, glm::dvec3(vertex));
  }
  return glm::length(high - low);
}

/// A disc is never counted smaller than a hundred-thousandth of the radius, or of the scene where
/// that is smaller (kernels/estimate/area.clh).
double squared_disc(const OracleNeighbours& near, double radius, double diagonal) {
  const double least = 1e-5 * std::min(radius, diagonal);
  return std::max(near.squared_radius, least * least);
}

}  // namespace

DensityOracle::DensityOracle(const Scene& scene, const Photons& photons, PhotonFilter filter,
                             double angle_degrees)
    : photons_(photons),
      filter_(filter),
      cos_angle_(std::cos(glm::radians(angle_degrees))),
      light_count_(needs_of(scene).light_count),
      diagonal_(diagonal_of(scene)) {
  normals_.reserve(2 * scene.triangle_count());
  for (std::uint32_t map = 0; map < 2 * scene.triangle_count(); ++map) {
    normals_.push_back(face_normal(scene, map));
  }
}

DensityOracle::DensityOracle(std::vector<glm::dvec3> normals, double size, const Photons& photons,
                             double angle_degrees)
    : photons_(photons),
      filter_(PhotonFilter::grouped),
      cos_angle_(std::cos(glm::radians(angle_degrees))),
      light_count_(1),
      diagonal_(size),
      normals_(std::move(normals)) {}

bool DensityOracle::counts(std::uint32_t photon_map, std::uint32_t hit_map) const {
  if (filter_ == PhotonFilter::naive) return photon_map == hit_map;
  return photon_map == hit_map ||
         normals_agree(normals_[photon_map], normals_[hit_map], cos_angle_);
}

OracleNeighbours DensityOracle::nearest(const glm::dvec3& hit, std::uint32_t oriented_face, int k,
                                        double radius) const {
  std::vector<std::pair<double, std::uint32_t>> candidates;
  for (std::uint32_t i = 0; i < photons_.size(); ++i) {
    if (!counts(photons_.oriented_face[i], oriented_face)) continue;
    const glm::dvec3 offset = glm::dvec3(photons_.position[i]) - hit;
    const double squared_distance = glm::dot(offset, offset);
    if (squared_distance <= radius * radius) candidates.emplace_back(squared_distance, i);
  }
  std::sort(candidates.begin(), candidates.end());
  OracleNeighbours result;
  result.squared_radius = radius * radius;
  const auto requested = static_cast<std::size_t>(k);
  if (candidates.size() >= requested) {
    candidates.resize(requested);
    result.squared_radius = candidates.back().first;
  }
  for (const auto& [squared_distance, photon] : candidates) {
    result.photons.push_back(photon);
    result.squared_distance.push_back(squared_distance);
  }
  return result;
}

std::vector<glm::dvec3> DensityOracle::irradiance(const glm::dvec3& hit,
                                                  std::uint32_t oriented_face, int k, double radius,
                                                  DensityKernel kernel) const {
  if (k == 1) kernel = DensityKernel::constant;
  OracleNeighbours near = nearest(hit, oriented_face, k, radius);
  leave_out_last(near, k);
  const double squared = squared_disc(near, radius, diagonal_);
  return sums(near, std::sqrt(squared), kernel, glm::pi<double>() * squared * mean_weight(kernel));
}

std::vector<glm::dvec3> DensityOracle::irradiance(const ClippedArea& surface, const glm::dvec3& hit,
                                                  std::uint32_t oriented_face, int k, double radius,
                                                  DensityKernel kernel) const {
  if (k == 1) kernel = DensityKernel::constant;
  OracleNeighbours near = nearest(hit, oriented_face, k, radius);
  leave_out_last(near, k);
  const double disc = std::sqrt(squared_disc(near, radius, diagonal_));
  OracleNeighbours in_slab;
  for (std::size_t i = 0; i < near.photons.size(); ++i) {
    const glm::dvec3 offset = glm::dvec3(photons_.position[near.photons[i]]) - hit;
    if (std::abs(glm::dot(offset, normals_[oriented_face])) > ClippedArea::slab * disc) continue;
    in_slab.photons.push_back(near.photons[i]);
    in_slab.squared_distance.push_back(near.squared_distance[i]);
  }
  return sums(in_slab, disc, kernel, surface.area(hit, oriented_face, disc, kernel));
}

std::vector<glm::dvec3> DensityOracle::sums(const OracleNeighbours& near, double radius,
                                            DensityKernel kernel, double area) const {
  std::vector<glm::dvec3> result(light_count_, glm::dvec3(0.0));
  for (std::size_t i = 0; i < near.photons.size(); ++i) {
    const std::uint32_t photon = near.photons[i];
    const std::size_t light = photons_.light.empty() ? 0 : photons_.light[photon];
    const double weight = weight_at(kernel, std::sqrt(near.squared_distance[i]) / radius);
    result[light] += glm::dvec3(photons_.flux[photon]) * (weight / area);
  }
  return result;
}

}  // namespace photile::reference
