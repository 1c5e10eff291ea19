#include "daylight/surface_cells.hpp"

#include <algorithm>
#include <cmath>

#include "trace/ray_query.hpp"

namespace photile::daylight {
namespace {

constexpr int most_levels = 16;
constexpr int most_beside = 16;           ///< cells of one cube: leaves of a tree hide each other
constexpr double sight_above = 1.0 / 32;  ///< of the cell's size, of lines of sight
/// An offset at which planes of buildings seldom lie.
constexpr double cube_offset = 0.3819660113;

std::uint64_t mixed(std::uint64_t x) {  // splitmix64 (Steele, Lea and Flood 2014)
  x = (x ^ x >> 30) * 0xBF58'476D'1CE4'E5B9u;
  x = (x ^ x >> 27) * 0x94D0'49BB'1331'11EBu;
  return x ^ x >> 31;
}

/// One of 54 ranges of normals; those along an axis are in the middle of one.
std::uint64_t normal_range(const glm::vec3& normal) {
  const glm::vec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto third = [](float x) { return x < -0.33f ? 0u : x > 0.33f ? 2u : 1u; };
  return static_cast<std::uint64_t>(axis) * 18 + (normal[axis] < 0.0f ? 9 : 0) +
         third(normal[(axis + 1) % 3]) * 3 + third(normal[(axis + 2) % 3]);
}

std::uint64_t key_of(const glm::dvec3& position, double cube, int level, std::uint64_t range) {
  std::uint64_t key = mixed(static_cast<std::uint64_t>(level) << 8 | range);
  for (int axis = 0; axis < 3; ++axis) {
    const auto place = static_cast<std::int64_t>(std::floor(position[axis] / cube + cube_offset));
    key = mixed(key + 0x9E37'79B9'7F4A'7C15u + static_cast<std::uint64_t>(place));
  }
  return key;
}

}  // namespace

SurfaceCells::SurfaceCells(const RayScene& rays, double size, double near)
    : rays_(rays), size_(size), near_(near) {}

std::uint32_t SurfaceCells::find(std::uint64_t cube, const trace::SurfacePoint& point,
                                 double cell_size) {
  const glm::vec3 sight =
      point.position +
      std::max(2 * point.ray_offset, static_cast<float>(sight_above * cell_size)) * point.normal;
  const auto [entry, fresh] = in_cube_.try_emplace(cube, static_cast<std::uint32_t>(cells_.size()));
  std::uint32_t last = none;
  int tried = 0;
  for (std::uint32_t cell = fresh ? none : entry->second; cell != none;
       cell = cells_[cell].beside) {
    if (++tried > most_beside || !trace::occluded(rays_, sight, cells_[cell].sight)) return cell;
    last = cell;
  }
  const auto made = static_cast<std::uint32_t>(cells_.size());
  if (last != none) cells_[last].beside = made;
  cells_.push_back({sight, none, 0, {}});
  return made;
}

std::uint32_t SurfaceCells::cell_of(const trace::SurfacePoint& point, float length) {
  const trace::FlushDenormals flush_denormals;
  const double farther = std::log2(std::max(1.0, double{length} / near_));
  const int level = std::min(static_cast<int>(farther), most_levels);
  const double cube = std::ldexp(size_, level);
  const std::uint32_t number = find(
      key_of(glm::dvec3(point.position), cube, level, normal_range(point.normal)), point, cube);
  Cell& cell = cells_[number];
  const std::uint64_t before = cell.ends++;
  if (cell.places.size() < most_places) {
    cell.places.push_back(point);
  } else {  // reservoir sampling: Vitter's algorithm R
    const std::uint64_t at = mixed(before * 0x9E37'79B9'7F4A'7C15u + number) % (before + 1);
    if (at < most_places) cell.places[at] = point;
  }
  return number;
}

}  // namespace photile::daylight
