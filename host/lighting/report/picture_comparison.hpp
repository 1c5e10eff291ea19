// Two pictures, beside one another and layer by layer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photile/image.hpp"
#include "photile/layered_picture.hpp"

namespace photile::report {

/// One picture against another, or one layer of both.
struct ComparedPart {
  std::string light;  ///< "" for the whole picture
  /// The error of a against b; none where b is black.
  std::optional<PictureError> error;
};

/// How bright two pictures are, of the pixels that see a surface.
struct ComparedLevel {
  std::string what;  ///< "luminance, mean"
  std::string unit;  ///< "cd/m2", "lux"
  double a = 0, b = 0;
};

/// A light's power in both.
struct ComparedPower {
  std::string light;
  double a = 0, b = 0;
  PowerUnit unit = PowerUnit::lumen;
};

/// Two states of the lamps in one view.
struct LevelComparison {
  std::vector<ComparedLevel> levels;
  std::vector<ComparedPower> powers;
};

/// Levels of luminance, and of illuminance where both pictures know it: mean, median and the 95th
/// percentile over the pixels.
///   header_a, header_b   of the whole pictures, with the names of their channels
/// Errors: UsageError where sizes differ; InputError where a picture does not say how many cd/m2
/// its values are.
LevelComparison compare_levels(const LayeredPicture& a, const LayeredPicture& b,
                               const PictureHeader& header_a, const PictureHeader& header_b);

/// Whether the lights of two pictures have other powers or colours: then the pictures are states of
/// one room, and no error of one against the other.
bool lights_differ(const PictureHeader& a, const PictureHeader& b);

struct PictureComparison {
  std::vector<ComparedPart> parts;  ///< the whole picture first
  std::vector<std::string> only_a;  ///< lights whose layer the other lacks
  std::vector<std::string> only_b;
};

/// Compares R, G, B and the layers that both have, each light at its power there. Errors:
/// UsageError where sizes differ or a picture lacks R, G, B; InputError where b is black as a
/// whole.
PictureComparison compare_pictures(const Image& a, const Image& b);

/// How a comparison is drawn.
struct ComparisonDrawing {
  std::string name_a, name_b;
  std::string unit;  ///< of the difference
  double scale = 0;  ///< largest difference of the legend; 0 = the 99th percentile where no lamp is
                     ///< seen, rounded up to 1, 2 or 5 times a power of ten
  ToneMapping tone_mapping = {};  ///< of both together
};

/// Both pictures with one exposure, and the difference of their luminances in false colour with its
/// legend, side by side; display-referred as write_png takes it. Names are drawn where the font
/// DejaVu Sans is installed. Errors: as above.
Image draw_comparison(const Image& a, const Image& b, const ComparisonDrawing& options);

}  // namespace photile::report
