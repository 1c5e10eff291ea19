#include "surface/exposure.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "groups/triangle_bvh.hpp"
#include "photile/neighbour_groups.hpp"

namespace photile::surface {
namespace {

constexpr double reach = 0.2;        ///< over the radius: as high as the slab of an estimate
constexpr double coincident = 1e-4;  ///< over the radius: layers so close lie on each other
constexpr float least_open = 0.5f;   ///< with less a triangle counts as covered
constexpr int samples = 64;

/// What may cover a triangle, in the triangle's plane.
struct Cover {
  std::array<glm::dvec3, 3> corner;
};

/// Point i of `samples` of a triangle, evenly spread: Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences" (2018), folded into the triangle.
glm::dvec3 sample_point(const std::array<glm::vec3, 3>& corners, int i) {
  double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0);
  double v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return (1 - u - v) * glm::dvec3(corners[0]) + u * glm::dvec3(corners[1]) +
         v * glm::dvec3(corners[2]);
}

/// Whether a point's projection along `normal` lies in the triangle, whichever way that is wound.
bool covers(const Cover& cover, const glm::dvec3& point, const glm::dvec3& normal) {
  int inside = 0;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 edge = cover.corner[(i + 1) % 3] - cover.corner[i];
    inside += glm::dot(glm::cross(normal, edge), point - cover.corner[i]) >= 0 ? 1 : -1;
  }
  return std::abs(inside) == 3;
}

class ExposureFinder {
 public:
  ExposureFinder(const SurfaceMesh& mesh, const Sheets& sheets,
                 const std::vector<std::uint8_t>& lit, double radius, double angle_degrees)
      : mesh_(mesh),
        sheets_(sheets),
        lit_(lit),
        radius_(radius),
        cos_angle_(std::cos(glm::radians(angle_degrees))),
        tree_(mesh.scene) {}

  float exposure_of(std::uint32_t own) const {
    if (lit_[sheets_.of[own]] == 0) return 1;
    const glm::dvec3 normal = normal_of(own);
    const std::vector<Cover> near = covers_near(own, normal);
    if (near.empty()) return 1;
    const auto corners = mesh_.scene.corners(triangle_of(own));
    int open = 0;
    for (int i = 0; i < samples; ++i) {
      const glm::dvec3 point = sample_point(corners, i);
      open += std::none_of(near.begin(), near.end(),
                           [&](const Cover& cover) { return covers(cover, point, normal); });
    }
    const float fraction = static_cast<float>(open) / samples;
    return fraction < least_open ? fraction : 1.0f;
  }

 private:
  glm::dvec3 normal_of(std::uint32_t s) const {
    return side_of(s) == 0 ? mesh_.normal[triangle_of(s)] : -mesh_.normal[triangle_of(s)];
  }

  std::vector<Cover> covers_near(std::uint32_t own, const glm::dvec3& normal) const {
    std::vector<Cover> near;
    const glm::dvec3 origin(mesh_.scene.corners(triangle_of(own))[0]);
    const auto add = [&](std::uint32_t s) {
      if (lit_[sheets_.of[s]] != 0 || !normals_agree(normal_of(s), -normal, cos_angle_)) return;
      Cover cover;
      double lowest = reach * radius_, highest = 0;
      for (int i = 0; i < 3; ++i) {
        cover.corner[i] = glm::dvec3(mesh_.scene.corners(triangle_of(s))[i]);
        const double height = glm::dot(cover.corner[i] - origin, normal);
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
      }
      if (lowest >= -coincident * radius_ && highest < reach * radius_) near.push_back(cover);
    };
    tree_.for_each_leaf_within(groups::triangle_box(mesh_.scene, triangle_of(own)), reach * radius_,
                               [&](std::size_t first, std::size_t last) {
                                 for (std::size_t i = first; i < last; ++i) {
                                   const std::uint32_t triangle = tree_.order()[i];
                                   if (triangle == triangle_of(own) || !mesh_.counts(triangle))
                                     continue;
                                   add(sided(triangle, 0));
                                   add(sided(triangle, 1));
                                 }
                               });
    return near;
  }

  const SurfaceMesh& mesh_;
  const Sheets& sheets_;
  const std::vector<std::uint8_t>& lit_;
  double radius_, cos_angle_;
  groups::TriangleBvh tree_;
};

}  // namespace

std::vector<float> find_exposure(const SurfaceMesh& mesh, const Sheets& sheets,
                                 const std::vector<std::uint8_t>& lit, double radius,
                                 double angle_degrees) {
  const ExposureFinder finder(mesh, sheets, lit, radius, angle_degrees);
  std::vector<float> exposure(mesh.original.size(), 1.0f);
  tbb::parallel_for(std::size_t{0}, exposure.size(), [&](std::size_t i) {
    const auto s = static_cast<std::uint32_t>(i);
    if (mesh.original[s] == s) exposure[i] = finder.exposure_of(s);
  });
  return exposure;
}

}  // namespace photile::surface
