// The truth for the nearest photons and the density estimate: brute force in double precision,
// sharing no code with the kernels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "oracle/clipped_area.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile::reference {

/// Photons that may be neighbours of hits on an oriented face: those whose own oriented face's
/// normal agrees with it (grouped maps), or those on the very same oriented face (naive maps).
enum class PhotonFilter { grouped, naive };

struct OracleNeighbours {
  std::vector<std::uint32_t> photons;  ///< nearest first; ties by index
  std::vector<double> squared_distance;
  double squared_radius = 0;  ///< of the disc that the estimate divides by, m2
};

class DensityOracle {
 public:
  /// References are kept. `angle_degrees`: largest angle between normals.
  DensityOracle(const Scene& scene, const Photons& photons, PhotonFilter filter,
                double angle_degrees);
  /// An oracle for photons of one light on surfaces of these unit normals, by oriented face; no
  /// disc is smaller than a hundred-thousandth of `size`, metres.
  DensityOracle(std::vector<glm::dvec3> normals, double size, const Photons& photons,
                double angle_degrees);

  /// The k nearest photons of a hit, none farther than `radius`.
  OracleNeighbours nearest(const glm::dvec3& hit, std::uint32_t oriented_face, int k,
                           double radius) const;

  /// Irradiance per light at power 1: flux of the k - 1 nearest (all, where fewer than k lie within
  /// the radius; the nearest for k = 1) over the area of the disc. With a kernel and k > 1 each is
  /// weighted, and the area is the kernel's integral.
  std::vector<glm::dvec3> irradiance(const glm::dvec3& hit, std::uint32_t oriented_face, int k,
                                     double radius,
                                     DensityKernel kernel = DensityKernel::constant) const;

  /// The irradiance where the disc is clipped to the surface: of these photons those in the slab
  /// around the hit's plane, over the clipped area.
  std::vector<glm::dvec3> irradiance(const ClippedArea& surface, const glm::dvec3& hit,
                                     std::uint32_t oriented_face, int k, double radius,
                                     DensityKernel kernel = DensityKernel::constant) const;

 private:
  std::vector<glm::dvec3> sums(const OracleNeighbours& near, double radius, DensityKernel kernel,
                               double area) const;
  bool counts(std::uint32_t photon_map, std::uint32_t hit_map) const;

  const Photons& photons_;
  PhotonFilter filter_;
  double cos_angle_;
  std::size_t light_count_;
  double diagonal_;
  std::vector<glm::dvec3> normals_;  ///< per oriented face
};

}  // namespace photile::reference
