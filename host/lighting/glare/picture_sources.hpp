// Glare sources in a fisheye picture, as evalglare finds them.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "glare/ratings.hpp"
#include "photile/defaults.hpp"

namespace photile::glare {

/// What an observer sees: a square picture of the angular projection over 180 degrees, whose middle
/// is straight ahead.
struct LuminancePicture {
  int side = 0;                  ///< pixels
  std::vector<float> luminance;  ///< cd/m2, row 0 at the top; 0 beyond the circle

  /// The part of the field of view that a pixel is, sr; 0 beyond the circle.
  double solid_angle(int x, int y) const;
  /// Unit direction through its middle in the observer's axes: right, up, forward.
  glm::dvec3 direction(int x, int y) const;
};

struct SourceSearch {
  /// Luminance of a source's pixels: above 100 cd/m2, up to 100 times the mean luminance.
  double threshold = defaults::glare_source_luminance;
  double angle = defaults::glare_source_angle;  ///< radians: pixels nearer than that are one source
  double peak = defaults::glare_peak_luminance;  ///< cd/m2: pixels above are separate sources
};

struct PictureSource {
  Source source;              ///< its position index is at most largest_position_index
  glm::dvec3 direction{0.0};  ///< unit, the observer's axes: right, up, forward
};

struct PictureGlare {
  double illuminance = 0;  ///< lux at the eye, of the whole picture
  double background = 0;   ///< cd/m2: the illuminance without the sources over pi
  std::vector<PictureSource> sources;

  std::vector<Source> plain_sources() const;
};

/// Pixels brighter than the threshold are grouped where they lie close together; a source has their
/// mean luminance and its position index at the middle of their light (Wienold and Christoffersen,
/// "Evaluation methods and development of a new glare prediction model", 2006; defaults of
/// evalglare 3).
PictureGlare find_sources(const LuminancePicture& picture, const SourceSearch& search = {});

}  // namespace photile::glare
