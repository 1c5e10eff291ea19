// The photon map of one triangle: which photons it holds, and whose; drawn over the picture.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
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

/// The surfaces that the middles of pixels see, mirrors and glass themselves.
struct VisibleSurfaces {
  int width = 0, height = 0;
  std::vector<std::uint32_t> oriented_face;  ///< per pixel; none = nothing
  std::vector<double> distance;              ///< per pixel, metres from the eye; infinite
};
VisibleSurfaces visible_surfaces(const RayScene& rays, const Camera& camera, int width, int height);

/// Where a film of width x height shows a point, in pixels, (0, 0) the upper left corner: the
/// inverse of Camera::direction. Nothing where it lies behind the eye.
std::optional<glm::dvec2> project(const Camera& camera, const glm::dvec3& point, int width,
                                  int height);

/// Tints the triangle red, its group blue and the rest of its patch green, and draws its photons
/// yellow and those of its group cyan where nothing hides them.
void draw_photon_map(DisplayedFrame& shown, const Camera& camera, const VisibleSurfaces& seen,
                     const PhotonMapView& map);

/// Draws the photon map of a picked triangle over each frame. Until something is picked it holds
/// nothing; then it has a separate ray tracing structure.
class PhotonInspector {
 public:
  explicit PhotonInspector(const Scene& scene) : scene_(scene) {}

  /// Picks what a frame shows at (x, y), shares of its width and height; nothing where that is
  /// nothing.
  void pick(const Frame& frame, double x, double y);

  /// The place on a surface that a frame shows there, in the scene's coordinates, and the unit
  /// normal of the side seen; nothing where that is nothing.
  struct Surface {
    glm::dvec3 position, normal;
  };
  std::optional<Surface> surface_at(const Frame& frame, double x, double y);

  /// Draws what is picked, by the photons of the frame.
  void draw(const Frame& frame, DisplayedFrame& shown);

  /// What is picked, as it was last drawn; null where nothing is.
  const PhotonMapView* map() const { return map_ ? &*map_ : nullptr; }

 private:
  const RayScene& rays();

  const Scene& scene_;
  std::optional<RayScene> rays_;
  std::uint32_t picked_ = none;
  std::shared_ptr<const InspectablePhotons> photons_;  ///< that map_ is of
  std::optional<PhotonMapView> map_;
};

}  // namespace photile::view
