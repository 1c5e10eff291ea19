#include "image/png_output.hpp"

#include <png.h>

#include <vector>

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
