#include "trace/weight_windows.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "photile/defaults.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {

namespace {

constexpr int most_halvings = 24;  ///< of the scene's radius, to the size of a cell

constexpr int rays_of_photon = 4;  ///< by which a cell turns out to be in the open

glm::ivec3 cell_at(const glm::vec3& position, const glm::dvec3& centre, double per_metre) {
  return glm::ivec3(glm::floor((glm::dvec3(position) - centre) * per_metre));
}

bool sees_surface(const PilotPhoton& photon, std::uint32_t number, const RayScene::Impl& rays,
                  double radius) {
  const RandomStream random(0, number, 0);
  const glm::vec3 origin =
      photon.position + static_cast<float>(radius * ray_offset_per_coordinate * 8) * photon.normal;
  for (std::uint32_t ray = 0; ray < rays_of_photon; ++ray) {
    const RandomBlock numbers = random.block(Purpose::photon_window, ray);
    const glm::vec3 direction =
        Frame(photon.normal)
            .to_world(sample_cosine_hemisphere(numbers.uniform(0), numbers.uniform(1)));
    if (!rays.intersect(origin, direction)) return false;
  }
  return true;
}

}  // namespace

bool hides_light(std::span<const PilotPhoton> pilot, const RayScene::Impl& rays,
                 const BoundingSphere& bounds) {
  tsl::robin_map<glm::ivec3, std::vector<std::uint32_t>, BytesHash> cells;
  double per_metre = 1 / bounds.radius;
  for (int halvings = 0; halvings < most_halvings; ++halvings, per_metre *= 2) {
    cells.clear();
    for (std::uint32_t i = 0; i < pilot.size(); ++i)
      cells[cell_at(pilot[i].position, bounds.center, per_metre)].push_back(i);
    if (static_cast<double>(pilot.size()) <=
        defaults::pilot_photons_of_coarse_cell * static_cast<double>(cells.size()))
      break;
  }
  const auto count = static_cast<double>(cells.size());
  const double few = defaults::dim_part * static_cast<double>(pilot.size()) / count;
  double hidden = 0;
  for (const auto& [cell, photons] : cells) {
    if (static_cast<double>(photons.size()) >= few) continue;
    hidden += std::all_of(photons.begin(), photons.end(), [&](std::uint32_t i) {
      return sees_surface(pilot[i], i, rays, bounds.radius);
    });
  }
  return hidden > defaults::hidden_part * count;
}

WeightWindows::WeightWindows(std::span<const PilotPhoton> pilot, const BoundingSphere& bounds)
    : centre_(bounds.center), per_metre_(1 / bounds.radius) {
  for (int halvings = 0; halvings < most_halvings; ++halvings, per_metre_ *= 2) {
    weight_.clear();
    pilots_ = 0;
    add(pilot);
    if (static_cast<double>(pilot.size()) <=
        defaults::pilot_photons_of_cell * static_cast<double>(weight_.size()))
      break;
  }
}

void WeightWindows::add(std::span<const PilotPhoton> pilot) {
  ++pilots_;
  for (const PilotPhoton& photon : pilot)
    weight_[cell_of(photon.position, photon.normal)] += double{photon.weight};
  double all = 0;
  for (const auto& [cell, weight] : weight_) all += weight;
  even_ = all / pilots_ / static_cast<double>(weight_.size());
}

std::optional<float> WeightWindows::at(const glm::vec3& position, const glm::vec3& normal) const {
  const auto found = weight_.find(cell_of(position, normal));
  if (found == weight_.end()) return std::nullopt;
  return static_cast<float>(
      std::clamp(found->second / pilots_ / even_, defaults::least_window, 1.0));
}

WeightWindows::Cell WeightWindows::cell_of(const glm::vec3& position,
                                           const glm::vec3& normal) const {
  const glm::ivec3 cell = cell_at(position, centre_, per_metre_);
  const glm::vec3 steep = glm::abs(normal);
  const int axis = steep.x > steep.y ? (steep.x > steep.z ? 0 : 2) : (steep.y > steep.z ? 1 : 2);
  return {cell.x, cell.y, cell.z, 2 * axis + (normal[axis] > 0 ? 1 : 0)};
}

}  // namespace photile::trace
