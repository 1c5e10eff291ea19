#include "loading/up_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geometry/box.hpp"
#include "photile/errors.hpp"

namespace photile::loading {
namespace {

constexpr double least_cosine = 0.985;  ///< of what faces along an axis: 10 degrees
constexpr double level = 0.02;          ///< metres: what lies so near to each other is one plane
constexpr double least_height = 2;      ///< metres, of a room
constexpr double small_model = 3;       ///< metres: what is smaller is no room
constexpr double least_share = 0.5;     ///< of the width, the height of a small model
constexpr double least_evidence = 2;

/// Surface that faces along an axis, either way.
struct Facing {
  double area = 0;                        ///< m2
  std::map<std::int64_t, double> planes;  ///< m2 by place along the axis

  double widest() const {
    double most = 0;
    for (const auto& [place, area_there] : planes) most = std::max(most, area_there);
    return most;
  }
};

/// Along x, y and z.
std::array<Facing, 3> facings_of(const Scene& scene) {
  std::array<Facing, 3> facings;
  for (std::size_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    const std::array<glm::vec3, 3> p = scene.corners(triangle);
    const glm::dvec3 a(p[0]), doubled = glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
    const double length = glm::length(doubled);
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(doubled[axis]) >= least_cosine * length)) continue;
      Facing& facing = facings[static_cast<std::size_t>(axis)];
      facing.area += 0.5 * length;
      facing.planes[std::llround(a[axis] / level)] += 0.5 * length;
    }
  }
  return facings;
}

bool may_be_height(double z, const glm::dvec3& size) {
  const double largest = std::max({size.x, size.y, size.z});
  if (z > size.y) return false;
  return largest < small_model ? z >= least_share * largest : z >= least_height;
}

}  // namespace

glm::dmat3 turn_upright(const std::string& up) {
  const std::string word = up.empty() ? "y" : up;
  const bool down = word.front() == '-';
  const std::string axis = down ? word.substr(1) : word;
  if (axis != "x" && axis != "y" && axis != "z") {
    throw UsageError(fmt::format("up '{}': is no axis; give x, y, z, -x, -y or -z", up));
  }
  glm::dvec3 upwards(0.0);
  upwards[axis.front() - 'x'] = down ? -1.0 : 1.0;
  const glm::dvec3 right = axis == "x" ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  return glm::transpose(glm::dmat3(right, upwards, glm::cross(right, upwards)));
}

void warn_of_other_up(const Scene& scene, files::Warnings& warnings) {
  geometry::BoxOf<double> box;
  for (const glm::vec3& vertex : scene.vertices) box.extend(glm::dvec3(vertex));
  const glm::dvec3 size = box.size();
  if (!may_be_height(size.z, size)) return;
  const auto [x, y, z] = facings_of(scene);
  const double by_area = z.area / y.area, by_plane = z.widest() / y.widest();
  if (!(by_area >= 1 && by_plane >= 1 && by_area * by_plane >= least_evidence)) return;
  warnings.add(
      fmt::format("z seems to point up: {:.3g} m2 face along z, {:.3g} along y, which is taken for "
                  "up; --set up=z turns the scene, --set up=y leaves this line out",
                  z.area, y.area));
}

}  // namespace photile::loading
