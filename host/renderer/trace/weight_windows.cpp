#include "trace/weight_windows.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/sampling.hpp"

namespace photile::trace {

namespace {

/// Photons in a cell with light, on average: of the coarse cells, which are to hold photons where
/// one path in a hundred comes, and of those that have windows.
constexpr double photons_of_coarse_cell = 512, photons_of_cell = 64;
constexpr int most_halvings = 24;  ///< of the scene's radius, to the size of a cell

/// A cell is dim with less than this part of the photons of an average one, and rooms are hidden
/// where more than this part of the cells with light are dim and closed. It is 18% and 34% in the
/// rooms of bench/pictures/hard_rooms.py that few paths find, and 2 to 3% in the bundled rooms, a
/// classroom and a kitchen, which have cupboards and undersides.
constexpr double dim = 1.0 / 32, hidden_part = 0.1;
constexpr int rays_of_photon = 4;  ///< by which a cell turns out to be in the open

/// Deep light is not split for ever: what is behind a few doors may have no photon.
constexpr double least_window = 0x1p-14;

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
        photons_of_coarse_cell * static_cast<double>(cells.size()))
      break;
  }
  const auto count = static_cast<double>(cells.size());
  const double few = dim * static_cast<double>(pilot.size()) / count;
  double hidden = 0;
  for (const auto& [cell, photons] : cells) {
    if (static_cast<double>(photons.size()) >= few) continue;
    hidden += std::all_of(photons.begin(), photons.end(), [&](std::uint32_t i) {
      return sees_surface(pilot[i], i, rays, bounds.radius);
    });
  }
  return hidden > hidden_part * count;
}

WeightWindows::WeightWindows(std::span<const PilotPhoton> pilot, const BoundingSphere& bounds)
    : centre_(bounds.center), per_metre_(1 / bounds.radius) {
  for (int halvings = 0; halvings < most_halvings; ++halvings, per_metre_ *= 2) {
    weight_.clear();
    pilots_ = 0;
    add(pilot);
    if (static_cast<double>(pilot.size()) <= photons_of_cell * static_cast<double>(weight_.size()))
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
  return static_cast<float>(std::clamp(found->second / pilots_ / even_, least_window, 1.0));
}

WeightWindows::Cell WeightWindows::cell_of(const glm::vec3& position,
                                           const glm::vec3& normal) const {
  const glm::ivec3 cell = cell_at(position, centre_, per_metre_);
  const glm::vec3 steep = glm::abs(normal);
  const int axis = steep.x > steep.y ? (steep.x > steep.z ? 0 : 2) : (steep.y > steep.z ? 1 : 2);
  return {cell.x, cell.y, cell.z, 2 * axis + (normal[axis] > 0 ? 1 : 0)};
}

}  // namespace photile::trace
