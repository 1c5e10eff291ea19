#include "trace/place_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/box.hpp"
#include "photile/defaults.hpp"
#include "scene/scene_queries.hpp"

namespace photile::trace {

namespace {

using Box = geometry::BoxOf<double>;

constexpr double face_thickness = 0.02;  // of the extent: walls need not be exactly flat
constexpr double closed_coverage = 0.5;

/// Share of each box side that triangles near it cover; index 2 * axis + (1 for the high side).
std::array<double, 6> coverage_of(const Scene& scene, const Box& box) {
  std::array<double, 6> covered{};
  const glm::dvec3 size = box.size();
  for (std::size_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    const std::array<glm::vec3, 3> p = scene.corners(triangle);
    const glm::dvec3 low = glm::min(glm::min(p[0], p[1]), p[2]);
    const glm::dvec3 high = glm::max(glm::max(p[0], p[1]), p[2]);
    const glm::dvec3 area = 0.5 * glm::abs(glm::cross(glm::dvec3(p[1]) - glm::dvec3(p[0]),
                                                      glm::dvec3(p[2]) - glm::dvec3(p[0])));
    for (int axis = 0; axis < 3; ++axis) {
      const double margin = face_thickness * size[axis];
      const auto side = static_cast<std::size_t>(2 * axis);
      if (high[axis] <= box.lower[axis] + margin) covered[side] += area[axis];
      if (low[axis] >= box.upper[axis] - margin) covered[side + 1] += area[axis];
    }
  }
  for (std::size_t side = 0; side < covered.size(); ++side) {
    const int axis = static_cast<int>(side / 2);
    const double area = size[(axis + 1) % 3] * size[(axis + 2) % 3];
    covered[side] = area > 0.0 ? covered[side] / area : 0.0;
  }
  return covered;
}

constexpr glm::dvec3 up(0.0, 1.0, 0.0);
const double field_of_view = glm::radians(defaults::vertical_field_of_view);

double distance_that_frames(double width, double height) {
  constexpr double aspect =
      static_cast<double>(defaults::image_width) / static_cast<double>(defaults::image_height);
  const double half_height = std::max(0.5 * height, 0.5 * width / aspect);
  return half_height / std::tan(0.5 * field_of_view);
}

/// Through the open side `axis`, `sign` (+1 or -1), which fills the picture.
Camera through_side(const Box& box, int axis, double sign) {
  glm::dvec3 outwards(0.0);
  outwards[axis] = sign;
  const glm::dvec3 size = box.size();
  const double distance = distance_that_frames(size[axis == 0 ? 2 : 0], size.y);
  const glm::dvec3 eye = box.centre() + outwards * (0.5 * size[axis] + distance);
  return Camera::look_at(eye, box.centre(), up, field_of_view);
}

/// A lower bound of the distance from `point` to any triangle, by the triangles' bounding boxes.
double free_space(const Scene& scene, const glm::dvec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t triangle = 0; triangle < scene.triangle_count(); ++triangle) {
    const std::array<glm::vec3, 3> p = scene.corners(triangle);
    const glm::dvec3 low = glm::min(glm::min(p[0], p[1]), p[2]);
    const glm::dvec3 high = glm::max(glm::max(p[0], p[1]), p[2]);
    const glm::dvec3 nearest = glm::clamp(point, low, high);
    least = std::min(least, glm::distance(point, nearest));
  }
  return least;
}

Camera inside(const Scene& scene, const Box& box) {
  constexpr double inset = 0.1, eye_height = 0.6, target_height = 0.4;  // of the box
  const auto at = [&](double x, double y, double z) {
    return box.lower + glm::dvec3(x, y, z) * box.size();
  };
  Camera best;
  double most_space = -1.0;
  for (const auto& [x, z] :
       {std::pair(1.0, 1.0), std::pair(0.0, 1.0), std::pair(1.0, 0.0), std::pair(0.0, 0.0)}) {
    const double eye_x = inset + x * (1.0 - 2.0 * inset), eye_z = inset + z * (1.0 - 2.0 * inset);
    const glm::dvec3 eye = at(eye_x, eye_height, eye_z);
    const double space = free_space(scene, eye);
    if (space <= most_space) continue;
    most_space = space;
    best = Camera::look_at(eye, at(1.0 - eye_x, target_height, 1.0 - eye_z), up, field_of_view);
  }
  return best;
}

Camera outside(const Box& box) {
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.4, 0.35, 1.0));
  const double radius = 0.5 * glm::length(box.size());
  const glm::dvec3 eye = box.centre() + direction * (radius / std::sin(0.5 * field_of_view));
  return Camera::look_at(eye, box.centre(), up, field_of_view);
}

}  // namespace

Camera place_camera(const Scene& scene) {
  const geometry::Box bounds = bounds_of(scene);
  const Box box{bounds.lower, bounds.upper};
  const std::array<double, 6> coverage = coverage_of(scene, box);
  const auto closed = std::count_if(coverage.begin(), coverage.end(),
                                    [](double fraction) { return fraction >= closed_coverage; });
  Camera camera = outside(box);
  if (closed == 6) {
    camera = inside(scene, box);
  } else if (closed >= 4) {
    // The front of a model looks along +z, so its viewer's side comes first.
    for (const auto& [axis, sign] :
         {std::pair(2, 1.0), std::pair(2, -1.0), std::pair(0, 1.0), std::pair(0, -1.0)}) {
      if (coverage[static_cast<std::size_t>(2 * axis + (sign > 0.0))] >= closed_coverage) continue;
      camera = through_side(box, axis, sign);
      break;
    }
  }
  camera.name = "default";
  return camera;
}

}  // namespace photile::trace
