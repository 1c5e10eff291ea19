#include "surface/open_fraction.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/box_tree.hpp"
#include "geometry/triangle_distance.hpp"
#include "groups/neighbour_groups.hpp"
#include "photile/device/surface.h"

namespace photile::surface {
namespace {

constexpr double reach = PHOTILE_SLAB;  ///< over the radius
constexpr double coincident = 1e-4;     ///< over the radius: layers so close lie on each other
constexpr float least_open = 0.5f;      ///< with less a triangle counts as covered
constexpr int samples = 64;

using Corners = geometry::TriangleCorners;

/// Weights of the second and third corner in points that are evenly spread over a triangle:
/// Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences" (2018), folded into the
/// triangle.
std::array<glm::dvec2, samples> sample_weights() {
  std::array<glm::dvec2, samples> weights;
  for (int i = 0; i < samples; ++i) {
    double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0);
    double v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    weights[i] = {u, v};
  }
  return weights;
}

/// Holds a triangle moved from `low` to `high`; rounded outwards.
geometry::Box box_of_prism(const Corners& corners, const glm::dvec3& low, const glm::dvec3& high) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  geometry::Box box;
  for (const glm::dvec3& corner : corners) {
    for (const glm::dvec3& point : {corner + low, corner + high}) box.extend(glm::vec3(point));
  }
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::nextafter(box.lower[axis], -infinity);
    box.upper[axis] = std::nextafter(box.upper[axis], infinity);
  }
  return box;
}

/// The inside of a triangle's projection along `normal`, whichever way it is wound: three planes.
class Projection {
 public:
  Projection(const Corners& corner, const glm::dvec3& normal) {
    const double winding =
        glm::dot(glm::cross(corner[1] - corner[0], corner[2] - corner[0]), normal) < 0 ? -1 : 1;
    for (int i = 0; i < 3; ++i) {
      inwards_[i] = winding * glm::cross(normal, corner[(i + 1) % 3] - corner[i]);
      border_[i] = glm::dot(inwards_[i], corner[i]);
    }
  }

  bool holds(const glm::dvec3& point) const {
    return glm::dot(inwards_[0], point) >= border_[0] &&
           glm::dot(inwards_[1], point) >= border_[1] && glm::dot(inwards_[2], point) >= border_[2];
  }

  /// Whether one of its edges has all of a triangle's corners on the outer side.
  bool is_apart_from(const Corners& corner) const {
    for (int i = 0; i < 3; ++i) {
      if (std::all_of(corner.begin(), corner.end(), [&](const glm::dvec3& point) {
            return glm::dot(inwards_[i], point) < border_[i];
          })) {
        return true;
      }
    }
    return false;
  }

 private:
  std::array<glm::dvec3, 3> inwards_;
  std::array<double, 3> border_;
};

/// Boxes by coordinate, so that several are compared with one at a time.
class BoxColumns {
 public:
  BoxColumns(std::span<const geometry::Box> boxes, std::span<const std::uint32_t> chosen)
      : chosen_(chosen) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const std::uint32_t i : chosen) {
        low_[axis].push_back(boxes[i].lower[axis]);
        high_[axis].push_back(boxes[i].upper[axis]);
      }
    }
  }

  /// Calls visit(index of a box) for those of the chosen that overlap `box`.
  template <class Visit>
  void visit_overlapping(const geometry::Box& box, const Visit& visit) const {
    constexpr std::size_t at_a_time = 256;
    std::array<std::uint32_t, at_a_time> overlap, found;
    for (std::size_t first = 0; first < chosen_.size(); first += at_a_time) {
      const std::size_t count = std::min(at_a_time, chosen_.size() - first);
      overlap.fill(1);
      for (int axis = 0; axis < 3; ++axis) {
        const float *low = low_[axis].data() + first, *high = high_[axis].data() + first;
        const float begin = box.lower[axis], end = box.upper[axis];
        for (std::size_t i = 0; i < count; ++i) {
          overlap[i] &= static_cast<std::uint32_t>(low[i] <= end) &
                        static_cast<std::uint32_t>(begin <= high[i]);
        }
      }
      std::size_t found_count = 0;  // without branches: which overlap cannot be foreseen
      for (std::size_t i = 0; i < count; ++i) {
        found[found_count] = chosen_[first + i];
        found_count += overlap[i];
      }
      for (std::size_t i = 0; i < found_count; ++i) visit(found[i]);
    }
  }

 private:
  std::span<const std::uint32_t> chosen_;
  std::array<std::vector<float>, 3> low_, high_;
};

class OpenFractionFinder {
 public:
  OpenFractionFinder(const SurfaceMesh& mesh, const CoplanarRegions& regions,
                     const SmoothComponents& components, const std::vector<std::uint8_t>& lit,
                     double radius, double angle_degrees)
      : mesh_(mesh),
        regions_(regions),
        components_(components),
        lit_(lit),
        radius_(radius),
        cos_angle_(std::cos(glm::radians(angle_degrees))) {
    for (std::uint32_t t = 0; t < mesh.normal.size(); ++t) {
      const bool front = is_dark(oriented(t, 0)), back = is_dark(oriented(t, 1));
      if (!mesh.counts(t) || (!front && !back)) continue;
      dark_.push_back(
          {mesh.normal[t], geometry::corners_of(mesh.scene, t), regions.plane[t], front, back});
      dark_boxes_.push_back(geometry::triangle_box(mesh.scene, t));
    }
    dark_tree_ = geometry::BoxTree(dark_boxes_);
  }

