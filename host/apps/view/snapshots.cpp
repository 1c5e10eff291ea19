#include "view/snapshots.hpp"

#include <fmt/format.h>

#include <string>

#include "common/files.hpp"
#include "image/display.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "writing/edited_scene.hpp"

namespace photile::view {

std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& extension) {
  for (int number = 1;; ++number) {
    const std::filesystem::path file = folder / fmt::format("{}-{:04}{}", stem, number, extension);
    if (!std::filesystem::exists(file)) return file;
  }
}

std::string keep_as(const std::filesystem::path& folder, const std::string& stem,
                    const std::string& extension,
                    const std::function<void(const std::filesystem::path&)>& write) {
  try {
    const std::filesystem::path file = free_name(folder, stem, extension);
    write(file);
    return fmt::format("{} is kept", file.filename().string());
  } catch (const Error& error) {
    return error.what();
  }
}

std::string keep_points(const std::filesystem::path& folder,
                        const std::vector<ClickedPoint>& points, const LightBoard& lights,
                        double maintenance) {
  keep_as(folder, "points", ".pts",
          [&](const std::filesystem::path& file) { write_file(file, points_text(points)); });
  return keep_as(folder, "points", ".csv", [&](const std::filesystem::path& file) {
    write_file(file, points_csv(points, lights.mix(), lights.mixdown(), maintenance));
  });
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
                 const LightMix& mix, const image::White& white) {
  const auto picture = mixed_picture(frame.layers, mix);
  set_camera_attributes(picture->header(), in_world(scene, frame.camera), frame.layers.width,
                        frame.layers.height);
  image::keep_white(picture->header(), white);
  write_exr(file, *picture);
}

std::string write_mood(const Scene& scene, const SceneLoadOptions& load, LightBoard board,
                       const Moods& moods, const std::string& mood) {
  try {
    for (LightControl& control : board.controls()) control.solo = false;
    moods.apply(mood, board);
    const writing::EditedScene copy =
        writing::write_edited_scene(scene.source, load, board.lamps_mix(), mood);
    std::string told = fmt::format("{} is written", copy.file.filename().string());
    for (const std::string& line : copy.left_out) told += "\n" + line;
    return told;
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace photile::view
