#include "photometry/photometric_planes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files/warnings.hpp"

namespace photile::photometry {
namespace {

/// Adds the images of the planes in a mirror at the last one.
void mirror_at_end(std::vector<MeasuredPlane>& planes) {
  const double mirror = planes.back().azimuth;
  for (std::size_t i = planes.size() - 1; i-- > 0;) {
    planes.push_back({2.0 * mirror - planes[i].azimuth, planes[i].measured});
  }
}

}  // namespace

std::vector<MeasuredPlane> planes_all_around(const std::vector<double>& azimuths) {
  const double first = azimuths.front(), last = azimuths.back(), range = last - first;
  if (azimuths.size() == 1) return {{0.0, 0}, {360.0, 0}};
  std::vector<MeasuredPlane> planes;
  double largest_step = 0;
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    planes.push_back({azimuths[i], i});
    if (i > 0) largest_step = std::max(largest_step, azimuths[i] - azimuths[i - 1]);
  }
  if (range == 90.0 && first == 0.0) {
    mirror_at_end(planes);
    mirror_at_end(planes);
  } else if (range == 180.0 && (first == 0.0 || first == 90.0)) {
    mirror_at_end(planes);
  } else if (range < 360.0 && range + 1.5 * largest_step >= 360.0) {
    planes.push_back({first + 360.0, 0});
  } else if (range != 360.0) {
    throw files::ResourceError(
        fmt::format("the horizontal angles run from {} to {} degrees; 0, 0 to 90, 0 to 180, 90 to "
                    "270 and 0 to 360 are understood",
                    first, last));
  }
  return planes;
}

}  // namespace photile::photometry
