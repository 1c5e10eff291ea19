#include "trace/targets.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <span>
#include <utility>

#include "trace/sampling.hpp"

namespace photile::trace {
namespace {

/// The most spheres of mirrors and glass: each costs time when a path starts.
constexpr std::size_t most_specular_spheres = 16;
/// Two spheres in place of one have to show less than this part of its disc.
constexpr double worth_splitting = 0.8;
/// The distance of the start of rays from the points that directions are sampled at, over the
/// radius.
constexpr double margin = 1e-3;

struct SurfaceBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void add(const SurfaceBox& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  glm::dvec3 middle() const { return 0.5 * (low + high); }
  double squared_radius() const { return 0.25 * glm::dot(high - low, high - low); }
};

SurfaceBox box_of(std::span<const SurfaceBox> boxes) {
  SurfaceBox all;
  for (const SurfaceBox& box : boxes) all.add(box);
  return all;
}

/// Neighbours of one sphere, and where they are best parted.
struct Part {
  std::span<SurfaceBox> boxes;
  SurfaceBox box;
  std::size_t cut = 0;
  double gain = 0;  ///< of the squared radius
};

/// Sorts the boxes along the longest side of all, and finds the cut with the smallest spheres.
Part part_of(std::span<SurfaceBox> boxes) {
  Part part{boxes, box_of(boxes)};
  const glm::dvec3 sides = part.box.high - part.box.low;
  const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
  std::stable_sort(boxes.begin(), boxes.end(), [&](const SurfaceBox& a, const SurfaceBox& b) {
    return a.low[axis] + a.high[axis] < b.low[axis] + b.high[axis];
  });
  std::vector<double> above(boxes.size());
  SurfaceBox upper, lower;
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

/// One of some, in proportion to its weight, by a number in [0, 1) that is as even afterwards.
///   all   the sum of the weights
std::size_t choose(std::span<const double> weights, double all, double& u) {
  double target = u * all;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    chosen = i;
    if (target < weights[i]) break;
    target -= weights[i];
  }
  u = std::clamp(target / weights[chosen], 0.0, 1 - 0x1p-24);
  return chosen;
}

/// The largest cosine to a normal within a cone; 0 where all of it is below the horizon.
///   of_cone   cosine of its half angle
double largest_cosine(const glm::dvec3& axis, double of_cone, const glm::dvec3& normal) {
  const double cosine = std::clamp(glm::dot(axis, normal), -1.0, 1.0);
  if (cosine >= of_cone) return 1;
  const double sines = (1 - cosine * cosine) * (1 - of_cone * of_cone);
  return std::max(0.0, cosine * of_cone + std::sqrt(std::max(0.0, sines)));
}

}  // namespace

Targets::Targets(std::vector<Sphere> spheres) : spheres_(std::move(spheres)) {
  if (spheres_.size() > most_spheres) spheres_.resize(most_spheres);
}

Targets specular_targets(const Scene& scene) {
  std::vector<SurfaceBox> boxes;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    if (scene.materials[scene.triangle_material[t]].interaction == Interaction::opaque) continue;
    const auto [a, b, c] = scene.corners(t);
    boxes.push_back(
        {glm::dvec3(glm::min(a, glm::min(b, c))), glm::dvec3(glm::max(a, glm::max(b, c)))});
  }
  if (boxes.empty()) return Targets({});
  std::vector<Part> parts{part_of(boxes)};
  while (parts.size() < most_specular_spheres) {
    const auto widest = std::max_element(
        parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.gain < b.gain; });
    if (!(widest->gain > 0)) break;
    const Part whole = *widest;
    *widest = part_of(whole.boxes.first(whole.cut));
    parts.push_back(part_of(whole.boxes.subspan(whole.cut)));
  }
  std::vector<Targets::Sphere> spheres;
  for (const Part& part : parts) {
    spheres.push_back({part.box.middle(), (1 + margin) * std::sqrt(part.box.squared_radius())});
  }
  return Targets(std::move(spheres));
}

Targets::Line Targets::line_along(const glm::dvec3& travel, glm::dvec2 u) const {
  std::array<double, most_spheres> weights{};
  double all = 0;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    all += weights[i] = spheres_[i].radius * spheres_[i].radius;
  }
  const std::size_t chosen = choose(std::span(weights).first(spheres_.size()), all, u.x);
  const Frame frame{glm::vec3(travel)};
  const glm::dvec2 disc = glm::dvec2(sample_disc(static_cast<float>(u.x), static_cast<float>(u.y)));
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

Aim::Aim(const Targets& targets, const glm::dvec3& from, const glm::vec3* normal)
    : normal_(normal) {
  for (const Targets::Sphere& sphere : targets.spheres_) {
    const glm::dvec3 towards = sphere.centre - from;
    const double squared = glm::dot(towards, towards);
    if (squared <= sphere.radius * sphere.radius) {
      around_ += sphere.brightness;
      continue;
    }
    const double squared_sine = sphere.radius * sphere.radius / squared;
    Cone& cone = cone_[cones_];
    cone.axis = towards / std::sqrt(squared);
    cone.below_one = squared_sine / (1 + std::sqrt(1 - squared_sine));
    cone.weight =
        sphere.brightness *
        (normal ? largest_cosine(cone.axis, 1 - cone.below_one, glm::dvec3(*normal)) : 1.0);
    all_ += share_[cones_++] = cone.weight * glm::two_pi<double>() * cone.below_one;
  }
  all_ += share_[cones_] = around_ * (normal ? 1 : 4) * glm::pi<double>();
}

double Aim::weight_around(const glm::vec3& direction) const {
  if (!normal_) return around_;
  return around_ * std::max(0.0, static_cast<double>(glm::dot(direction, *normal_)));
}

Aim::Direction Aim::sample(glm::dvec2 u) const {
  const std::size_t chosen = choose(std::span(share_).first(cones_ + 1), all_, u.x);
  const auto x = static_cast<float>(u.x), y = static_cast<float>(u.y);
  if (chosen == cones_) {
    const glm::vec3 direction =
        normal_ ? Frame(*normal_).to_world(sample_cosine_hemisphere(x, y)) : sample_sphere(x, y);
    return {direction, density(direction)};
  }
  const Cone& cone = cone_[chosen];
  const double below_one = u.x * cone.below_one;
  const double sine = std::sqrt(below_one * (2 - below_one));
  const double phi = glm::two_pi<double>() * u.y;
  const glm::vec3 local(sine * std::cos(phi), sine * std::sin(phi), 1 - below_one);
  const glm::vec3 direction = glm::normalize(Frame(glm::vec3(cone.axis)).to_world(local));
  // At the border it may lie a rounding beyond its own cone.
  return {direction, std::max(density(direction), cone.weight / all_)};
}

double Aim::density(const glm::vec3& direction) const {
  double weight = weight_around(direction);
  for (const Cone& cone : std::span(cone_).first(cones_)) {
    const glm::dvec3 apart = glm::dvec3(direction) - cone.axis;
    if (0.5 * glm::dot(apart, apart) <= cone.below_one) weight += cone.weight;
  }
  return weight / all_;
}

}  // namespace photile::trace
