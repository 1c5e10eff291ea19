// A photon map, drawn over the picture.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "photile/camera.hpp"
#include "photile/ray_scene.hpp"
#include "view/display.hpp"
#include "view/frame.hpp"
#include "view/photon_map_view.hpp"

namespace photile::view {

/// The surfaces that the middles of pixels see, mirrors and glass themselves.
struct SeenSurfaces {
  int width = 0, height = 0;
  std::vector<std::uint32_t> sided_triangle;  ///< per pixel; none = nothing
  std::vector<double> distance;               ///< per pixel, metres from the eye; infinite
};
SeenSurfaces seen_surfaces(const RayScene& rays, const Camera& camera, int width, int height);

/// Where a film of width x height shows a point, in pixels, (0, 0) the upper left corner: the
/// inverse of Camera::direction. Nothing where it lies behind the eye.
std::optional<glm::dvec2> project(const Camera& camera, const glm::dvec3& point, int width,
                                  int height);

/// Tints the triangle red, its group blue and the rest of its patch green, and draws its photons
/// yellow and those of its group cyan where nothing hides them.
void draw_photon_map(DisplayedFrame& shown, const Camera& camera, const SeenSurfaces& seen,
                     const PhotonMapView& map);

/// Draws the photon map of a picked triangle over each frame. Until something is picked it holds
/// nothing; then a ray tracing structure of its own.
class PhotonInspector {
 public:
  explicit PhotonInspector(const Scene& scene) : scene_(scene) {}

  /// Picks what a frame shows at (x, y), shares of its width and height; nothing where that is
  /// nothing.
  void pick(const Frame& frame, double x, double y);

  /// The place on a surface that a frame shows there, in the scene's coordinates, and the unit
  /// normal of the side seen; nothing where that is nothing.
  struct Place {
    glm::dvec3 position, normal;
  };
  std::optional<Place> place_at(const Frame& frame, double x, double y);

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
