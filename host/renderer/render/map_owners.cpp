#include "render/map_owners.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "geometry/box.hpp"
#include "geometry/radix_sort.hpp"
#include "maps/candidate_maps.hpp"

namespace photile {
namespace {

constexpr int bits_of_axis = 21;

/// Pairs along the curve.
std::vector<std::uint32_t> along_curve(std::span<const geometry::Box> boxes) {
  geometry::Box bounds;
  for (const geometry::Box& box : boxes) bounds.extend(box);
  const glm::vec3 extent = glm::max(bounds.size(), glm::vec3(std::numeric_limits<float>::min()));
  std::vector<std::uint64_t> code;
  for (const geometry::Box& box : boxes) {
    const glm::dvec3 place =
        glm::clamp(glm::dvec3((box.centre() - bounds.lower) / extent), 0.0, 1.0);
    code.push_back(geometry::morton_code(glm::uvec3(place * double{(1 << bits_of_axis) - 1})));
  }
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
  return order;
}

}  // namespace

MapOwners::MapOwners(const Scene& scene, const Patches& patches,
                     std::span<const std::uint32_t> landed, std::uint32_t processes) {
  const std::vector<geometry::Box> boxes = maps::map_boxes(scene, patches);
  std::vector<std::uint64_t> photons(boxes.size(), 0);
  for (std::uint32_t s = 0; s < landed.size(); ++s) photons[patches.map(s) / 2] += landed[s];
  const std::uint64_t all = std::accumulate(photons.begin(), photons.end(), std::uint64_t{0});
  of_pair_.resize(boxes.size(), 0);
  std::uint64_t before = 0;
  for (const std::uint32_t pair : along_curve(boxes)) {
    // Whose share the middle of the pair's photons is.
    const double middle = static_cast<double>(before) + 0.5 * static_cast<double>(photons[pair]);
    if (all > 0) {
      of_pair_[pair] = std::min(
          processes - 1, static_cast<std::uint32_t>(middle / static_cast<double>(all) * processes));
    }
    before += photons[pair];
  }
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    of_triangle_.push_back(of_pair_[patches.map(sided(t, 0)) / 2]);
  }
}

std::vector<std::uint8_t> MapOwners::maps_of(std::uint32_t rank) const {
  std::vector<std::uint8_t> maps(2 * of_pair_.size());
  for (std::size_t map = 0; map < maps.size(); ++map) maps[map] = of_pair_[map / 2] == rank ? 1 : 0;
  return maps;
}

std::vector<std::uint8_t> MapOwners::triangles_of(std::uint32_t rank) const {
  std::vector<std::uint8_t> triangles(2 * of_triangle_.size());
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    triangles[s] = of_triangle_[s / 2] == rank ? 1 : 0;
  }
  return triangles;
}

}  // namespace photile
