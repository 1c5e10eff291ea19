#include "trace/place_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/box.hpp"
#include "photile/defaults.hpp"
#include "scene/panes.hpp"
#include "scene/scene_queries.hpp"
#include "trace/ray_query.hpp"
#include "trace/room.hpp"

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
constexpr double aspect =
    static_cast<double>(defaults::image_width) / static_cast<double>(defaults::image_height);
const double field_of_view = glm::radians(defaults::vertical_field_of_view);

double distance_that_frames(double width, double height) {
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

/// A position to stand at, and how far one sees from there over the level.
struct View {
  static constexpr int directions = 64;
  static constexpr double eye_height = 1.6, eye_fraction = 0.6;  // metres, or of a low room

  /// At eye height between a floor and a ceiling, y in metres.
  View(const glm::dvec3& position, double floor, double ceiling)
      : eye(position), floor(floor), ceiling(ceiling) {
    eye.y = floor + std::min(eye_height, eye_fraction * (ceiling - floor));
  }

  static glm::dvec3 direction(int i) {
    const double angle = glm::two_pi<double>() * i / directions;
    return {std::sin(angle), 0.0, std::cos(angle)};
  }
  double along(int i) const {
    return distance[static_cast<std::size_t>((i + directions) % directions)];
  }
  /// A sum over the products of opposite distances: that of the area around the middle of a room,
  /// and less elsewhere in it.
  double openness() const {
    double sum = 0;
    for (int i = 0; i < directions; ++i) sum += along(i) * along(i + directions / 2);
    return sum;
  }
  double enclosed() const {
    const auto open = std::count(distance.begin(), distance.end(), 0.0);
    return 1.0 - static_cast<double>(open) / directions;
  }

  glm::dvec3 eye;
  double floor, ceiling;
  /// Metres; 0 where nothing of a room is met.
  std::array<double, directions> distance{};
};

/// Looks for the largest room of a scene.
class RoomSearch {
 public:
  /// `any` counts sides of surfaces that the file calls the back, as in rooms whose walls are
  /// sheets that face outwards, and rooms of any height. Without it the inside of a solid is none.
  RoomSearch(const RayScene& rays, const Box& box, bool any) : rays_(&rays), box_(box), any_(any) {}

  /// From the middle of the largest room, or nothing.
  std::optional<View> largest() const {
    constexpr double positions = 1024, least_room = 1.9;  // metres
    const glm::dvec3 size = box_.size();
    const double least = std::min(least_room, 0.5 * size.y);
    const double cell = std::sqrt(size.x * size.z / positions);
    const glm::dvec2 counts =
        glm::clamp(glm::ceil(glm::dvec2(size.x, size.z) / cell), 1.0, positions);
    std::optional<View> best;
    for (double z = 0.5; z < counts.y; ++z) {
      for (double x = 0.5; x < counts.x; ++x) {
        const glm::dvec3 position = box_.lower + glm::dvec3(x / counts.x, 0, z / counts.y) * size;
        double ceiling = std::numeric_limits<double>::infinity();
        for (const double level : levels_below(position)) {
          const double height = std::exchange(ceiling, level) - level;
          if (!(height >= least) || (!any_ && height > Room::most_height)) continue;
          const View view = seen(View(position, level, level + height));
          if (!best || view.openness() > best->openness()) best = view;
        }
      }
    }
    if (!best || !(best->openness() > 0)) return std::nullopt;
    return seen(View(best->eye, floor_around(*best), best->ceiling));
  }

  /// Before the end of the room from which most of it is in the picture.
  Camera into_room(const View& middle) const {
    constexpr double back = 0.8;   // of the way to what is behind
    constexpr int about = 3;       // directions beside it: what is behind a door is another room
    constexpr double lower = 0.3;  // metres for each of eye height that the picture's middle is
    const int half_picture = static_cast<int>(View::directions / glm::two_pi<double>() *
                                              std::atan(aspect * std::tan(0.5 * field_of_view)));
    Camera best;
    double most = -1;
    for (int i = 0; i < View::directions; ++i) {
      double behind = std::numeric_limits<double>::infinity();
      for (int j = -about; j <= about; ++j) {
        behind = std::min(behind, middle.along(i + View::directions / 2 + j));
      }
      const glm::dvec3 direction = View::direction(i);
      const View view =
          seen(View(middle.eye - back * behind * direction, middle.floor, middle.ceiling));
      double shown = 0;
      for (int j = -half_picture; j <= half_picture; ++j) {
        shown += view.along(i + j) * view.along(i + j);
      }
      if (shown <= most) continue;
      most = shown;
      const glm::dvec3 down(0.0, lower * (view.eye.y - view.floor), 0.0);
      best =
          Camera::look_at(view.eye, view.eye + view.along(i) * direction - down, up, field_of_view);
    }
    return best;
  }

 private:
  std::optional<SurfacePoint> met(const glm::dvec3& from, const glm::dvec3& direction) const {
    const glm::vec3 ray(direction);
    const auto hit = intersect(*rays_, glm::vec3(from), ray);
    return hit ? std::optional(surface_hit(rays_->scene(), *hit, ray)) : std::nullopt;
  }

  /// Heights of the surfaces over a position in the plan, from the top.
  std::vector<double> levels_below(glm::dvec3 position) const {
    constexpr std::size_t most_levels = 64;
    const double step = 1e-4 * box_.size().y;
    std::vector<double> levels;
    for (position.y = box_.upper.y + step; levels.size() < most_levels;) {
      const auto surface = met(position, -up);
      if (!surface) break;
      levels.push_back(static_cast<double>(surface->position.y));
      position.y = levels.back() - step;
    }
    return levels;
  }

  /// A view ends at a wall or at glass, and counts where half the way is under a ceiling.
  View seen(View view) const {
    const Scene& scene = rays_->scene();
    for (int i = 0; i < View::directions; ++i) {
      const auto wall = met(view.eye, View::direction(i));
      if (!wall) continue;
      const bool glass = scene::is_glazing(material_of(scene, *wall));
      if (!any_ && !glass && !on_front(scene, *wall)) continue;
      const glm::dvec3 way = glm::dvec3(wall->position) - view.eye;
      if (!met(view.eye + 0.5 * way, up)) continue;
      view.distance[static_cast<std::size_t>(i)] = glm::length(way);
    }
    return view;
  }

  /// Below positions all over the views; a quarter of them decides, since others may be furniture.
  double floor_around(const View& view) const {
    std::vector<double> heights;
    for (int i = 0; i < View::directions; ++i) {
      const double fraction = 0.3 + 0.2 * (i % 4);
      const auto below = met(view.eye + fraction * view.along(i) * View::direction(i), -up);
      if (below) heights.push_back(static_cast<double>(below->position.y));
    }
    if (heights.empty()) return view.floor;
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 4);
    std::nth_element(heights.begin(), low, heights.end());
    return *low;
  }

  const RayScene* rays_;
  Box box_;
  bool any_;
};

