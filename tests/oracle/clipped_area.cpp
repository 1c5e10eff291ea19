#include "oracle/clipped_area.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "oracle/kernel_weights.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::reference {
namespace {

using Polygon = std::vector<glm::dvec3>;

/// Corners of the polygon that stands for a circle. As large as the circle, it misplaces parts of
/// it by a millionth of the area.
constexpr int circle_corners = 4096;

/// The part of a convex polygon where offset + normal . p >= 0 (Sutherland and Hodgman 1974).
Polygon clipped(const Polygon& polygon, const glm::dvec3& normal, double offset) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3& p = polygon[i];
    const glm::dvec3& q = polygon[(i + 1) % polygon.size()];
    const double at_p = offset + glm::dot(normal, p), at_q = offset + glm::dot(normal, q);
    if (at_p >= 0) result.push_back(p);
    if ((at_p >= 0) != (at_q >= 0)) result.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
  return result;
}

/// int_0^rho K(d(x)) x dx / rho^2,  d(x)^2 = x^2 + height^2, by Simpson's rule.
double radial_mean(DensityKernel kernel, double rho, double height) {
  if (kernel == DensityKernel::constant) return 0.5;
  const auto at = [&](double x) { return x * weight_at(kernel, std::hypot(x * rho, height)); };
  constexpr int steps = 16;
  double sum = at(0) + at(1);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 0 ? 2 : 4) * at(static_cast<double>(i) / steps);
  return sum / (3 * steps);
}

/// The integral of the kernel over a polygon in the plane through height * normal: for each edge
/// that over the triangle from the foot of the origin, whose sign tells on which side of the edge
/// that lies. Lengths are over the radius.
double integral_over(const Polygon& polygon, DensityKernel kernel, const glm::dvec3& normal,
                     double height) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 p = polygon[i] - height * normal;
    const glm::dvec3 q = polygon[(i + 1) % polygon.size()] - height * normal;
    const int steps = kernel == DensityKernel::constant || glm::length(q - p) < 0.01 ? 1 : 400;
    double mean = 0;
    for (int step = 0; step < steps; ++step) {
      mean += radial_mean(kernel, glm::length(p + (q - p) * ((step + 0.5) / steps)), height);
    }
    sum += glm::dot(normal, glm::cross(p, q)) * mean / steps;
  }
  return std::abs(sum);
}

Polygon circle(const glm::dvec3& centre, const glm::dvec3& normal, double radius) {
  constexpr double step = glm::two_pi<double>() / circle_corners;
  const double same_area = radius * std::sqrt(step / std::sin(step));
  const glm::dvec3 off = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(normal, off)), v = glm::cross(normal, u);
  Polygon polygon;
  for (int i = 0; i < circle_corners; ++i) {
    polygon.push_back(centre + same_area * (std::cos(i * step) * u + std::sin(i * step) * v));
  }
  return polygon;
}

}  // namespace

ClippedArea::ClippedArea(const Scene& scene, const Photons& photons, const SurfaceIndex& surface,
                         double angle_degrees)
    : scene_(scene),
      surface_(surface),
      cos_angle_(std::cos(glm::radians(angle_degrees))),
      lit_(surface.components, false) {
  for (const std::uint32_t s : photons.oriented_face) {
    if (surface.dark[s] == 0) lit_[surface.component[s]] = true;
  }
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    normals_.push_back(face_normal(scene, s));
  }
}

bool ClippedArea::is_in_unlit_region(const glm::dvec3& hit, std::uint32_t own) const {
  return std::any_of(surface_.unlit_regions.begin(), surface_.unlit_regions.end(),
                     [&](const auto& part) {
                       if (part.oriented_face != own) return false;
                       const glm::dvec3 a(part.corner[0]), ab = glm::dvec3(part.corner[1]) - a;
                       const glm::dvec3 ac = glm::dvec3(part.corner[2]) - a, ah = hit - a;
                       const glm::dvec3 normal = glm::cross(ab, ac);
                       const double whole = glm::dot(normal, normal);
                       const double b = glm::dot(glm::cross(ah, ac), normal) / whole;
                       const double c = glm::dot(glm::cross(ab, ah), normal) / whole;
                       return b >= 0 && c >= 0 && b + c <= 1;
                     });
}

double ClippedArea::area(const glm::dvec3& hit, std::uint32_t own, double radius,
                         DensityKernel kernel) const {
  const glm::dvec3& n = normals_[own];
  const bool in_the_dark = is_in_unlit_region(hit, surface_.original[own]);
  const std::uint32_t own_component = in_the_dark ? none : surface_.component[own];
  const auto counts = [&](std::uint32_t component) {
    return lit_[component] || component == own_component;
  };
  double sum = 0, projected = 0;
  for (std::uint32_t s = 0; s < normals_.size(); ++s) {
    const std::uint32_t component = surface_.component[s];
    if (surface_.original[s] != s) continue;
    if (!counts(component)) continue;
    if (!normals_agree(normals_[s], n, cos_angle_)) continue;
    const double exposure =
        component == own_component ? 1.0 : static_cast<double>(surface_.open_fraction[s]);
    const double part =
        exposure * area_of_triangle(hit, n, scene_.corners(triangle_of(s)), radius, kernel);
    sum += part;
    projected += part * glm::dot(normals_[s], n);
  }
  for (const DarkPart& dark : surface_.unlit_regions) {
    const glm::dvec3& normal = normals_[dark.oriented_face];
    if (in_the_dark || !counts(surface_.component[dark.oriented_face])) continue;
    if (!normals_agree(normal, n, cos_angle_)) continue;
    const double hole = area_of_triangle(hit, n, dark.corner, radius, kernel);
    sum -= hole;
    projected -= hole * glm::dot(normal, n);
  }
  // Light that falls along the normal lands once, however many layers there are.
  const double disc = glm::pi<double>() * mean_weight(kernel) * radius * radius;
  return std::max(sum * std::min(1.0, disc / projected), 1e-4 * disc);
}

double ClippedArea::area_of_triangle(const glm::dvec3& hit, const glm::dvec3& n,
                                     const std::array<glm::vec3, 3>& corners, double radius,
                                     DensityKernel kernel) const {
  std::array<glm::dvec3, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = (glm::dvec3(corners[i]) - hit) / radius;
  const glm::dvec3 low = glm::min(p[0], glm::min(p[1], p[2]));
  const glm::dvec3 high = glm::max(p[0], glm::max(p[1], p[2]));
  if (glm::any(glm::greaterThan(low, glm::dvec3(1)))) return 0;
  if (glm::any(glm::lessThan(high, glm::dvec3(-1)))) return 0;
  const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
  const double height = glm::dot(normal, p[0]);
  const double squared = 1 - height * height;
  if (!(squared > 0)) return 0;
  bool beyond = false;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 inward = glm::normalize(glm::cross(normal, p[(i + 1) % 3] - p[i]));
    beyond |= -glm::dot(inward, p[i]) <= -std::sqrt(squared);
  }
  if (beyond) return 0;
  Polygon part(p.begin(), p.end());
  if (std::any_of(p.begin(), p.end(), [](const auto& corner) { return glm::length(corner) > 1; })) {
    part = circle(height * normal, normal, std::sqrt(squared));
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 inward = glm::cross(normal, p[(i + 1) % 3] - p[i]);
      part = clipped(part, inward, -glm::dot(inward, p[i]));
    }
  }
  part = clipped(part, n, slab);
  part = clipped(part, -n, slab);
  return radius * radius * integral_over(part, kernel, normal, height);
}

}  // namespace photile::reference
