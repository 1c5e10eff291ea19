// The truth for areas of discs clipped to the surface: every triangle of the scene, cut by polygon
// clipping in double precision, kernels integrated numerically. Shares no code with the kernels.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "photile/estimator.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"
#include "photile/surface_index.hpp"

namespace photile::reference {

class ClippedArea {
 public:
  /// Height of the slab in which surface and photons count, over the radius.
  static constexpr double slab = 0.2;

  /// References are kept. The constructor takes from `surface` the components, the exposure and the
  /// unlit regions, and no more.
  ClippedArea(const Scene& scene, const Photons& photons, const SurfaceIndex& surface,
              double angle_degrees);

  /// The integral of the kernel, square metres, over the surface within `radius` of a hit and in
  /// the slab around its plane, of agreeing normal, on components where photons landed or on the
  /// hit's own, without the unlit regions on these. A hit within an unlit region counts them, too.
  double area(const glm::dvec3& hit, std::uint32_t oriented_face, double radius,
              DensityKernel kernel = DensityKernel::constant) const;

 private:
  bool is_in_unlit_region(const glm::dvec3& hit, std::uint32_t original) const;
  double area_of_triangle(const glm::dvec3& hit, const glm::dvec3& normal,
                          const std::array<glm::vec3, 3>& corners, double radius,
                          DensityKernel kernel) const;

  const Scene& scene_;
  const SurfaceIndex& surface_;
  double cos_angle_;
  std::vector<bool> lit_;            ///< per component
  std::vector<glm::dvec3> normals_;  ///< per oriented face
};

}  // namespace photile::reference
