#include "trace/specular_targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <span>

#include "trace/sampling.hpp"

namespace photile::trace {
namespace {

/// A path pays for each when it starts.
constexpr std::size_t most_spheres = 16;
/// Two spheres in place of one have to show less than this part of its disc.
constexpr double worth_splitting = 0.8;
/// Rays start so close beside the points that directions are from, in parts of the radius.
constexpr double margin = 1e-3;

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  glm::dvec3 middle() const { return 0.5 * (low + high); }
  double squared_radius() const { return 0.25 * glm::dot(high - low, high - low); }
};

Box box_of(std::span<const Box> boxes) {
  Box all;
  for (const Box& box : boxes) all.add(box);
  return all;
}

/// Neighbours of one sphere, and where they are best parted.
struct Part {
  std::span<Box> boxes;
  Box box;
  std::size_t cut = 0;
  double gain = 0;  ///< of the squared radius
};

/// Sorts the boxes along the longest side of all, and finds the cut with the smallest spheres.
Part part_of(std::span<Box> boxes) {
  Part part{boxes, box_of(boxes)};
  const glm::dvec3 sides = part.box.high - part.box.low;
  const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
  std::stable_sort(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    return a.low[axis] + a.high[axis] < b.low[axis] + b.high[axis];
  });
  std::vector<double> above(boxes.size());
  Box upper, lower;
  for (std::size_t i = boxes.size(); i-- > 1;) {
    upper.add(boxes[i]);
    above[i] = upper.squared_radius();
  }
  for (std::size_t i = 1; i < boxes.size(); ++i) {
    lower.add(boxes[i - 1]);
    const double both = lower.squared_radius() + above[i];
    const double gain = part.box.squared_radius() - both;
    if (both < worth_splitting * part.box.squared_radius() && gain > part.gain) {
      part.cut = i;
      part.gain = gain;
    }
  }
  return part;
}

/// A cone as seen from a point; all directions within the sphere.
struct Cone {
  glm::dvec3 axis{0, 0, 1};
  double below_one = 2;  ///< 1 - cosine of its half angle
  double weight = 0;     ///< of a direction in it

  double solid_angle() const { return glm::two_pi<double>() * below_one; }
  bool holds(const glm::dvec3& direction) const {
    const glm::dvec3 apart = direction - axis;
    return 0.5 * glm::dot(apart, apart) <= below_one;  // 1 - cosine
  }
};

Cone cone_towards(const glm::dvec3& centre, double radius, const glm::dvec3& from) {
  const glm::dvec3 towards = centre - from;
  const double squared = glm::dot(towards, towards);
  Cone cone;
  if (squared <= radius * radius) return cone;
  cone.axis = towards / std::sqrt(squared);
  const double squared_sine = radius * radius / squared;
  cone.below_one = squared_sine / (1 + std::sqrt(1 - squared_sine));
  return cone;
}

/// The largest cosine to a normal within the cone; 0 where all of it is below the horizon.
double largest_cosine(const Cone& cone, const glm::dvec3& normal) {
  const double cosine = std::clamp(glm::dot(cone.axis, normal), -1.0, 1.0);
  const double of_cone = 1 - cone.below_one;
  if (cosine >= of_cone) return 1;
  const double sines = (1 - cosine * cosine) * (1 - of_cone * of_cone);
  return std::max(0.0, cosine * of_cone + std::sqrt(std::max(0.0, sines)));
}

}  // namespace

SpecularTargets::SpecularTargets(const Scene& scene) {
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    if (scene.materials[scene.triangle_material[t]].interaction == Interaction::opaque) continue;
    const auto [a, b, c] = scene.corners(t);
    boxes.push_back(
        {glm::dvec3(glm::min(a, glm::min(b, c))), glm::dvec3(glm::max(a, glm::max(b, c)))});
  }
  if (boxes.empty()) return;
  std::vector<Part> parts{part_of(boxes)};
  while (parts.size() < most_spheres) {
    const auto widest = std::max_element(
        parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.gain < b.gain; });
    if (!(widest->gain > 0)) break;
    const Part whole = *widest;
    *widest = part_of(whole.boxes.first(whole.cut));
    parts.push_back(part_of(whole.boxes.subspan(whole.cut)));
  }
  for (const Part& part : parts) {
    spheres_.push_back({part.box.middle(), (1 + margin) * std::sqrt(part.box.squared_radius())});
  }
}

SpecularTargets::Direction SpecularTargets::direction_from(const glm::dvec3& from,
                                                           const glm::vec3* normal,
                                                           const RandomBlock& random) const {
  std::array<Cone, most_spheres> cones;
  double all = 0;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    cones[i] = cone_towards(spheres_[i].centre, spheres_[i].radius, from);
    cones[i].weight = normal ? largest_cosine(cones[i], glm::dvec3(*normal)) : 1;
    all += cones[i].weight * cones[i].solid_angle();
  }
  if (!(all > 0)) return {glm::vec3(0, 0, 1), 0};
  double left = random.uniform_double(0) * all;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    if (!(cones[i].weight > 0)) continue;
    chosen = i;
    left -= cones[i].weight * cones[i].solid_angle();
    if (left < 0) break;
  }
  const Cone& cone = cones[chosen];
  const double below_one = double{random.uniform(2)} * cone.below_one;
  const double sine = std::sqrt(below_one * (2 - below_one));
  const double phi = glm::two_pi<double>() * double{random.uniform(3)};
  const glm::vec3 direction = glm::normalize(
      Frame(glm::vec3(cone.axis))
          .to_world(glm::vec3(sine * std::cos(phi), sine * std::sin(phi), 1 - below_one)));
  double weights = cone.weight;  // at a border the direction may lie outside by rounding
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    if (i != chosen && cones[i].holds(glm::dvec3(direction))) weights += cones[i].weight;
  }
  return {direction, weights / all};
}

SpecularTargets::Line SpecularTargets::line_along(const glm::dvec3& travel,
                                                  const RandomBlock& random) const {
  double all = 0;
  for (const Sphere& sphere : spheres_) all += sphere.radius * sphere.radius;
  double left = random.uniform_double(0) * all;
  std::size_t chosen = 0;
  while (chosen + 1 < spheres_.size() &&
         (left -= spheres_[chosen].radius * spheres_[chosen].radius) >= 0) {
    ++chosen;
  }
  const Frame frame{glm::vec3(travel)};
  const glm::dvec2 disc = glm::dvec2(sample_disc(random.uniform(2), random.uniform(3)));
  const Sphere& sphere = spheres_[chosen];
  const glm::dvec3 point =
      sphere.centre + sphere.radius * (glm::dvec3(frame.s) * disc.x + glm::dvec3(frame.t) * disc.y);
  int shown_by = 1;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    const glm::dvec3 across = glm::cross(point - spheres_[i].centre, travel);
    shown_by += i != chosen && glm::dot(across, across) <= spheres_[i].radius * spheres_[i].radius;
  }
  return {point, shown_by / (glm::pi<double>() * all)};
}

}  // namespace photile::trace
