// Pictures of unusual scenes.

#include "garbage.hpp"
#include "instanced_scenes.hpp"
#include "loading/scene_files.hpp"
#include "pictures.hpp"
#include "shared_scenes.hpp"
#include "skipped.hpp"
#include "suns.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

// Whole pictures at extremes of size and place (docs/reference/limits.md).

RenderParameters one_pass_picture() {
  RenderParameters parameters = small_picture(40'000, 64, 48);
  parameters.passes = 1;
  return parameters;
}

const std::string room_materials =
    "newmtl lamp\nKd 0 0 0\nKe 20 20 20\nnewmtl white\nKd 0.7 0.7 0.7\nnewmtl red\nKd 0.6 0.1 "
    "0.1\n";

/// A room of 4 x 2.5 x 3 m (y is up) with a lamp below the ceiling and a block, its corner moved to
/// `offset`.
std::string room_text(const glm::dvec3& offset) {
  std::string text;
  int corners = 0;
  const auto quad = [&](const glm::dvec3& a, const glm::dvec3& u, const glm::dvec3& v,
                        const std::string& material) {
    text += "usemtl " + material + "\n";
    for (const glm::dvec3& p : {a, a + u, a + u + v, a + v}) {
      text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x + offset.x, p.y + offset.y,
                          p.z + offset.z);
    }
    text += fmt::format("f {} {} {} {}\n", corners + 1, corners + 2, corners + 3, corners + 4);
    corners += 4;
  };
  const glm::dvec3 x(4, 0, 0), y(0, 2.5, 0), z(0, 0, 3), zero(0);
  quad(zero, z, x, "white");
  quad(y, x, z, "white");
  quad(zero, y, z, "red");
  quad(x, z, y, "white");
  quad(zero, x, y, "white");
  quad(z, y, x, "white");
  quad({1.5, 2.4, 1}, {1, 0, 0}, {0, 0, 1}, "lamp");
  const glm::dvec3 base(0.9, 0, 0.7), bx(0.8, 0, 0.3), bz(-0.3, 0, 0.8), by(0, 0.9, 0);
  quad(base + by, bz, bx, "white");
  quad(base, by, bx, "white");
  quad(base + bz, bx, by, "white");
  quad(base, bz, by, "white");
  quad(base + bx, by, bz, "white");
  return text;
}

/// The camera of the room, in the scene's coordinates.
Camera camera_at(const Scene& scene, const glm::dvec3& offset) {
  const glm::dvec3 corner = offset - scene.origin;
  return Camera::look_at(corner + glm::dvec3(3.8, 1.6, 2.8), corner + glm::dvec3(1, 0.9, 0.8),
                         {0, 1, 0}, 1.1);
}

/// What moving a scene may change: coordinates round otherwise, and rays start from other
/// clearances. Distances of photons then differ by 1e-5 of them, and a photon in some thousands
/// passes an edge on the other side.
struct Difference {
  double mean;   ///< relative, of the whole picture
  double apart;  ///< share of pixels that differ by more than 1e-3
};

Difference compare(const LightLayers& a, const LightLayers& b) {
  double sum_a = 0, sum_b = 0;
  std::size_t apart = 0, pixels = 0;
  for (std::size_t light = 0; light < a.layers.size(); ++light) {
    const auto &first = a.layers[light].radiance, &second = b.layers[light].radiance;
    for (std::size_t i = 0; i < first.size(); ++i, ++pixels) {
      sum_a += luminance(glm::dvec3(first[i]));
      sum_b += luminance(glm::dvec3(second[i]));
      apart += glm::distance(first[i], second[i]) > 1e-3f * glm::length(second[i]);
    }
  }
  return {std::abs(sum_a / sum_b - 1), static_cast<double>(apart) / static_cast<double>(pixels)};
}

/// Two meshes, of eight corners and of many; a node above all others.
const std::string gltf_text = R"({
  "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 100}]}},
  "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [
    {"children": [1, 2, 3, 4, 5]},
    {"mesh": 0},
    {"mesh": 1, "translation": [1, 0.6, 1]},
    {"mesh": 1, "translation": [2.4, 0.5, 1.4], "rotation": [0, 0.6, 0, 0.8]},
    {"mesh": 1, "translation": [1.2, 1.7, 1.6], "scale": [0.5, 0.5, 0.5]},
    {"translation": [2, 2.1, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.7, 0.7, 1],
                                          "metallicFactor": 0, "roughnessFactor": 1},
                 "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]},
             {"primitives": [{"attributes": {"POSITION": 2}, "indices": 3, "material": 0}]}],
  "accessors": [{"componentType": 5126, "type": "VEC3"}, {"componentType": 5125, "type": "SCALAR"},
                {"componentType": 5126, "type": "VEC3"}, {"componentType": 5125, "type": "SCALAR"}],
  "bufferViews": [], "buffers": [{"uri": "room.bin"}]})";

