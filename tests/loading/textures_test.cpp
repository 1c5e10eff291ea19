// Textures: their pictures, their texels, and where they lie.
#include "pictures/textures.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>

#include "files/scene_files.hpp"
#include "photile/image.hpp"
#include "srgb_oracle.hpp"
#include "textured_square.hpp"

namespace photile::test {
namespace {

using nlohmann::json;

/// Two by two texels: red, green / blue, white.
Texture four_texels() {
  return Texture("four", 2, 2,
                 {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}});
}

std::vector<unsigned char> read_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A textured square; its picture is red in the left half and green in the right one.
Scene textured(const std::function<void(json&)>& change, bool with_picture = true) {
  const SceneFolderOnDisk folder;
  if (with_picture) {
    write_picture<std::uint8_t>(folder.path / "my picture.png", 2, 1, 3, {255, 0, 0, 0, 255, 0});
  }
  json document = square_document();
  document["images"] = {{{"uri", "my%20picture.png"}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  change(document);
  folder.write("square.bin", square_buffer());
  return load_scene(folder.write("scene.gltf", document.dump()));
}

/// Texture colour at the corner with this position.
glm::vec3 colour_at(const Scene& scene, const glm::vec3& position, const glm::vec2& shift) {
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (scene.corners(t)[c] == position) {
        return scene.textures.at(0).sample(scene.corner_uv.at(t)[c] + shift);
      }
    }
  }
  FAIL("no such corner");
  return {};
}

}  // namespace

TEST_CASE("texture lookup puts (0,0) at the top left, texel centres at half texels") {
  const Texture texture = four_texels();
  CHECK(texture.sample({0.25f, 0.25f}) == glm::vec3(1, 0, 0));
  CHECK(texture.sample({0.75f, 0.25f}) == glm::vec3(0, 1, 0));
  CHECK(texture.sample({0.25f, 0.75f}) == glm::vec3(0, 0, 1));
  CHECK(texture.sample({0.5f, 0.25f}) == glm::vec3(0.5f, 0.5f, 0));
  CHECK(texture.sample({0.5f, 0.5f}) == glm::vec3(0.5f));
}

TEST_CASE("textures repeat, and coordinates that are not finite do no harm") {
  const Texture texture = four_texels();
  CHECK(texture.sample({-0.75f, 3.25f}) == glm::vec3(1, 0, 0));
  CHECK(texture.sample({0.0f, 0.25f}) == glm::vec3(0.5f, 0.5f, 0));  // across the seam
  CHECK(std::isfinite(texture.sample({std::nanf(""), 1e30f}).r));
}

TEST_CASE("texels are decoded from sRGB before they are mixed") {
  const Texture texture("grey", 1, 1, {{188, 100, 5, 255}});
  const glm::vec3 value = texture.sample({0.5f, 0.5f});
  CHECK(value.r == Approx(linear(188)));
  CHECK(value.g == Approx(linear(100)));
  CHECK(value.b == Approx(linear(5)));
}

TEST_CASE("pictures of 1 to 4 channels decode to the colours written, alpha left alone") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.png";
  for (int channels = 1; channels <= 4; ++channels) {
    std::vector<std::uint8_t> pixel{200, 100, 50, 0};
    pixel.resize(static_cast<std::size_t>(channels));
    write_picture(file, 1, 1, channels, pixel);
    const glm::vec3 value =
        pictures::decode_texture("t.png", read_bytes(file)).sample({0.5f, 0.5f});
    CHECK(value.r == Approx(linear(200)));
    CHECK(value.g == Approx(linear(channels < 3 ? 200 : 100)));
    CHECK(value.b == Approx(linear(channels < 3 ? 200 : 50)));
  }
}

TEST_CASE("glTF takes colours as sRGB whatever a picture says, and MTL as the picture says") {
  const SceneFolderOnDisk folder;
  const auto file = write_picture<std::uint8_t>(folder.path / "t.png", 1, 1, 3, {128, 128, 128},
                                                "Linear");  // a gAMA of 1
  const auto value = [&](pictures::TextureContent content) {
    return pictures::decode_texture("t.png", read_bytes(file), content).sample({0.5f, 0.5f}).g;
  };
  CHECK(value(pictures::TextureContent::srgb) == Approx(linear(128)));
  CHECK(value(pictures::TextureContent::color) == Approx(128 / 255.0).epsilon(5e-3));  // 8 bits
  json document = square_document();
  document["images"] = {{{"uri", file.string()}}};
  document["textures"] = {{{"source", 0}}};
  document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  SceneLoadOptions options;
  options.allow_outside = true;
  const Scene scene = load_gltf(document, options);
  CHECK(scene.textures.at(0).sample({0.5f, 0.5f}).g == Approx(linear(128)));
}

