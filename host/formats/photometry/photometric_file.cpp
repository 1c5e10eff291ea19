#include "photometry/photometric_file.hpp"

#include <fmt/format.h>

#include <string_view>

#include "common/ascii_text.hpp"
#include "files/warnings.hpp"
#include "photile/limits.hpp"
#include "photometry/eulumdat_reader.hpp"
#include "photometry/ies_reader.hpp"

namespace photile::photometry {

IntensityDistribution read_photometry(const std::string& name, std::span<const unsigned char> bytes,
                                      files::Warnings& warnings) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  try {
    if (bytes.size() > limits::max_photometry_bytes) {
      throw files::ResourceError(
          fmt::format("{} bytes; the limit is {}", bytes.size(), limits::max_photometry_bytes));
    }
    IntensityDistribution distribution = ends_in(name, ".ldt") ? read_eulumdat(name, text, warnings)
                                                               : read_ies(name, text, warnings);
    if (!(distribution.flux() > 0.0)) throw files::ResourceError("all intensities are 0");
    return distribution;
  } catch (const files::ResourceError& error) {
    throw files::ResourceError(fmt::format(
        "photometric file '{}': {}; get it again from the maker of the lamp", name, error.what()));
  }
}

}  // namespace photile::photometry
