#include <new>

#include "image/picture_file.hpp"
#include "photile/errors.hpp"

namespace photile {

PictureHeader read_header(const std::filesystem::path& file) {
  return image::PictureFile(file).header();
}

Image read_image(const std::filesystem::path& file) {
  image::PictureFile source(file);
  source.check_total();
  try {
    Image image;
    static_cast<PictureHeader&>(image) = source.header();
    for (std::size_t i = 0; i < image.channel_names.size(); ++i) {
      image.channels.push_back(source.read(i, 0, image.height));
    }
    return image;
  } catch (const std::bad_alloc&) {
    throw InputError(file.string() + ": there is not enough memory to read it; scale it down");
  }
}

}  // namespace photile
