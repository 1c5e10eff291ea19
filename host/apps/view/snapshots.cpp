#include "view/snapshots.hpp"

#include <fmt/format.h>

#include "photile/errors.hpp"
#include "writing/edited_scene.hpp"

namespace photile::view {

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
    moods.apply(mood, board);
    const writing::EditedScene copy =
        writing::write_edited_scene(scene.source, load, board.mix(), mood);
    std::string told = fmt::format("{} is written", copy.file.filename().string());
    for (const std::string& line : copy.left_out) told += "\n" + line;
    return told;
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace photile::view
