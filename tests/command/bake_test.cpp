// `photile bake`: the files that it writes, and what other programs find in them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/image.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

std::vector<std::string> bake(const FileFolder& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{
      "bake", write_box(folder), "-o", folder / "baked.gltf", "--photons", "50k"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace

TEST_CASE("a baked scene has a second set of coordinates and a picture for each light") {
  const FileFolder folder;
  const Outcome outcome = run_photile(bake(folder));
  INFO(outcome.errors);
  REQUIRE(outcome.exit_code == 0);
  const nlohmann::json document = nlohmann::json::parse(folder.read("baked.gltf"));
  const auto& primitive = document["meshes"][0]["primitives"][0];
  const auto& lights = document["accessors"][primitive["attributes"]["TEXCOORD_1"].get<int>()];
  CHECK(lights["type"] == "VEC2");
  CHECK(lights["count"] ==
        document["accessors"][primitive["attributes"]["POSITION"].get<int>()]["count"]);
  for (const int axis : {0, 1}) {
    CHECK(lights["min"][axis] >= 0.0);
    CHECK(lights["max"][axis] <= 1.0);
  }
  const auto& maps = document["scenes"][0]["extras"]["photile"]["light_maps"];
  REQUIRE(maps.size() == 2);
  for (const auto& map : maps) {
    const Image picture = read_image(folder / map["uri"].get<std::string>());
    CHECK(picture.attributes.at("photile.light") == map["light"].get<std::string>());
    const std::vector<float>& green = *picture.find("G");
    CHECK(*std::max_element(green.begin(), green.end()) > 0);
    CHECK(*std::min_element(green.begin(), green.end()) >= 0);
  }
  CHECK(std::filesystem::file_size(folder / "baked.bin") ==
        document["buffers"][0]["byteLength"].get<std::size_t>());
}

TEST_CASE("bake refuses what it cannot do in one line") {
  const FileFolder folder;
  CHECK_THAT(only_error(run_photile({"bake", write_box(folder), "-o", folder / "a.glb"}), 2),
             Contains(".gltf"));
  CHECK_THAT(last_error(run_photile(bake(folder, {"--texel", "0.00001"})), 2),
             Contains("do not fit"));
  CHECK_THAT(only_error(run_photile(bake(folder, {"--texel", "0"})), 2), Contains("--texel"));
}

}  // namespace photile::test