TEST_CASE("linear pictures are clamped and come back within half an 8-bit step") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.exr";
  write_picture<float>(file, 2, 1, 3, {0.5f, 0.1f, 0.9f, std::nanf(""), -1.0f, 7.0f});
  const Texture texture = pictures::decode_texture("t.exr", read_bytes(file));
  const glm::vec3 first = texture.sample({0.25f, 0.5f}), second = texture.sample({0.75f, 0.5f});
  CHECK(first.r == Approx(0.5).margin(0.005));
  CHECK(first.g == Approx(0.1).margin(0.005));
  CHECK(first.b == Approx(0.9).margin(0.005));
  CHECK(second == glm::vec3(0, 0, 1));
}

TEST_CASE("channels of an EXR behind its picture are no alpha") {
  const SceneFolderOnDisk folder;
  Image picture;
  picture.width = picture.height = 1;
  for (const auto& [channel, value] :
       {std::pair{"R", 1.0f}, {"G", 0.5f}, {"B", 0.0f}, {"Z", 0.0f}}) {
    picture.add(channel).assign(1, value);
  }
  write_exr(folder.path / "t.exr", picture);
  const auto alpha = [&] {
    return pictures::decode_texture("t.exr", read_bytes(folder.path / "t.exr"))
        .sample_data({0.5f, 0.5f})
        .a;
  };
  CHECK(alpha() == 1.0f);
  picture.add("A").assign(1, 0.25f);
  write_exr(folder.path / "t.exr", picture);
  CHECK(alpha() == Approx(0.25).margin(0.005));
}

TEST_CASE("a PNG header that promises too many pixels is refused before decoding") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.png";
  write_picture<std::uint8_t>(file, 1, 1, 3, {1, 2, 3});
  std::vector<unsigned char> bytes = read_bytes(file);
  CHECK_THROWS_WITH(pictures::decode_texture("t.png", bytes, pictures::TextureContent::color, 3),
                    Catch::Contains("1 x 1 texels"));
  // Width 20,000 in the IHDR chunk, and the checksum that makes it a valid header.
  bytes[18] = 0x4E;
  bytes[19] = 0x20;
  std::uint32_t crc = 0xFFFFFFFFu;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
  }
  for (int i = 0; i < 4; ++i)
    bytes[29 + static_cast<std::size_t>(i)] = static_cast<unsigned char>(~crc >> (24 - 8 * i));
  CHECK_THROWS_WITH(pictures::decode_texture("t.png", bytes),
                    Catch::Contains("20000 x 1") && Catch::Contains("limit"));
}

TEST_CASE("truncated and unknown pictures are refused by name") {
  const SceneFolderOnDisk folder;
  const std::filesystem::path file = folder.path / "t.png";
  write_picture(file, 64, 64, 3, std::vector<std::uint8_t>(64 * 64 * 3, 7));
  std::vector<unsigned char> bytes = read_bytes(file);
  bytes.resize(20);
  CHECK_THROWS_AS(pictures::decode_texture("t.png", bytes), files::ResourceError);
  const std::vector<unsigned char> text{'h', 'e', 'l', 'l', 'o'};
  CHECK_THROWS_WITH(pictures::decode_texture("note.png", text), Catch::Contains("note.png"));
}

TEST_CASE("a glTF base-colour texture arrives at the right corners") {
  const Scene scene = textured([](json&) {});
  REQUIRE(scene.textures.size() == 1);
  CHECK(needs_of(scene).textures);
  CHECK(colour_at(scene, {0, 0, 0}, {0.25f, -0.5f}) == glm::vec3(1, 0, 0));
  CHECK(colour_at(scene, {1, 0, 0}, {-0.25f, -0.5f}) == glm::vec3(0, 1, 0));
}

TEST_CASE("KHR_texture_transform scales, turns and moves texture coordinates in that order") {
  const Scene scene = textured([](json& document) {
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = {
        {"KHR_texture_transform",
         {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", std::acos(0.0)}}}};
  });
  // Corner (1,0,0) has uv (1,1): scaled (2,3); a quarter turn counter-clockwise, v pointing down,
  // maps (u,v) to (v,-u): (3,-2); moved (3.5,-1.75).
  for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (scene.corners(t)[c] != glm::vec3(1, 0, 0)) continue;
      CHECK(scene.corner_uv[t][c].x == Approx(3.5));
      CHECK(scene.corner_uv[t][c].y == Approx(-1.75));
    }
  }
}

TEST_CASE("a missing glTF texture is named and becomes mid grey") {
  const Scene scene = textured([](json&) {}, false);
  CHECK(warns(scene, {"'glow'", "my picture.png", "grey"}));
  CHECK(scene.materials[0].diffuse_texture == none);
  CHECK(scene.materials[0].diffuse.r == Approx(0.5));
  CHECK(scene.corner_uv.empty());
}

}  // namespace photile::test
