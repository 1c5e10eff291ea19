#include <algorithm>
#include <cmath>

#include "fuzz_files.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"

namespace photile::test {

bool fuzz_relight(Bytes bytes) {
  const std::filesystem::path file = file_of("layers.exr", bytes);
  return accepts([&] {
    const auto picture = relit_picture(file, {});
    const Image root = picture->root();
    for (const std::vector<float>& plane : root.channels) {
      require(plane.size() == root.pixels(), "pixels that lack");
      require(std::all_of(plane.begin(), plane.end(), [](float v) { return std::isfinite(v); }),
              "a pixel that is no number");
    }
  });
}

bool fuzz_picture(Bytes bytes) {
  const std::filesystem::path file = file_of("picture.png", bytes);  // its bytes say what it is
  return accepts([&] {
    check_pixels(file);
    const Image image = read_image(file);
    for (const std::vector<float>& plane : image.channels) {
      require(plane.size() == image.pixels(), "pixels that lack");
    }
  });
}

}  // namespace photile::test
