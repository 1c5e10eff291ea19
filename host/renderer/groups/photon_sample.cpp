#include "groups/photon_sample.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace photile::groups {
namespace {

constexpr std::uint64_t sample_size = 32'768;

double gap(double coordinate, double low, double high) {
  return std::max({low - coordinate, coordinate - high, 0.0});
}

}  // namespace

std::uint64_t sample_step(std::uint64_t photons) {
  return std::max<std::uint64_t>(1, photons / sample_size);
}

bool is_within(const PatchShape& shape, const glm::dvec3& point, double radius) {
  const double u = gap(glm::dot(point, shape.u_axis), shape.low.x, shape.high.x);
  const double v = gap(glm::dot(point, shape.v_axis), shape.low.y, shape.high.y);
  const double h = gap(glm::dot(point, shape.axis), shape.low.z, shape.high.z);
  return u * u + v * v + h * h <= radius * radius;
}

PhotonSample::PhotonSample(std::span<const PatchShape> shapes, const NeighbourGroups& groups,
                           const Photons& photons) {
  std::vector<std::uint32_t> triangles;
  if (photons.of_all) {
    position_.assign(photons.of_all->sample.begin(), photons.of_all->sample.end());
    triangles = photons.of_all->sample_triangle;
  } else {
    const std::size_t step = sample_step(photons.size());
    for (std::size_t i = step / 2; i < photons.size(); i += step) {
      position_.emplace_back(photons.position[i]);
      triangles.push_back(photons.sided_triangle[i]);
    }
  }
  std::vector<std::vector<std::uint32_t>> maps(position_.size());
  tbb::parallel_for(std::size_t{0}, position_.size(), [&](std::size_t i) {
    for (const std::uint32_t map : groups.of(triangles[i])) {
      if (is_within(shapes[map / 2], position_[i], groups.radius)) maps[i].push_back(map);
    }
  });
  for (const std::vector<std::uint32_t>& entered : maps) {
    maps_.insert(maps_.end(), entered.begin(), entered.end());
    first_of_.push_back(static_cast<std::uint32_t>(maps_.size()));
  }
}

void PhotonSample::rename(const PatchUnion& patches) { rename_maps(first_of_, maps_, patches); }

HeldPhotons::HeldPhotons(const PhotonSample& sample, std::size_t map_count)
    : first_of_(map_count + 1, 0) {
  for (std::size_t photon = 0; photon < sample.size(); ++photon) {
    for (const std::uint32_t map : sample.maps_of(photon)) ++first_of_[map + 1];
  }
  std::partial_sum(first_of_.begin(), first_of_.end(), first_of_.begin());
  photons_.resize(first_of_.back());
  std::vector<std::uint32_t> next(first_of_.begin(), first_of_.end() - 1);
  for (std::uint32_t photon = 0; photon < sample.size(); ++photon) {
    for (const std::uint32_t map : sample.maps_of(photon)) photons_[next[map]++] = photon;
  }
}

}  // namespace photile::groups
