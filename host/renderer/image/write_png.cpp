#include <cstdint>
#include <vector>

#include "common/output_file.hpp"
#include "image/png_output.hpp"
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
  image::encode_png(output, display_referred.width, display_referred.height, texels);
  output.commit();
}

}  // namespace photile
