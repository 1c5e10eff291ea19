#include "trace/bright_surface.hpp"

#include <tsl/robin_map.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/content_hash.hpp"
#include "photile/defaults.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile::trace {
namespace {

/// Surface within a cube that faces one way along an axis.
struct Cell {
  double reflected = 0;  ///< luminous flux
  /// Sums of positions, relative to the middle of the scene, and of their squares, by this flux.
  glm::dvec3 position{0.0};
  double square = 0;

  glm::dvec3 centre() const { return position / reflected; }
  /// Root mean square of the distance to the centre.
  double extent() const {
    return std::sqrt(std::max(0.0, square / reflected - glm::dot(centre(), centre())));
  }
};

/// The border of a square, in its own `extent`.
const double border_of_square = std::sqrt(3.0);

using CellIndex = std::array<std::int32_t, 4>;

std::vector<Cell> cells_of(const Scene& scene, const Photons& photons,
                           std::span<const double> layer_powers, const glm::dvec3& centre,
                           double cells_per_metre) {
  tsl::robin_map<CellIndex, std::size_t, BytesHash> cell_at;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const glm::dvec3 position = glm::dvec3(photons.position[i]) - centre;
    const std::uint32_t face = photons.oriented_face[i];
    const Material& material = scene.materials[scene.triangle_material[triangle_of(face)]];
    const glm::dvec3 normal = face_normal(scene, face), steep = glm::abs(normal);
    const int axis = steep.x > steep.y ? (steep.x > steep.z ? 0 : 2) : (steep.y > steep.z ? 1 : 2);
    const glm::ivec3 cube(glm::floor(position * cells_per_metre));
    const CellIndex index{cube.x, cube.y, cube.z, 2 * axis + (normal[axis] > 0 ? 1 : 0)};
    const auto [entry, is_new] = cell_at.insert({index, cells.size()});
    if (is_new) cells.emplace_back();
    Cell& cell = cells[entry->second];
    const double power = layer_powers[photons.light.empty() ? 0 : photons.light[i]];
    const double reflected = power * luminance(glm::dvec3(photons.flux[i]) *
                                               glm::dvec3(material.diffuse + material.specular));
    cell.reflected += reflected;
    cell.position += reflected * position;
    cell.square += reflected * glm::dot(position, position);
  }
  return cells;
}

}  // namespace

Targets bright_surface(const RayScene& rays, std::span<const double> layer_powers,
                       std::uint64_t seed) {
  const Scene& scene = rays.scene();
  const Photons photons = trace_photons(rays, {.emitted_photons = defaults::pilot_paths,
                                               .quota = PhotonQuota::power,
                                               .seed = seed})
                              .photons;
  const auto [centre, radius] = bounding_sphere(scene);
  std::vector<Cell> cells;
  for (double per_metre = 1 / radius; per_metre * radius < 0x1p20; per_metre *= 2) {
    cells = cells_of(scene, photons, layer_powers, centre, per_metre);
    if (static_cast<double>(photons.size()) <=
        defaults::pilot_photons_of_cell * static_cast<double>(cells.size()))
      break;
  }
  std::stable_sort(cells.begin(), cells.end(),
                   [](const Cell& a, const Cell& b) { return a.reflected > b.reflected; });
  const auto brightest = static_cast<std::size_t>(
      std::ceil(defaults::bright_part * static_cast<double>(cells.size())));
  double all = 0, bright = 0;
  std::vector<Targets::Sphere> spheres;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& cell = cells[i];
    all += cell.reflected;
    if (i >= brightest || !(cell.reflected > 0)) continue;
    bright += cell.reflected;
    if (i >= Targets::most_spheres) continue;
    const double around = border_of_square * cell.extent() + 1e-3 * radius;
    spheres.push_back({centre + cell.centre(), around, cell.reflected / (around * around)});
  }
  return Targets(bright > defaults::bright_light * all ? std::move(spheres)
                                                       : std::vector<Targets::Sphere>());
}

}  // namespace photile::trace
