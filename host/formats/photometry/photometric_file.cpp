#include "photometry/photometric_file.hpp"

#include <fmt/format.h>

#include <string_view>

#include "common/ascii_text.hpp"
#include "photometry/eulumdat_reader.hpp"
#include "photometry/ies_reader.hpp"
#include "files/warnings.hpp"
#include "photile/limits.hpp"

namespace photile::scene_io {

IntensityDistribution read_photometry(const std::string& name, std::span<const unsigned char> bytes,
                                      Warnings& warnings) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    if (bytes.size() > limits::max_photometry_bytes) {
      throw ResourceError(
          fmt::format("{} bytes; the limit is {}", bytes.size(), limits::max_photometry_bytes));
    }
    IntensityDistribution distribution = ends_in(name, ".ldt") ? read_eulumdat(name, text, warnings)
                                                               : read_ies(name, text, warnings);
    if (!(distribution.flux() > 0.0)) throw ResourceError("all intensities are 0");
    return distribution;
  } catch (const ResourceError& error) {
    throw ResourceError(fmt::format(
        "photometric file '{}': {}; get it again from the maker of the lamp", name, error.what()));
  }
}

}  // namespace photile::scene_io
