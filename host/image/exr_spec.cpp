#include "image/exr_spec.hpp"

#include <array>

namespace photile::image {

OIIO::ImageSpec exr_spec(const PictureHeader& header, const std::vector<std::string>& channels,
                         const char* compression) {
  OIIO::ImageSpec spec(header.width, header.height, static_cast<int>(channels.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames = channels;
  spec.attribute("compression", compression);
  // OpenImageIO would write the present time, and the same render would give other bytes each time.
  spec.attribute("DateTime", "");

  constexpr std::array<float, 8> rec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709.data());
  spec.attribute("colorInteropID", "lin_rec709_scene");
  return spec;
}

void add_attributes(const PictureHeader& header, OIIO::ImageSpec& spec) {
  for (const auto& [name, value] : header.attributes) spec.attribute(name, value);
  for (const auto& [name, value] : header.numbers) spec.attribute(name, value);
  for (const auto& [name, matrix] : header.matrices) {
    spec.attribute(name, OIIO::TypeDesc::TypeMatrix, matrix.data());
  }
}

}  // namespace photile::image