/// A room of glTF with dented balls as instances, all of it below a node at `offset`.
Scene gltf_room(const glm::dvec3& offset) {
  const SharedMesh ball = dented_ball(66);
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  for (const glm::vec3& v : ball.vertices) positions.insert(positions.end(), {v.x, v.y, v.z});
  for (const glm::uvec3& t : ball.triangles) indices.insert(indices.end(), {t.x, t.y, t.z});
  const std::vector<float> box = {0, 0, 0, 4, 0, 0, 4, 2.5f, 0, 0, 2.5f, 0,
                                  0, 0, 3, 4, 0, 3, 4, 2.5f, 3, 0, 2.5f, 3};
  const std::vector<std::uint32_t> box_indices = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6,
                                                  0, 4, 5, 0, 5, 1, 3, 2, 6, 3, 6, 7,
                                                  0, 3, 7, 0, 7, 4, 1, 5, 6, 1, 6, 2};
  const std::vector<std::string> parts = {bytes_of(box), bytes_of(box_indices), bytes_of(positions),
                                          bytes_of(indices)};
  const std::vector<std::size_t> counts = {8, box_indices.size(), ball.vertices.size(),
                                           indices.size()};
  json document = json::parse(gltf_text);
  std::string buffer;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const json view = {
        {"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", parts[i].size()}};
    document["bufferViews"].push_back(view);
    document["accessors"][i]["bufferView"] = i;
    document["accessors"][i]["count"] = counts[i];
    buffer += parts[i];
  }
  document["buffers"][0]["byteLength"] = buffer.size();
  document["nodes"][0]["translation"] = {offset.x, offset.y, offset.z};
  const SceneFolderOnDisk folder;
  folder.write("room.bin", buffer);
  return load_scene(folder.write("room.gltf", document.dump()));
}

/// With light maps a photon more or less changes all pixels beside a node. Of 1,600 to an estimate
/// one weighs less than the 1e-3 by which pixels count as apart, and of 2.6 million those that
/// rounding moves change the mean of the picture by a tenth of 1e-4: with an eighth of them it
/// differs by 1.2e-4, however many samples there are.
LightLayers picture_of(const Scene& scene, const glm::dvec3& offset, LightMapMode light_maps) {
  RenderParameters parameters = one_pass_picture();
  parameters.film.samples_per_pixel = 8;  // rounding moves single samples across edges
  parameters.light_maps = light_maps;
  if (light_maps == LightMapMode::on) {
    parameters.photons.emitted_photons *= 64;
    parameters.neighbours *= 32;
  }
  return render(scene, camera_at(scene, offset), device(), parameters).layers;
}

TEST_CASE("extremes: a thousand kilometres off, files give the picture of a scene at the origin") {
  const bool is_obj = GENERATE(true, false);
  const LightMapMode light_maps = GENERATE(LightMapMode::off, LightMapMode::on);
  const auto scene_at = [&](const glm::dvec3& offset) {
    return is_obj ? load_obj(room_text(offset), room_materials) : gltf_room(offset);
  };
  const Scene at_origin = scene_at(glm::dvec3(0));
  REQUIRE(at_origin.instances.size() == (is_obj ? 0u : 3u));
  const LightLayers expected = picture_of(at_origin, glm::dvec3(0), light_maps);
  const auto difference_at = [&](const glm::dvec3& offset) {
    const Scene scene = scene_at(offset);
    REQUIRE(scene.triangle_count() == at_origin.triangle_count());
    REQUIRE(scene.instances.size() == at_origin.instances.size());
    return compare(picture_of(scene, offset, light_maps), expected);
  };
  // By a step that floats can follow: what a change of rounding does.
  const Difference step = difference_at({1.3, -2.1, 0.7});
  REQUIRE(step.mean < 1e-4);
  // Else the comparison could not see a picture that went wrong.
  REQUIRE(step.apart < 0.1);
  for (const glm::dvec3& offset :
       {glm::dvec3(1e6, -1e6, 123'456.7), glm::dvec3(691'607.3, 519.1, -5'334'760.7)}) {
    const Difference difference = difference_at(offset);
    CAPTURE(is_obj, name_of(light_maps), difference.mean, difference.apart, step.apart);
    CHECK(difference.mean < 1e-4);
    CHECK(difference.apart < 1.5 * step.apart);
  }
}

