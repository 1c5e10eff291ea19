// Luminaires as their luminous openings, as an observer sees them.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "glare/ratings.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/ray_scene.hpp"
#include "trace/surface.hpp"

namespace photile::glare {

/// The visible part of a luminaire, also through panes of thin glass.
struct VisibleLuminaire {
  std::string name;
  double luminance = 0;       ///< cd/m2, mean over what is seen
  double solid_angle = 0;     ///< sr
  double position_index = 1;  ///< such that omega / p^2 is the integral of 1 / p^2 over it
  double projected_area = 0;  ///< m2, onto a plane that faces the eye
  double illuminance = 0;     ///< lux at the eye, on a plane that faces forward
  glm::dvec3 direction{0.0};  ///< unit, to the middle of what is seen

  /// The source as the UGR counts it, with the correction for small sources.
  Source source() const {
    return as_small_source({luminance, solid_angle, position_index}, projected_area);
  }
};

class Luminaires {
 public:
  /// Each connected part of an area light is a separate luminaire, and so is each lamp of a
  /// photometric file, spot or point light. Where a file gives intensities, it gives the opening,
  /// too, unless the area light has another size: then that is its opening, flat. A lamp without
  /// any counts as the least source. Light from beyond the scene comes from no luminaire. The rays
  /// are kept.
  ///   samples   of a luminaire, spread over its area
  Luminaires(const RayScene& rays, int samples);

  /// The luminaires in front of an observer that emit light, in the order of the scene.
  ///   mix   of the scene
  std::vector<VisibleLuminaire> seen_by(const Observer& observer, const LightMix& mix) const;

  /// m2 of openings larger than large_source_area, as they would be seen from straight below.
  ///   up   unit
  double large_area(const glm::dvec3& up) const;

 private:
  /// A small part of an opening.
  struct Patch {
    trace::SurfacePoint point;  ///< on the side that shines
    float area;                 ///< m2; of a lamp without surface, 1
  };
  struct Luminaire {
    std::string name;
    std::uint32_t light;
    glm::vec3 radiance;  ///< of white texels, its layer at power 1
    std::vector<Patch> patches;
    /// Of a lamp, which has intensities in place of radiance.
    std::optional<LuminousOpening> opening;
  };

  void add_area_light(std::uint32_t light, const glm::vec3& radiance, int samples);
  /// A patch as it shows towards an eye; without candela it is not seen.
  struct PatchSeen {
    double area = 0, candela = 0;  ///< m2, projected
  };
  VisibleLuminaire seen_in_parts(
      const Luminaire& luminaire, const Observer& observer, const glm::dvec3& eye,
      const std::function<PatchSeen(const Patch&, const glm::dvec3& direction)>& of_patch) const;
  VisibleLuminaire surface_seen(const Luminaire& luminaire, const Observer& observer,
                                const glm::dvec3& eye, const glm::dvec3& power) const;
  VisibleLuminaire lamp_seen(const Luminaire& luminaire, const Observer& observer,
                             const glm::dvec3& eye, const glm::dvec3& power) const;

  const RayScene& rays_;
  LightGroups groups_;
  std::vector<Luminaire> luminaires_;
};

}  // namespace photile::glare
