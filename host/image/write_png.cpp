#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <vector>

#include "common/output_file.hpp"
#include "image/srgb.hpp"
#include "photile/image.hpp"

namespace photile {

void write_png(const std::filesystem::path& file, const Image& display_referred) {
  OutputFile output(file);
  for (const char* channel : {"R", "G", "B"}) {
    const std::vector<float>* plane = display_referred.find(channel);
    if (!plane) output.fail("the picture has no channels R, G, B");
    if (plane->empty()) output.fail("the picture has no pixels");
  }
  const std::vector<std::uint8_t> texels = image::srgb8_texels(display_referred);

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
