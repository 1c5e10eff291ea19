#include "tools/view/snapshots.hpp"

#include <fmt/format.h>

#include <string>

#include "image/srgb.hpp"
#include "photile/camera_attributes.hpp"
#include "photile/layered_picture.hpp"

namespace photile::view {

std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension) {
  for (int number = 1;; ++number) {
    const std::filesystem::path file = folder / fmt::format("{}-{:04}{}", stem, number, extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

void write_screenshot(const std::filesystem::path& file, int width, int height,
                      std::span<const std::uint8_t> rgb) {
  Image image;
  image.width = width;
  image.height = height;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector<float>& plane = image.add(std::string(1, "RGB"[channel]));
    for (std::size_t pixel = 0; pixel < plane.size(); ++pixel) {
      plane[pixel] = static_cast<float>(image::linear_from_srgb(rgb[3 * pixel + channel] / 255.0));
    }
  }
  write_png(file, image);
}

void write_frame(const std::filesystem::path& file, const Scene& scene, const Frame& frame,
                 const LightMix& mix) {
  const auto picture = mixed_picture(frame.layers, mix);
  set_camera_attributes(picture->header(), in_world(scene, frame.camera), frame.layers.width,
                        frame.layers.height);
  write_exr(file, *picture);
}

}  // namespace photile::view
