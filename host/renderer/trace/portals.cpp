#include "trace/portals.hpp"

#include <algorithm>
#include <cmath>

namespace photile::trace {

Portals::Portals(const Scene& scene) {
  for (const Portal& portal : scene.portals) {
    const Rectangle rectangle(glm::dvec3(portal.corner), glm::dvec3(portal.u),
                              glm::dvec3(portal.v));
    if (rectangle.area > 0) portals_.push_back(rectangle);
  }
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
    const double distance = -portal.height(point) / cosine;
    entered += portal.holds(point + distance * travel) ? 1 : 0;
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
  return chosen->at(u, v);
}

void Portals::measure(const glm::dvec3& from, PortalSizes& sizes) const {
  sizes.solid_angle.clear();
  sizes.sum = 0;
  for (const Rectangle& portal : portals_) {
    sizes.solid_angle.push_back(portal.solid_angle(from));
    sizes.sum += sizes.solid_angle.back();
  }
}

glm::dvec3 Portals::sample_direction(const glm::dvec3& from, const PortalSizes& sizes,
                                     double choice, double u, double v) const {
  double left = choice * sizes.sum;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    if (sizes.solid_angle[i] > 0) chosen = i;
    if (sizes.solid_angle[i] > left) break;
    left -= sizes.solid_angle[i];
  }
  return glm::normalize(portals_[chosen].at(u, v) - from);
}

double Portals::density(const glm::dvec3& from, const glm::dvec3& direction,
                        const PortalSizes& sizes) const {
  double density = 0;
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    if (!(sizes.solid_angle[i] > 0)) continue;
    density += sizes.solid_angle[i] * portals_[i].density(from, direction);
  }
  return density / sizes.sum;
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
