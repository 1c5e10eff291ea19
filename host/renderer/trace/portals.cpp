#include "trace/portals.hpp"

#include <algorithm>
#include <cmath>

namespace photile::trace {

Portals::Portals(const Scene& scene) {
  for (const Portal& portal : scene.portals) {
    const glm::dvec3 corner(portal.corner), u(portal.u), v(portal.v);
    const glm::dvec3 across = glm::cross(u, v);
    const double area = glm::length(across);
    if (!(area > 0)) continue;
    portals_.push_back({corner, u, v, across / area, area, glm::dot(u, u), glm::dot(v, v)});
  }
}

/// Whether a point of its plane lies on a portal.
bool Portals::crosses(const Rectangle& portal, const glm::dvec3& point) {
  const glm::dvec3 offset = point - portal.corner;
  const double along_u = glm::dot(offset, portal.u), along_v = glm::dot(offset, portal.v);
  return along_u >= 0 && along_u <= portal.uu && along_v >= 0 && along_v <= portal.vv;
}

double Portals::area_facing(const glm::dvec3& travel) const {
  double area = 0;
  for (const Rectangle& portal : portals_)
    area += portal.area * std::max(0.0, glm::dot(portal.normal, travel));
  return area;
}

int Portals::entered_by(const glm::dvec3& point, const glm::dvec3& travel) const {
  int entered = 0;
  for (const Rectangle& portal : portals_) {
    const double cosine = glm::dot(portal.normal, travel);
    if (!(cosine > 0)) continue;
    const double distance = glm::dot(portal.corner - point, portal.normal) / cosine;
    entered += crosses(portal, point + distance * travel) ? 1 : 0;
  }
  return entered;
}

glm::dvec3 Portals::entrance(const glm::dvec3& travel, double choice, double u, double v) const {
  double left = choice * area_facing(travel);
  const Rectangle* chosen = nullptr;
  for (const Rectangle& portal : portals_) {
    const double area = portal.area * std::max(0.0, glm::dot(portal.normal, travel));
    if (area > 0) chosen = &portal;
    if (area > left) break;
    left -= area;
  }
  if (chosen == nullptr) chosen = &portals_.front();
  return chosen->corner + u * chosen->u + v * chosen->v;
}

double Portals::weigh(const glm::dvec3& from, std::vector<double>& weights) const {
  weights.clear();
  double sum = 0;
  for (const Rectangle& portal : portals_) {
    const double height = glm::dot(from - portal.corner, portal.normal);
    double weight = 0;
    if (height > 0) {
      const glm::dvec3 middle = portal.corner + 0.5 * (portal.u + portal.v) - from;
      // About its solid angle, and never 0 where it can be seen.
      const double squared = glm::dot(middle, middle) + 0.25 * portal.area;
      weight = portal.area * height / (squared * std::sqrt(squared));
    }
    sum += weight;
    weights.push_back(weight);
  }
  return sum;
}

glm::dvec3 Portals::sample_direction(const glm::dvec3& from, const std::vector<double>& weights,
                                     double sum, double choice, double u, double v) const {
  double left = choice * sum;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    if (weights[i] > 0) chosen = i;
    if (weights[i] > left) break;
    left -= weights[i];
  }
  const Rectangle& portal = portals_[chosen];
  return glm::normalize(portal.corner + u * portal.u + v * portal.v - from);
}

double Portals::density(const glm::dvec3& from, const glm::dvec3& direction,
                        const std::vector<double>& weights, double sum) const {
  double density = 0;
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    const Rectangle& portal = portals_[i];
    const double cosine = -glm::dot(portal.normal, direction);
    if (!(weights[i] > 0) || !(cosine > 0)) continue;
    const double distance = glm::dot(from - portal.corner, portal.normal) / cosine;
    if (!crosses(portal, from + distance * direction)) continue;
    density += weights[i] * distance * distance / (portal.area * cosine);
  }
  return density / sum;
}

double area_facing(const Portals& portals, const DistantSampler& light) {
  constexpr int directions = 64;
  double sum = 0;
  for (int i = 0; i < directions; ++i) {
    const RandomStream random(0, static_cast<std::uint64_t>(i), 0);
    const glm::vec3 towards = light.sample(random.block(Purpose::emission, 0)).direction;
    sum += portals.area_facing(-glm::dvec3(towards));
  }
  return sum / directions;
}

}  // namespace photile::trace
