#include "maps/photon_crowding.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <span>

namespace photile::maps {
namespace {

constexpr std::uint32_t photons_per_bin = 16;
constexpr int most_halvings = 6;  ///< of each side of a triangle: 4096 bins

/// A triangle's sides are halved so often that its bins hold photons_per_bin on average.
int halvings_for(std::uint32_t photons) {
  return std::clamp((static_cast<int>(std::bit_width(photons / photons_per_bin)) - 1) / 2, 0,
                    most_halvings);
}

/// The bin of a point among the 4^halvings congruent parts of a triangle: squares of the
/// barycentric coordinates, each cut in two.
std::size_t bin_of(const glm::vec3& point, const std::array<glm::vec3, 3>& corners, int halvings) {
  const glm::dvec3 a(corners[0]), u = glm::dvec3(corners[1]) - a, v = glm::dvec3(corners[2]) - a;
  const glm::dvec3 p = glm::dvec3(point) - a;
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v);
  const double pu = glm::dot(p, u), pv = glm::dot(p, v);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 0)) return 0;
  const int side = 1 << halvings;
  const double s = (vv * pu - uv * pv) / determinant * side;
  const double t = (uu * pv - uv * pu) / determinant * side;
  const int i = std::clamp(static_cast<int>(s), 0, side - 1);
  const int j = std::clamp(static_cast<int>(t), 0, side - 1);
  const bool upper = (s - i) + (t - j) > 1;
  return (static_cast<std::size_t>(i) * static_cast<std::size_t>(side) +
          static_cast<std::size_t>(j)) *
             2 +
         (upper ? 1 : 0);
}

/// The integral of the squared density over a triangle, photons squared per square metre.
double squared_density(const std::array<glm::vec3, 3>& corners, double area,
                       std::span<const glm::vec3> positions) {
  if (!(area > 0)) return 0;
  const int halvings = halvings_for(static_cast<std::uint32_t>(positions.size()));
  std::vector<std::uint32_t> counts(std::size_t{2} << (2 * halvings), 0);
  for (const glm::vec3& position : positions) ++counts[bin_of(position, corners, halvings)];
  double pairs = 0;
  for (const double count : counts) pairs += count * (count - 1);
  return pairs * static_cast<double>(1u << (2 * halvings)) / area;
}

}  // namespace

std::vector<float> photon_crowding(const Scene& scene, const Photons& photons,
                                   const Patches& patches) {
  const std::size_t sided_count = 2 * scene.triangle_count();
  std::vector<double> squared(sided_count, 0);
  tbb::parallel_for(std::size_t{0}, sided_count, [&](std::size_t s) {
    const std::uint32_t first = photons.first_of[s], count = photons.first_of[s + 1] - first;
    if (count < 2) return;
    const auto triangle = static_cast<std::uint32_t>(s / 2);
    squared[s] = squared_density(scene.corners(triangle), triangle_area(scene, triangle),
                                 {photons.position.data() + first, count});
  });

  struct Sums {
    double area = 0, photons = 0, squared = 0;
  };
  std::vector<Sums> sums(patches.empty() ? sided_count : 2 * patches.count());
  for (std::uint32_t s = 0; s < sided_count; ++s) {
    Sums& sum = sums[patches.map(s)];
    sum.area += triangle_area(scene, triangle_of(s));
    sum.photons += photons.first_of[s + 1] - photons.first_of[s];
    sum.squared += squared[s];
  }
  std::vector<float> crowding(sums.size(), 1.0f);
  for (std::size_t map = 0; map < sums.size(); ++map) {
    const auto& [area, count, integral] = sums[map];
    if (count > 0) {
      crowding[map] = static_cast<float>(std::max(1.0, integral * area / (count * count)));
    }
  }
  return crowding;
}

}  // namespace photile::maps
