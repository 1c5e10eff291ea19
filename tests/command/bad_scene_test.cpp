// Scenes that cannot be rendered: exit code 3 and one line that names the file.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// What both `info` and `render` say of a bad scene; they must agree. Nothing may be written.
std::string refusal(const FileFolder& folder, const std::string& scene,
                    bool held_to_permissions = false) {
  Run run;
  run.held_to_permissions = held_to_permissions;
  run.arguments = {"info", scene};
  const std::string line = only_error(run_photile(run), bad_input);
  run.arguments = {"render", scene, "-o", folder / "out.exr"};
  CHECK(last_error(run_photile(run), bad_input) == line);
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
  return line;
}

}  // namespace

TEST_CASE("a missing scene is an input error that names the file") {
  const FileFolder folder;
  CHECK_THAT(refusal(folder, folder / "none.obj"), Contains("none.obj"));
}

TEST_CASE("an unreadable scene is an input error") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  std::filesystem::permissions(scene, std::filesystem::perms::none);
  constexpr bool held_to_permissions = true;
  CHECK_THAT(refusal(folder, scene, held_to_permissions), Contains("box.obj"));
}

TEST_CASE("an empty scene is an input error, for each format") {
  const std::string name = GENERATE("empty.obj", "empty.gltf", "empty.glb");
  const FileFolder folder;
  CHECK_THAT(refusal(folder, folder.write(name, "")), Contains(name));
}

TEST_CASE("a malformed scene is an input error, for each format") {
  const auto [name, text] = GENERATE(table<std::string, std::string>({
      {"bad.gltf", "{\"asset\": {\"version\": \"2.0\""},
      {"bad.gltf", "[1, 2, 3]"},
      {"bad.glb", "glTF\x02 and then nothing of the kind"},
      {"bad.obj", "f 1 2 3\n"},
  }));
  const FileFolder folder;
  CHECK_THAT(refusal(folder, folder.write(name, text)), Contains(name));
}

TEST_CASE("a file of another kind is an input error that says what can be read") {
  const FileFolder folder;
  CHECK_THAT(refusal(folder, folder.write("scene.txt", "hello")),
             Contains("scene.txt") && Contains(".obj"));
}

TEST_CASE("a folder in place of a scene is an input error") {
  const FileFolder folder;
  std::filesystem::create_directory(folder / "folder.obj");
  CHECK_THAT(refusal(folder, folder / "folder.obj"), Contains("folder.obj"));
}

TEST_CASE("a picture of a scene without lights is an input error that says so; info describes it") {
  const FileFolder folder;
  folder.write("box.mtl", "newmtl wall\nKd 0.7 0.6 0.5\nnewmtl red_lamp\nnewmtl blue_lamp\n");
  const std::string scene = folder.write("box.obj", box_obj());
  const Outcome render = run_photile({"render", scene, "-o", folder / "out.exr"});
  CHECK_THAT(last_error(render, bad_input), Contains("no lights"));
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
  const Outcome info = run_photile({"info", scene});
  CHECK(info.exit_code == 0);
  CHECK_THAT(info.output + info.errors, Contains("no lights"));
}

TEST_CASE("a scene without geometry is an input error that says so") {
  const FileFolder folder;
  folder.write("box.mtl", box_mtl());
  const std::string scene = folder.write("box.obj", "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n");
  CHECK_THAT(refusal(folder, scene), Contains("triangle"));
}

TEST_CASE("triangles with a corner that is no number are dropped, counted and reported") {
  const std::string corner = GENERATE("v nan -1 -1\n", "v inf -1 -1\n");
  const FileFolder folder;
  folder.write("box.mtl", box_mtl());
  // A vertex of its own, used by one more triangle.
  const std::string scene =
      folder.write("box.obj", box_obj() + corner + "o spoilt\nusemtl wall\nf 1 2 17\n");
  const Outcome outcome = run_photile({"info", "--json", scene});
  if (outcome.exit_code == 0) {
    const auto facts = nlohmann::json::parse(outcome.output);
    CHECK(facts["non_finite_triangles"] == 1);
    CHECK(facts["triangles"] == 16);
  } else {
    CHECK_THAT(only_error(outcome, bad_input), Contains("box.obj"));
  }
}

TEST_CASE("triangles without area are dropped, counted and reported") {
  const FileFolder folder;
  folder.write("box.mtl", box_mtl());
  const std::string scene =
      folder.write("box.obj", box_obj() + "o thin\nusemtl wall\nf 1 2 2\nf 3 3 3\n");
  const Outcome outcome = run_photile({"info", "--json", scene});
  REQUIRE(outcome.exit_code == 0);
  const auto facts = nlohmann::json::parse(outcome.output);
  CHECK(facts["degenerate_triangles"] == 2);
  CHECK(facts["triangles"] == 16);
  CHECK_THAT(facts["warnings"].dump(), Contains("2 triangles without area"));
}

TEST_CASE("a line feed in a file name does not make two lines of an error") {
  const FileFolder folder;
  CHECK_THAT(refusal(folder, folder / "two\nlines.obj"), Contains("two lines.obj"));
}

}  // namespace photile::test
