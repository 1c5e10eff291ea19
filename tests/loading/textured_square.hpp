// The square of scene_files.hpp under textures of one texel.
#pragma once

#include <cstdint>
#include <functional>

#include "oiio_pictures.hpp"
#include "photile/load_scene.hpp"
#include "scene_files.hpp"
#include "trace/surface.hpp"

namespace photile::test {

/// A picture of bytes or floats whose colours are not multiplied by alpha, perhaps with a colour
/// space (which a PNG keeps as its gAMA). Its file.
template <typename T>
std::filesystem::path write_picture(const std::filesystem::path& file, int width, int height,
                                    int channels, const std::vector<T>& pixels,
                                    const std::string& color_space = "") {
  OIIO::ImageSpec spec(width, height, channels, OIIO::BaseTypeFromC<T>::value);
  spec["oiio:UnassociatedAlpha"] = 1;
  if (!color_space.empty()) spec["oiio:ColorSpace"] = color_space;
  write_by_oiio(file, spec, pixels);
  return file;
}

/// A picture of `side` x `side` equal texels of 1 to 4 bytes.
inline void write_texel(const std::filesystem::path& file, const std::vector<std::uint8_t>& texel,
                        int side = 1) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < side * side; ++i) pixels.insert(pixels.end(), texel.begin(), texel.end());
  write_picture(file, side, side, static_cast<int>(texel.size()), pixels);
}

/// The square with a lamp beside it, so that its material need not shine; its pictures are one
/// texel each: textures 0, 1, 2 ...
inline Scene square_with(const std::vector<std::vector<std::uint8_t>>& texels,
                         const std::function<void(nlohmann::json& material)>& change) {
  const SceneFolderOnDisk folder;
  nlohmann::json document = square_document();
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const std::string name = "t" + std::to_string(i) + ".png";
    write_texel(folder.path / name, texels[i]);
    document["images"].push_back({{"uri", name}});
    document["textures"].push_back({{"source", i}});
  }
  nlohmann::json& material = document["materials"][0];
  material["emissiveFactor"] = {0, 0, 0};
  change(material);
  document["extensionsUsed"] = {"KHR_lights_punctual"};
  document["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 10}}};
  document["nodes"].push_back(
      {{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  document["scenes"][0]["nodes"] = {0, 1};
  folder.write("square.bin", square_buffer());
  return load_scene(folder.write("scene.gltf", document.dump()));
}

inline trace::SurfacePoint middle(const Scene& scene) {
  return trace::surface_hit(scene, {0, 0.3f, 0.3f}, {0, 0, -1});
}

}  // namespace photile::test
