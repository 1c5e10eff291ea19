// The scenes that lie beside a checkout, where they do.
#include "shared_scenes.hpp"

#include <set>

#include "scene_files.hpp"
#include "scene_invariants.hpp"
#include "skipped.hpp"

namespace photile::test {
namespace {

/// Whether the shared scenes are here; says so when they are not.
bool available(const std::string& name) {
  if (std::filesystem::exists(shared_scenes_folder() / name)) return true;
  skip("no " + name + " in " + shared_scenes_folder().string());
  return false;
}

/// Scene files below the folder, as SharedScene::file has them.
std::set<std::string> files_found() {
  std::set<std::string> files;
  const std::filesystem::path folder = shared_scenes_folder();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".obj" || extension == ".gltf" || extension == ".glb") {
      files.insert(std::filesystem::relative(entry.path(), folder).generic_string());
    }
  }
  return files;
}

}  // namespace

TEST_CASE("the kitchen has 5 lights and all its triangles but those without area") {
  if (!available("kitchen")) return;
  for (const std::string name : {"kitchen.gltf", "kitchen-diffuse.gltf"}) {
    const Scene scene = load_scene(shared_scenes_folder() / "kitchen" / name);
    check_invariants(scene);
    CHECK(scene.triangle_count() + scene.report.degenerate_triangles +
              scene.report.duplicate_triangles ==
          86'032);
    // Counted by exact rational arithmetic on the file's floats: two corners in one place each.
    CHECK(scene.report.degenerate_triangles == 3'290);
    CHECK(scene.report.non_finite_triangles == 0);
    CHECK(scene.lights.size() == 5);
    CHECK(needs_of(scene).glossy == (name == "kitchen.gltf"));
  }
}

TEST_CASE("the classroom has 2 lights and all its triangles") {
  if (!available("classroom")) return;
  for (const std::string name : {"classroom.gltf", "classroom-diffuse.gltf"}) {
    const Scene scene = load_scene(shared_scenes_folder() / "classroom" / name);
    check_invariants(scene);
    CHECK(scene.triangle_count() + scene.report.duplicate_triangles == 111'164);
    CHECK(scene.lights.size() == 2);
  }
}

TEST_CASE("the list of shared scenes has every file that is there, and no other") {
  if (!available("odd")) return;
  std::set<std::string> listed;
  for (const SharedScene& scene : shared_scenes) listed.emplace(scene.file);
  CHECK(listed == files_found());
}

TEST_CASE("every shared scene loads, or is refused in one line that says why") {
  if (!available("odd")) return;
  for (const SharedScene& scene : shared_scenes) {
    CAPTURE(scene.file);
    const std::string error = input_error_of([&] { check_invariants(load_shared_scene(scene)); });
    CAPTURE(error);
    CHECK(error.empty() == scene.refusal.empty());
    CHECK(error.find(scene.refusal) != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
    if (!error.empty()) {
      const std::string name = std::filesystem::path(scene.file).filename().string();
      CHECK(error.find(name) != std::string::npos);
    }
  }
}

}  // namespace photile::test