TEST_CASE("extremes: a room a million times larger or smaller gives the same picture, scaled") {
  const auto scaled_room = [](float factor, LightMapMode light_maps) {
    Scene scene = furnished_room(2);
    for (glm::vec3& vertex : scene.vertices) vertex *= factor;
    for (Light& light : scene.lights) light.position *= factor;
    Camera camera = room_camera();
    camera.position *= factor;
    RenderParameters parameters = one_pass_picture();
    parameters.light_maps = light_maps;
    RenderResult result = render(scene, camera, device(), parameters);
    for (auto& layer : result.layers.layers) {
      for (glm::vec3& radiance : layer.radiance) radiance *= factor * factor;
    }
    result.used.radius /= factor;
    return result;
  };
  const auto check = [&](LightMapMode light_maps, float factor, const RenderResult& expected) {
    const RenderResult result = scaled_room(factor, light_maps);
    const Difference difference = compare(result.layers, expected.layers);
    CAPTURE(factor, difference.mean, difference.apart);
    CHECK(result.used.radius == Approx(expected.used.radius).epsilon(1e-4));
    CHECK(difference.mean < 1e-4);
    CHECK(difference.apart < 0.01);
  };
  const RenderResult at_hits = scaled_room(1.0f, LightMapMode::off);
  for (const float factor : {0x1p-20f, 1e-6f, 1e6f, 0x1p20f}) {
    check(LightMapMode::off, factor, at_hits);
  }
  const RenderResult between_nodes = scaled_room(1.0f, LightMapMode::on);
  for (const float factor : {0x1p-20f, 0x1p20f}) check(LightMapMode::on, factor, between_nodes);
  // Nodes lie in steps of two of 4 cm apart: with other factors the same photons are read at other
  // nodes, and only the picture's light stays.
  for (const float factor : {1e-6f, 1e6f}) {
    const RenderResult result = scaled_room(factor, LightMapMode::on);
    CAPTURE(factor);
    CHECK(result.used.radius == Approx(between_nodes.used.radius).epsilon(1e-4));
    CHECK(compare(result.layers, between_nodes.layers).mean < 1e-3);
  }
}