Camera outside(const Box& box) {
  const glm::dvec3 direction = glm::normalize(glm::dvec3(0.4, 0.35, 1.0));
  const double radius = 0.5 * glm::length(box.size());
  const glm::dvec3 eye = box.centre() + direction * (radius / std::sin(0.5 * field_of_view));
  return Camera::look_at(eye, box.centre(), up, field_of_view);
}

}  // namespace

Camera place_camera(const Scene& scene) {
  constexpr double enclosed = 0.75;  // of all directions: a room has doors and windows
  const FlushDenormals flush_denormals;
  const geometry::Box bounds = scene::bounds_of(scene);
  const Box box{bounds.lower, bounds.upper};
  const std::array<double, 6> coverage = coverage_of(scene, box);
  const auto closed = std::count_if(coverage.begin(), coverage.end(),
                                    [](double fraction) { return fraction >= closed_coverage; });
  const RayScene rays(scene);
  RoomSearch search(rays, box, false);
  std::optional<View> room = search.largest();
  if (!room && closed == 6) {
    search = RoomSearch(rays, box, true);
    room = search.largest();
  }
  Camera camera = outside(box);
  bool through = false;
  if (closed == 4 || closed == 5) {
    // The front of a model looks along +z, so its viewer's side comes first.
    for (const auto& [axis, sign] :
         {std::pair(2, 1.0), std::pair(2, -1.0), std::pair(0, 1.0), std::pair(0, -1.0)}) {
      if (coverage[static_cast<std::size_t>(2 * axis + (sign > 0.0))] >= closed_coverage) continue;
      glm::vec3 outwards(0.0f);
      outwards[axis] = static_cast<float>(sign);
      if (room && intersect(rays, glm::vec3(room->eye), outwards)) continue;
      camera = through_side(box, axis, sign);
      through = true;
      break;
    }
  }
  if (!through && room && (closed == 6 || room->enclosed() >= enclosed)) {
    camera = search.into_room(*room);
  }
  camera.name = "default";
  return camera;
}

}  // namespace photile::trace
