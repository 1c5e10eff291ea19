#include <algorithm>
#include <cmath>

#include "files/scene_files.hpp"
#include "fuzz_files.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "photile/scene_builder.hpp"
#include "photometry/photometric_file.hpp"
#include "pictures/textures.hpp"
#include "reading/camera_path.hpp"

namespace photile::test {
namespace {

/// Loads a scene as every command does: it has to be one that stages accept. Rays that search for
/// windows take half the time of scenes with a sun: inputs of one length in eight have them.
bool accepts_scene(const std::filesystem::path& file, Bytes bytes) {
  const auto load = [&] {
    SceneLoadOptions options;
    if (bytes.size() % 8 != 0) options.portals = {"off"};
    const Scene scene = load_scene(file, options);
    try {
      check_scene(scene);
    } catch (const Error& error) {
      throw std::logic_error(std::string("loaded, but no scene: ") + error.what());
    }
    for (const Camera& camera : scene.cameras) {
      require(std::isfinite(glm::length(camera.position)), "a camera is nowhere");
    }
  };
  return accepts(load, file);
}

bool accepts_resource(const auto& read) {
  try {
    read();
    return true;
  } catch (const files::ResourceError& error) {
    require(std::string(error.what()).find('\n') == std::string::npos, "two lines");
    return false;
  }
}

bool accepts_photometry(const char* name, Bytes bytes) {
  return accepts_resource([&] {
    files::Warnings warnings;
    const IntensityDistribution lamp = photometry::read_photometry(name, bytes, warnings);
    require(std::isfinite(lamp.flux()) && lamp.flux() >= 0, "a lamp without a flux");
  });
}

}  // namespace

bool fuzz_gltf(Bytes bytes) { return accepts_scene(file_of("scene.gltf", bytes), bytes); }

bool fuzz_glb(Bytes bytes) { return accepts_scene(file_of("scene.glb", bytes), bytes); }

bool fuzz_obj(Bytes bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), 0);
  const auto obj = static_cast<std::size_t>(end - bytes.begin());
  file_of("scene.mtl", bytes.subspan(std::min(obj + 1, bytes.size())));
  return accepts_scene(file_of("scene.obj", bytes.first(obj)), bytes);
}

bool fuzz_ies(Bytes bytes) { return accepts_photometry("lamp.ies", bytes); }
bool fuzz_ldt(Bytes bytes) { return accepts_photometry("lamp.ldt", bytes); }

bool fuzz_texture(Bytes bytes) {
  return accepts_resource([&] {
    const Texture texture = pictures::decode_texture("picture", bytes);
    require(texture.width() > 0 && texture.height() > 0, "a texture without texels");
  });
}

bool fuzz_radiance(Bytes bytes) {
  return accepts_resource([&] {
    const auto picture = pictures::decode_radiance("picture", bytes);
    require(picture.texels.size() ==
                static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height),
            "texels that lack");
  });
}

bool fuzz_camera_path(Bytes bytes) {
  return accepts([&] {
    const reading::CameraMotion motion =
        reading::read_camera_path(file_of("path.json", bytes), Camera{});
    for (int step = 0; step <= 4; ++step) {
      const Camera camera = motion.at(motion.begin + step * (motion.end - motion.begin) / 4);
      require(std::isfinite(glm::length(camera.position) + glm::length(camera.forward)),
              "a camera is nowhere");
    }
  });
}

}  // namespace photile::test
