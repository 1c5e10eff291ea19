// The photon map of one triangle: which photons it holds, and whose; drawn over the picture.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "photile/camera.hpp"
#include "photile/ray_scene.hpp"
#include "photile/renderer.hpp"
#include "view/frame.hpp"

namespace photile::view {

/// What is kept of photons to show them: 12 bytes for each.
struct InspectablePhotons {
  std::vector<glm::vec3> position;      ///< metres, as in Photons
  std::vector<std::uint32_t> first_of;  ///< as in Photons
  Patches patches;                      ///< which triangles share a map
  double radius = 0;                    ///< metres, of the maps; infinite where they are naive
  double angle_degrees = 0;             ///< of the neighbour groups

  static InspectablePhotons of(const TracedPhotons& photons);
};

/// An oriented face and what an estimate on it may find.
struct PhotonMapView {
  std::uint32_t oriented_face = none;
  /// Oriented faces of its neighbour group (Graglia et al. 2012, section 2.1) without itself,
  /// ascending: at most the radius away, with a normal that agrees.
  std::vector<std::uint32_t> group;
  /// Oriented faces that share its map without being of its group, ascending.
  std::vector<std::uint32_t> patch;
  std::vector<glm::vec3> own_photons;    ///< that landed on it
  std::vector<glm::vec3> group_photons;  ///< on its group, at most the radius from it
};

/// The oriented face that a ray meets first; none = nothing.
///   direction   unit
std::uint32_t face_along(const RayScene& rays, const glm::dvec3& from, const glm::dvec3& direction);

/// Looks at one oriented face; time grows with the triangles of the scene.
PhotonMapView view_of_map(const Scene& scene, const InspectablePhotons& photons,
                          std::uint32_t oriented_face);

}  // namespace photile::view
