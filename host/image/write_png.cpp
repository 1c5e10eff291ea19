#include <OpenImageIO/imageio.h>

#include <array>
#include <cstdint>

#include "image/srgb.hpp"
#include "output_file.hpp"
#include "photile/image.hpp"

namespace photile {

void write_png(const std::filesystem::path& file, const Image& display_referred) {
  OutputFile output(file);
  const std::array<const std::vector<float>*, 3> planes{
      display_referred.find("R"), display_referred.find("G"), display_referred.find("B")};
  if (!planes[0] || !planes[1] || !planes[2]) output.fail("the picture has no channels R, G, B");
  if (planes[0]->empty()) output.fail("the picture has no pixels");

  std::vector<std::uint8_t> texels(3 * planes[0]->size());
  for (std::size_t pixel = 0; pixel < planes[0]->size(); ++pixel) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      texels[3 * pixel + channel] = image::srgb8_from_linear((*planes[channel])[pixel]);
    }
  }

  OIIO::ImageSpec spec(display_referred.width, display_referred.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  const auto encoder = OIIO::ImageOutput::create("png", &output);
  if (!encoder || !encoder->open(file.string(), spec) ||
      !encoder->write_image(OIIO::TypeDesc::UINT8, texels.data()) || !encoder->close()) {
    output.fail(encoder ? encoder->geterror() : OIIO::geterror());
  }
  output.commit();
}

}  // namespace photile