TEST_CASE("extremes: a lamp of a millimetre in a hall of 1e5 m lights it as theory says") {
  // A Lambertian lamp under the ceiling's height that faces down: half of its flux falls within 45
  // degrees of its nadir. The walls are black, so every path ends where it lands.
  const double side = 1e5, height = 4e4;
  std::string text = "usemtl wall\n";
  const auto vertex = [&](double x, double y, double z) {
    text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", x, y, z);
  };
  for (const double z : {0.0, side}) {
    vertex(0, 0, z), vertex(side, 0, z), vertex(side, side, z), vertex(0, side, z);
  }
  text += "f 1 2 3 4\nf 8 7 6 5\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\nusemtl lamp\n";
  const double x = 48'765.4321, y = 51'234.5678, half = 0.5e-3;
  vertex(x - half, y - half, height), vertex(x - half, y + half, height);
  vertex(x + half, y + half, height), vertex(x + half, y - half, height);
  text += "f 9 10 11 12\n";
  const Scene scene =
      load_obj(text, "newmtl lamp\nKd 0 0 0\nKe 1e6 1e6 1e6\nnewmtl wall\nKd 0 0 0\n");
  REQUIRE(scene.triangle_count() == 14);
  const RayScene rays(scene);
  const std::vector<double> within = of_seeds([&](std::uint64_t seed) {
    const PhotonTracerResult traced =
        trace_photons(rays, {.emitted_photons = 20'000, .seed = seed});
    CHECK(traced.escaped_flux_per_light[0] < 1e-3);
    double flux = 0;
    for (std::size_t i = 0; i < traced.photons.size(); ++i) {
      const glm::dvec3 at = scene.origin + glm::dvec3(traced.photons.position[i]);
      const bool near = at.z < 1 && std::hypot(at.x - x, at.y - y) < height;
      if (near) flux += luminance(glm::dvec3(traced.photons.flux[i]));
    }
    return flux;
  });
  CHECK_VERDICT(mean_is(within, 0.5, 0.02));
}

TEST_CASE(
    "a room and a triangle as far away as the sun: an error says why there is no automatic "
    "radius") {
  const std::string room =
      "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\n"
      "usemtl wall\nf 1 4 3 2\nusemtl lamp\nf 5 6 7 8\n";
  const std::string far = "v 9e11 0 0\nv 9e11 1e10 0\nv 9e11 0 1e10\nusemtl wall\nf 9 10 11\n";
  RenderParameters parameters = one_pass_picture();
  parameters.photons.emitted_photons = 2'000;
  parameters.film.width = parameters.film.height = 8;
  const auto error_of = [&](const std::string& obj) {
    try {
      const Scene scene = load_obj(obj, lamp_and_wall);
      render(scene, scene.cameras.front(), device(), parameters);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(error_of(room).empty());
  CHECK_THAT(error_of(room + far),
             Catch::Contains("automatic radius") && Catch::Contains("distant objects"));
}

TEST_CASE("garbage OBJ files that load are rendered to numbers, or refused in a line") {
  RenderParameters parameters = one_pass_picture();
  parameters.photons.emitted_photons = 500;
  parameters.film.width = 16;
  parameters.film.height = 12;
  int rendered = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    try {
      const Scene scene = load_obj(garbage_obj(seed), lamp_and_wall);
      // Half of them with a radius that fits nothing.
      parameters.radius = seed % 4 < 2 ? 0 : std::pow(10.0, static_cast<int>(seed % 40) - 20);
      const LightLayers layers = render(scene, scene.cameras.front(), device(), parameters).layers;
      ++rendered;
      for (const auto& layer : layers.layers) {
        for (const glm::vec3& radiance : layer.radiance)
          REQUIRE_FALSE(glm::any(glm::isnan(radiance)));
      }
    } catch (const Error& error) {
      REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
  CHECK(rendered >= 50);
}

// Figures 1 and 2 of the paper: without neighbour groups, edges between triangles are dark.

/// Mean illuminance of the pixels on the diagonal of a square plate lit by a far lamp, over that of
/// the whole picture's middle.
double diagonal_over_middle(MapMode mode) {
  // Two triangles that meet along the diagonal.
  Scene scene = plate(diffuse(0.5f), 2.0f, 1);
  scene.lights.push_back(sun_along({0, 0, -1}));
  // The camera sees the inner 1 x 1 m.
  const Camera camera =
      Camera::look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(0.5 / 2.0));
  RenderParameters parameters;
  parameters.photons.emitted_photons = 400'000;
  parameters.maps = mode;
  constexpr int side = 100;
  parameters.film.width = parameters.film.height = side;
  const auto layers = render(scene, camera, device(), parameters).layers;
  const std::vector<float>& illuminance = layers.layers[0].illuminance;
  double diagonal = 0, middle = 0;
  int middle_count = 0;
  for (int y = 0; y < side; ++y) {
    // The plate's diagonal runs from (-1, -1) to (1, 1): upwards to the right.
    diagonal += illuminance[static_cast<std::size_t>(y * side + (side - 1 - y))] / side;
    for (int x = 0; x < side; ++x) {
      if (std::abs(x + y - (side - 1)) < 30) continue;
      middle += illuminance[static_cast<std::size_t>(y * side + x)];
      ++middle_count;
    }
  }
  return diagonal * middle_count / middle;
}

TEST_CASE("naive maps darken the edge between two triangles to about half") {
  // On the edge half of the disc has no photons. Pixels reach half a pixel off the diagonal, a
  // quarter of the radius here, so they read a little more than the 0.51 of the edge itself.
  const double ratio = diagonal_over_middle(MapMode::naive);
  CHECK(ratio > 0.45);
  CHECK(ratio < 0.75);
}

TEST_CASE("maps of neighbour groups and patches show no edge between two triangles") {
  const MapMode mode = GENERATE(MapMode::triangle, MapMode::patch, MapMode::automatic);
  // 100 pixels on the diagonal hold about 100 x 0.01 m / 0.04 m = 25 independent estimates of 14%:
  // a deviation of 3%.
  CHECK(diagonal_over_middle(mode) == Approx(1.0).margin(0.1));
}

// Every scene that lies beside a checkout, where one does, as a picture.

/// PixelCounts that no picture may have, and those that are not black.
struct PixelCounts {
  std::size_t bad = 0, lit = 0;
};

PixelCounts values_of(const LightLayers& layers) {
  PixelCounts values;
  for (const LightLayers::Layer& layer : layers.dense().layers) {
    for (const glm::vec3& pixel : layer.radiance) {
      for (int c = 0; c < 3; ++c) {
        values.bad += !(std::isfinite(pixel[c]) && pixel[c] >= 0.0f);
        values.lit += pixel[c] > 0.0f;
      }
    }
  }
  return values;
}

/// A hundred files of every kind: half of them are closed boxes, which are dark inside.
TEST_CASE("every shared scene that loads renders to finite light under a sky", "[slow]") {
  if (!std::filesystem::exists(shared_scenes_folder())) {
    skip("no " + shared_scenes_folder().string());
    return;
  }
  Device device;
  RenderParameters parameters = small_picture(2'000, 16, 12, 1);
  int pictures = 0, lit = 0;
  for (const SharedScene& shared : shared_scenes) {
    if (!shared.refusal.empty()) continue;
    CAPTURE(shared.file);
    const Scene scene = load_shared_scene(shared);
    const PixelCounts values =
        values_of(render(scene, scene.cameras.front(), device, parameters).layers);
    CHECK(values.bad == 0);
    ++pictures;
    lit += values.lit > 0;
  }
  CHECK(2 * lit > pictures);
}

}  // namespace
}  // namespace photile::test
