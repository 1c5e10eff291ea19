#include "trace/targets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
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

/// The sphere as seen from a point.
struct Cone {
  glm::dvec3 axis;
  double below_one;  ///< 1 - cosine of its half angle
};

/// None from within the sphere.
std::optional<Cone> cone_towards(const glm::dvec3& centre, double radius, const glm::dvec3& from) {
  const glm::dvec3 towards = centre - from;
  const double squared = glm::dot(towards, towards);
  if (squared <= radius * radius) return std::nullopt;
  const double squared_sine = radius * radius / squared;
  return Cone{towards / std::sqrt(squared), squared_sine / (1 + std::sqrt(1 - squared_sine))};
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

/// The largest cosine to a normal within the cone; 0 where all of it is below the horizon.
double largest_cosine(const Cone& cone, const glm::dvec3& normal) {
  const double cosine = std::clamp(glm::dot(cone.axis, normal), -1.0, 1.0);
  const double of_cone = 1 - cone.below_one;
  if (cosine >= of_cone) return 1;
  const double sines = (1 - cosine * cosine) * (1 - of_cone * of_cone);
  return std::max(0.0, cosine * of_cone + std::sqrt(std::max(0.0, sines)));
}

/// Directions from a point to a sphere: evenly into its cone; from within it in all directions, or
/// by the cosine law where there is a normal.
class DirectionsTo {
 public:
  DirectionsTo() = default;
  DirectionsTo(const glm::dvec3& centre, double radius, const glm::dvec3& from,
               const glm::vec3* normal)
      : cone_(cone_towards(centre, radius, from)), normal_(normal) {
    if (cone_) {
      weight_ = normal ? largest_cosine(*cone_, glm::dvec3(*normal)) : 1;
      all_ = weight_ * glm::two_pi<double>() * cone_->below_one;
    } else {
      all_ = (normal ? 1 : 4) * glm::pi<double>();
    }
  }
  double all() const { return all_; }  ///< integral of `weight` over the sphere

  glm::vec3 sample(const glm::dvec2& u) const {
    const auto x = static_cast<float>(u.x), y = static_cast<float>(u.y);
    if (!cone_) {
      return normal_ ? Frame(*normal_).to_world(sample_cosine_hemisphere(x, y))
                     : sample_sphere(x, y);
    }
    const double below_one = u.x * cone_->below_one;
    const double sine = std::sqrt(below_one * (2 - below_one));
    const double phi = glm::two_pi<double>() * u.y;
    const glm::vec3 local(sine * std::cos(phi), sine * std::sin(phi), 1 - below_one);
    return glm::normalize(Frame(glm::vec3(cone_->axis)).to_world(local));
  }
  /// Where `sample` says so it may lie at the border, to a rounding beyond it.
  double weight(const glm::vec3& direction, bool sampled) const {
    if (cone_) {
      const glm::dvec3 apart = glm::dvec3(direction) - cone_->axis;
      return sampled || 0.5 * glm::dot(apart, apart) <= cone_->below_one ? weight_ : 0;
    }
    if (!normal_) return 1;
    return std::max(0.0, static_cast<double>(glm::dot(direction, *normal_)));
  }

 private:
  std::optional<Cone> cone_;
  const glm::vec3* normal_ = nullptr;
  double weight_ = 0, all_ = 0;
};

}  // namespace

Targets::Targets(const Scene& scene) {
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

Targets::Direction Targets::direction_from(const glm::dvec3& from,
                                                           const glm::vec3* normal,
                                                           glm::dvec2 u) const {
  std::array<DirectionsTo, most_spheres> to;
  std::array<double, most_spheres> weights{};
  double all = 0;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    to[i] = DirectionsTo(spheres_[i].centre, spheres_[i].radius, from, normal);
    all += weights[i] = to[i].all();
  }
  if (!(all > 0)) return {glm::vec3(0, 0, 1), 0};
  const std::size_t chosen = choose(std::span(weights).first(spheres_.size()), all, u.x);
  const glm::vec3 direction = to[chosen].sample(u);
  double found = 0;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    found += to[i].weight(direction, i == chosen);
  }
  return {direction, found / all};
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

}  // namespace photile::trace
