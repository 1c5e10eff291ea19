#include "random_scene.hpp"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "file_bytes.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

/// Mostly of this size, rarely zero, negative, tiny or huge.
double power(RandomScene& scene, Dice& dice) {
  if (!dice.chance(0.02)) return dice.size_between(0.01, 1e4);
  scene.sound = false;
  return dice.one_of(std::vector<double>{0, -1, 1e-30, 1e20, 1e29, 1e39});
}

std::string colour(Dice& dice, double least = 0, double most = 1) {
  return fmt::format("{:.3f} {:.3f} {:.3f}", dice.between(least, most), dice.between(least, most),
                     dice.between(least, most));
}

/// A rectangle in the plane y = height, facing down or up.
std::string rectangle(Dice& dice, double size, double height, bool down, int& vertices) {
  const double x = dice.between(-0.7, 0.4) * size, z = dice.between(-0.7, 0.4) * size,
               dx = dice.between(0.02, 0.5) * size, dz = dice.between(0.02, 0.5) * size;
  std::string text, face;
  for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    text += fmt::format("v {} {} {}\nvt {} {}\n", x + u * dx, height, z + v * dz, u, v);
    ++vertices;
    const std::string corner = fmt::format(" {}/{}", vertices, vertices - 8);  // the room has no vt
    face = down ? face + corner : corner + face;
  }
  return text + "f" + face + "\n";
}

std::string material(Dice& dice, const std::string& name, bool textured) {
  std::string text = fmt::format("newmtl {}\nKd {}\n", name, colour(dice));
  switch (dice.whole(0, 8)) {
    case 0:
      text += fmt::format("illum 2\nKs {}\nNs {}\n", colour(dice), dice.whole(0, 2000));
      if (textured && dice.chance(0.5)) text += "norm picture.png\n";
      break;
    case 1:
      text += fmt::format("illum 3\nKs {}\n", colour(dice));
      break;
    case 2:
      text += fmt::format("illum 7\nNi {:.2f}\nd 0.1\nTf {}\n", dice.between(0.5, 3), colour(dice));
      break;
    case 3:
      if (textured) text += "map_Kd picture.png\n";
      break;
    case 4:
      if (textured) text += "norm picture.png\n";
      break;
    case 5:
      if (textured) text += "map_d picture.png\n";
      break;
    default:
      break;
  }
  return text;
}

void write_picture(const std::filesystem::path& file, Dice& dice) {
  Image picture;
  picture.width = dice.whole(1, 8);
  picture.height = dice.whole(1, 8);
  for (const char* channel : {"R", "G", "B"}) {
    for (float& value : picture.add(channel)) value = static_cast<float>(dice.unit());
  }
  write_png(file, picture);
}

/// A box with its normals inwards.
std::string room(double size) {
  std::string text;
  for (int corner = 0; corner < 8; ++corner) {
    text += fmt::format("v {} {} {}\n", corner & 1 ? size : -size, corner & 2 ? size : -size,
                        corner & 4 ? size : -size);
  }
  return text +
         "o room\nusemtl wall\nf 1 2 4 3\nf 5 7 8 6\nf 1 3 7 5\nf 2 6 8 4\nf 3 4 8 7\nf 1 5 6 2\n";
}

RandomScene write_obj(const std::filesystem::path& folder, Dice& dice) {
  RandomScene scene;
  scene.size = dice.chance(0.1) ? dice.size_between(1e-6, 1e6) : dice.between(0.5, 5);
  scene.sound = scene.size >= 0.5 && scene.size <= 5;
  const int lamps = dice.chance(0.03) ? 0 : dice.whole(1, 4), things = dice.whole(0, 3);
  std::string obj = "mtllib scene.mtl\n" + room(scene.size), mtl;
  int vertices = 8;
  mtl += material(dice, "wall", false);
  scene.opaque_room =
      mtl.find("illum 7") == std::string::npos && mtl.find("illum 3") == std::string::npos;
  for (int lamp = 0; lamp < lamps; ++lamp) {
    const std::string name = fmt::format("lamp {}", lamp);
    mtl += fmt::format("newmtl glow{}\nKd 0 0 0\nKe {:g} {:g} {:g}\n", lamp, power(scene, dice),
                       power(scene, dice), power(scene, dice));
    if (dice.chance(0.2)) mtl += "map_Ke picture.png\n";
    obj += fmt::format("o {}\nusemtl glow{}\n", name, lamp);
    obj += rectangle(dice, scene.size, (0.99 - 0.01 * lamp) * scene.size, true, vertices);
    scene.lights.push_back(fmt::format("lamp_{}", lamp));  // as layers are named
  }
  for (int thing = 0; thing < things; ++thing) {
    mtl += material(dice, fmt::format("stuff{}", thing), true);
    obj += fmt::format("o thing{}\nusemtl stuff{}\n", thing, thing);
    obj += rectangle(dice, scene.size, dice.between(-0.9, 0.9) * scene.size, dice.chance(0.5),
                     vertices);
  }
  write_picture(folder / "picture.png", dice);
  scene.file = put(folder / "scene.obj", obj);
  scene.inputs = {scene.file, put(folder / "scene.mtl", mtl), folder / "picture.png"};
  return scene;
}