  /// Writes that of sides [first, last) that are lit and original. Sides that follow each other
  /// mostly lie close together: what may cover one of them is looked up for all of them.
  void find(std::uint32_t first, std::uint32_t last, std::span<float> open_fraction) const {
    std::vector<LitSide> sides;
    geometry::Box all;
    float each = 0;
    for (std::uint32_t s = first; s < last; ++s) {
      if (mesh_.original[s] != s || is_dark(s)) continue;
      sides.push_back(lit_side(s));
      all.extend(sides.back().prism);
      each += sides.back().prism.half_area();
    }
    if (sides.empty()) return;
    std::vector<std::uint32_t> near;
    const bool together = all.half_area() <= 2 * each;
    if (together) {
      dark_tree_.visit_overlapping(dark_boxes_, all, [&](std::uint32_t i) { near.push_back(i); });
    }
    const BoxColumns near_boxes(dark_boxes_, near);
    for (const LitSide& side : sides) {
      std::vector<Projection> covers;
      const Projection outline(side.corners, side.normal);
      const auto look_at = [&](std::uint32_t i) { add_cover(side, outline, dark_[i], covers); };
      if (together) {
        near_boxes.visit_overlapping(side.prism, look_at);
      } else {
        dark_tree_.visit_overlapping(dark_boxes_, side.prism, look_at);
      }
      open_fraction[side.own] = open_part(side.corners, covers);
    }
  }

 private:
  /// A triangle with a side that no light reaches.
  struct DarkTriangle {
    glm::dvec3 normal;  ///< of side 0
    Corners corners;
    std::uint32_t plane;
    bool front, back;  ///< which sides are dark
  };

  struct LitSide {
    std::uint32_t own, plane;
    glm::dvec3 normal;
    Corners corners;
    geometry::Box prism;  ///< covers lie within it
  };

  LitSide lit_side(std::uint32_t s) const {
    const glm::dvec3 normal = normal_of(s);
    const Corners corners = geometry::corners_of(mesh_.scene, triangle_of(s));
    // A cover lies within the slab, and so where it covers within the prism over the triangle.
    return {s, regions_.plane[triangle_of(s)], normal, corners,
            box_of_prism(corners, -coincident * radius_ * normal, reach * radius_ * normal)};
  }

  float open_part(const Corners& corners, const std::vector<Projection>& covers) const {
    if (covers.empty()) return 1;
    int open = 0;
    for (const glm::dvec2& weight : weights_) {
      const glm::dvec3 point =
          (1 - weight.x - weight.y) * corners[0] + weight.x * corners[1] + weight.y * corners[2];
      if (open >= least_open * samples) return 1;
      open += std::none_of(covers.begin(), covers.end(),
                           [&](const Projection& cover) { return cover.holds(point); });
    }
    return open < least_open * samples ? static_cast<float>(open) / samples : 1.0f;
  }

  glm::dvec3 normal_of(std::uint32_t s) const {
    return side_of(s) == 0 ? mesh_.normal[triangle_of(s)] : -mesh_.normal[triangle_of(s)];
  }

  /// Whether a side of the triangle that no light reaches faces against `normal`.
  bool faces_in_the_dark(const DarkTriangle& dark, const glm::dvec3& normal) const {
    const std::uint32_t sides = groups::agreeing_sides(dark.normal, -normal, cos_angle_);
    return ((sides & groups::equal_sides) != 0 && dark.front) ||
           ((sides & groups::opposite_sides) != 0 && dark.back);
  }

  bool is_dark(std::uint32_t s) const { return lit_[components_.of[s]] == 0; }

  /// Appends a dark triangle that lies above a side, close to it, as seen along its normal.
  void add_cover(const LitSide& side, const Projection& outline, const DarkTriangle& dark,
                 std::vector<Projection>& covers) const {
    if (dark.plane == side.plane || !faces_in_the_dark(dark, side.normal)) return;
    const Corners& corners = dark.corners;
    double lowest = reach * radius_, highest = 0;
    for (const glm::dvec3& corner : corners) {
      const double height = glm::dot(corner - side.corners[0], side.normal);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    if (lowest < -coincident * radius_ || highest >= reach * radius_) return;
    if (outline.is_apart_from(corners)) return;
    const Projection cover(corners, side.normal);
    if (!cover.is_apart_from(side.corners)) covers.push_back(cover);
  }

  const SurfaceMesh& mesh_;
  const CoplanarRegions& regions_;
  const SmoothComponents& components_;
  const std::vector<std::uint8_t>& lit_;
  double radius_, cos_angle_;
  const std::array<glm::dvec2, samples> weights_ = sample_weights();
  std::vector<DarkTriangle> dark_;
  std::vector<geometry::Box> dark_boxes_;
  geometry::BoxTree dark_tree_;
};

}  // namespace

std::vector<float> find_open_fractions(const SurfaceMesh& mesh, const CoplanarRegions& regions,
                                       const SmoothComponents& components,
                                       const std::vector<std::uint8_t>& lit, double radius,
                                       double angle_degrees) {
  const OpenFractionFinder finder(mesh, regions, components, lit, radius, angle_degrees);
  std::vector<float> open_fraction(mesh.original.size(), 1.0f);
  constexpr std::size_t sides_at_a_time = 32;
  const std::size_t blocks = (open_fraction.size() + sides_at_a_time - 1) / sides_at_a_time;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t first = block * sides_at_a_time;
    finder.find(static_cast<std::uint32_t>(first),
                static_cast<std::uint32_t>(std::min(first + sides_at_a_time, open_fraction.size())),
                open_fraction);
  });
  return open_fraction;
}

}  // namespace photile::surface
