// Data sheets of luminaires and the list of parts of a report.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"

namespace photile::report {

/// What the photometric file states of the luminaire, name and value: maker, article, luminaire,
/// lamps, power with its efficacy, colour temperature, colour rendering. Nothing of what it leaves
/// out.
std::vector<std::pair<std::string, std::string>> data_rows(const IntensityDistribution& lamp);

/// cd per 1000 lm in the planes C0-C180 and C90-C270, by the degree from -180 to 180 from its aim;
/// angles are negative on the plane's other side.
std::array<std::vector<double>, 2> intensities_of(const IntensityDistribution& lamp);

/// Luminaires of one photometric file.
struct Part {
  const IntensityDistribution* lamp;
  std::size_t count = 0;
  double lumens = 0;  ///< of all, at the powers of a mix
  double watts = 0;   ///< of all at those powers; 0 = the file does not state any
};

/// In the order of the scene's lights. Watts are in proportion to lumens, so that dimmed luminaires
/// take less.
///   lumens   of each of the scene's lights
std::vector<Part> parts_of(const Scene& scene, const std::vector<double>& lumens);

}  // namespace photile::report