/// A floor and a wall below punctual lights and a luminous panel.
RandomScene write_gltf(const std::filesystem::path& folder, Dice& dice) {
  RandomScene scene;
  scene.size = dice.between(0.5, 5);
  const auto s = static_cast<float>(scene.size);
  const std::vector<float> corners{-s, 0, -s, -s, 0, s, s, 0, s, s, 0, -s, -s, s, -s, s, s, -s};
  std::string bytes(corners.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), corners.data(), bytes.size());
  const std::vector<std::uint16_t> indices{0, 1, 2, 0, 2, 3, 0, 3, 5, 0, 5, 4};
  bytes.append(reinterpret_cast<const char*>(indices.data()), indices.size() * sizeof indices[0]);
  json document = json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "floor", "mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3"},
                  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
    "bufferViews": [{"buffer": 0, "byteLength": 72},
                    {"buffer": 0, "byteOffset": 72, "byteLength": 24}],
    "buffers": [{"uri": "scene.bin", "byteLength": 96}],
    "materials": [{}]})");
  json& material = document["materials"][0];
  material["pbrMetallicRoughness"] = {
      {"baseColorFactor", {dice.unit(), dice.unit(), dice.unit(), 1}},
      {"metallicFactor", dice.chance(0.5) ? 0.0 : dice.unit()},
      {"roughnessFactor", dice.unit()}};
  if (dice.chance(0.2)) material["doubleSided"] = true;
  json lights = json::array();
  const int count = dice.whole(0, 3);
  for (int light = 0; light < count; ++light) {
    const std::string name = fmt::format("bulb {}", light);
    json entry{{"name", name},
               {"type", dice.one_of({"point", "spot", "directional"})},
               {"intensity", power(scene, dice)}};
    if (entry["type"] == "spot") {
      entry["spot"] = {{"innerConeAngle", dice.between(0, 0.4)}, {"outerConeAngle", 0.5}};
    }
    lights.push_back(entry);
    document["nodes"].push_back(
        {{"name", name},
         {"translation", {dice.between(-s, s), dice.between(0.1, s), dice.between(-s, s)}},
         {"rotation", {-0.7071, 0, 0, 0.7071}},
         {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    document["scenes"][0]["nodes"].push_back(light + 1);
    scene.lights.push_back(fmt::format("bulb_{}", light));
  }
  if (count > 0) {
    document["extensionsUsed"] = {"KHR_lights_punctual"};
    document["extensions"]["KHR_lights_punctual"]["lights"] = lights;
  }
  if (count == 0 || dice.chance(0.3)) {
    document["nodes"].push_back(
        {{"name", "panel"},
         {"translation", {0, 0.9 * s, 0}},
         {"rotation", {-0.7071, 0, 0, 0.7071}},
         {"extras",
          {{"photile_area", {0.3 * s, 0.2 * s}}, {"photile_lumens", dice.size_between(1, 1e4)}}}});
    document["scenes"][0]["nodes"].push_back(document["nodes"].size() - 1);
    scene.lights.emplace_back("panel");
  }
  if (dice.chance(0.3)) {
    document["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.01}}}}};
    document["nodes"].push_back(
        {{"name", "eye"}, {"camera", 0}, {"translation", {0, 0.5 * s, 0.9 * s}}});
    document["scenes"][0]["nodes"].push_back(document["nodes"].size() - 1);
  }
  scene.file = put(folder / "scene.gltf", document.dump());
  scene.inputs = {scene.file, put(folder / "scene.bin", bytes)};
  return scene;
}

/// A byte of one of its files replaced, or the end cut off.
void damage(const RandomScene& scene, Dice& dice) {
  const std::filesystem::path& file = dice.one_of(scene.inputs);
  std::string bytes = bytes_of(file);
  const auto place = static_cast<std::size_t>(dice.whole(0, static_cast<int>(bytes.size()) - 1));
  if (dice.chance(0.3)) {
    bytes.resize(place);
  } else {
    bytes[place] = static_cast<char>(dice.whole(0, 255));
  }
  put(file, bytes);
}

}  // namespace

RandomScene write_random_scene(const std::filesystem::path& folder, Dice& dice) {
  RandomScene scene = dice.chance(0.6) ? write_obj(folder, dice) : write_gltf(folder, dice);
  if (dice.chance(0.08)) {
    damage(scene, dice);
    scene.sound = false;
  }
  scene.sound = scene.sound && !scene.lights.empty();
  return scene;
}

}  // namespace photile::test
