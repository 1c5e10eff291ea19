#include "image/png_output.hpp"

#include <png.h>

#include <cstdint>
#include <vector>

#include "common/output_file.hpp"
#include "image/srgb.hpp"
#include "photile/image.hpp"

namespace photile::image {

void encode_png(OutputFile& output, int width, int height, std::span<const std::uint8_t> texels) {
  png_image picture{};
  picture.version = PNG_IMAGE_VERSION;
  picture.width = static_cast<png_uint_32>(width);
  picture.height = static_cast<png_uint_32>(height);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  picture.format = texels.size() == 4 * pixels ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(picture);
  std::vector<std::uint8_t> encoded(size);
  if (png_image_write_to_memory(&picture, encoded.data(), &size, 0, texels.data(), 0, nullptr) ==
      0) {
    output.fail(picture.message);
  }
  output.write(encoded.data(), size);
}

}  // namespace photile::image

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
