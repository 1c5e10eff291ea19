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

constexpr int rays_of_photon = 4;  ///< by which a cell turns out to be in the open

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
  const auto cube_of = [&](const SurfaceCells& cells, std::size_t i) {
    return cells.of(pilot[i].position);
  };
  const SurfaceCells grid(bounds, pilot.size(), defaults::pilot_photons_of_coarse_cell, cube_of);
  tsl::robin_map<SurfaceCells::Cube, std::vector<std::uint32_t>, BytesHash> cells;
  for (std::uint32_t i = 0; i < pilot.size(); ++i) cells[cube_of(grid, i)].push_back(i);
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
    : cells_(bounds, pilot.size(), defaults::pilot_photons_of_cell,
             [&](const SurfaceCells& cells, std::size_t i) {
               return cells.of(pilot[i].position, pilot[i].normal);
             }) {
  add(pilot);
}

void WeightWindows::add(std::span<const PilotPhoton> pilot) {
  ++pilots_;
  for (const PilotPhoton& photon : pilot)
    weight_[cells_.of(photon.position, photon.normal)] += double{photon.weight};
  double all = 0;
  for (const auto& [cell, weight] : weight_) all += weight;
  even_ = all / pilots_ / static_cast<double>(weight_.size());
}

std::optional<float> WeightWindows::at(const glm::vec3& position, const glm::vec3& normal) const {
  const auto found = weight_.find(cells_.of(position, normal));
  if (found == weight_.end()) return std::nullopt;
  return static_cast<float>(
      std::clamp(found->second / pilots_ / even_, defaults::least_window, 1.0));
}

}  // namespace photile::trace
