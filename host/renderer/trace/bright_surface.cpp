#include "trace/bright_surface.hpp"

#include <tsl/robin_map.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"
#include "trace/photon_tracer.hpp"
#include "trace/surface_cells.hpp"

namespace photile::trace {
namespace {

/// The light that surface reflects in a cell.
struct Cell {
  double reflected = 0;  ///< luminous flux
  /// Sums of positions, relative to the middle of the scene, and of their squares, by this flux.
  glm::dvec3 position{0.0};
  double square = 0;

  void add(double flux, const glm::dvec3& at) {
    reflected += flux;
    position += flux * at;
    square += flux * glm::dot(at, at);
  }
  glm::dvec3 centre() const { return position / reflected; }
  /// Root mean square of the distance to the centre.
  double extent() const {
    return std::sqrt(std::max(0.0, square / reflected - glm::dot(centre(), centre())));
  }
};

/// The border of a square, in its own `extent`.
const double border_of_square = std::sqrt(3.0);

/// The cells, in the order in which photons are in them.
std::vector<Cell> cells_of(const Scene& scene, const Photons& photons,
                           std::span<const double> layer_powers) {
  const BoundingSphere bounds = bounding_sphere(scene);
  const auto index_of = [&](const SurfaceCells& cells, std::size_t i) {
    return cells.of(photons.position[i], glm::vec3(face_normal(scene, photons.oriented_face[i])));
  };
  const SurfaceCells grid(bounds, photons.size(), defaults::pilot_photons_of_cell, index_of);
  tsl::robin_map<SurfaceCells::Facing, std::size_t, BytesHash> cell_at;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const auto [entry, is_new] = cell_at.insert({index_of(grid, i), cells.size()});
    if (is_new) cells.emplace_back();
    const Material& material =
        scene.materials[scene.triangle_material[triangle_of(photons.oriented_face[i])]];
    const double power = layer_powers[photons.light.empty() ? 0 : photons.light[i]];
    cells[entry->second].add(power * luminance(glm::dvec3(photons.flux[i]) *
                                               glm::dvec3(material.diffuse + material.specular)),
                             glm::dvec3(photons.position[i]) - bounds.center);
  }
  return cells;
}

}  // namespace

Targets bright_surface(const RayScene& rays, std::span<const double> layer_powers,
                       std::uint64_t seed) {
  const Scene& scene = rays.scene();
  const Photons photons =
      trace_photons_beside_hot_spots(
          rays,
          {.emitted_photons = defaults::pilot_paths, .quota = PhotonQuota::power, .seed = seed})
          .photons;
  const auto [centre, radius] = bounding_sphere(scene);
  std::vector<Cell> cells = cells_of(scene, photons, layer_powers);
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
    const double around = border_of_square * cell.extent() + 1e-3 * radius;
    spheres.push_back({centre + cell.centre(), around, cell.reflected / (around * around)});
  }
  return Targets(bright > defaults::bright_light * all ? std::move(spheres)
                                                       : std::vector<Targets::Sphere>());
}

}  // namespace photile::trace
