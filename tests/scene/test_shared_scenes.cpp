// The scenes that lie beside a checkout, where they do; PHOTILE_SHARED_SCENES names another place.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>

#include "scene_files.hpp"
#include "source_folder.hpp"

namespace photile {
namespace {

std::filesystem::path shared_scenes() {
  const char* place = std::getenv("PHOTILE_SHARED_SCENES");
  return place != nullptr ? std::filesystem::path(place)
                          : test::source_folder() / "../shared/scenes";
}

/// Whether the shared scenes are here; says so when they are not.
bool available(const std::string& name) {
  if (std::filesystem::exists(shared_scenes() / name)) return true;
  WARN("skipped: no " << name << " in " << shared_scenes());
  return false;
}

/// Every index in range, every number finite, every area positive, every light fed.
void check_invariants(const Scene& scene) {
  const std::size_t count = scene.triangle_count();
  CHECK(scene.front_side.size() == count);
  CHECK(scene.triangle_material.size() == count);
  CHECK(scene.triangle_light.size() == count);
  CHECK((scene.corner_uv.empty() || scene.corner_uv.size() == count));
  CHECK((scene.corner_normal.empty() || scene.corner_normal.size() == count));
  std::uint64_t bad = 0;
  for (std::uint32_t t = 0; t < count; ++t) {
    const glm::uvec3 triangle = scene.triangles[t];
    for (int c = 0; c < 3; ++c) bad += triangle[c] >= scene.vertices.size();
    bad += !(triangle_area(scene, t) > 0.0);
    bad += scene.triangle_material[t] >= scene.materials.size();
    const std::uint32_t light = scene.triangle_light[t];
    bad += light != none && light >= scene.lights.size();
  }
  for (const Material& material : scene.materials) {
    for (const glm::vec3& part : {material.diffuse, material.specular}) {
      bad += !glm::all(glm::greaterThanEqual(part, glm::vec3(0.0f)));
      bad += !glm::all(glm::lessThanEqual(part, glm::vec3(1.0f)));
    }
  }
  for (const Light& light : scene.lights) bad += !(light.power > 0.0);
  CHECK(bad == 0);
  CHECK_FALSE(scene.cameras.empty());
}

TEST_CASE("the kitchen has 5 lights and all its triangles but those without area") {
  if (!available("kitchen")) return;
  for (const std::string name : {"kitchen.gltf", "kitchen-diffuse.gltf"}) {
    const Scene scene = load_scene(shared_scenes() / "kitchen" / name);
    check_invariants(scene);
    CHECK(scene.triangle_count() + scene.report.degenerate_triangles == 86'032);
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
    const Scene scene = load_scene(shared_scenes() / "classroom" / name);
    check_invariants(scene);
    CHECK(scene.triangle_count() == 111'164);
    CHECK(scene.lights.size() == 2);
  }
}

TEST_CASE("oddly written files load or are refused in one line") {
  if (!available("odd")) return;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(shared_scenes() / "odd")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".obj" && extension != ".gltf" && extension != ".glb") continue;
    ++files;
    CAPTURE(entry.path());
    try {
      check_invariants(load_scene(entry.path()));
    } catch (const InputError& error) {
      const std::string message = error.what();
      CHECK(message.find(entry.path().filename().string()) != std::string::npos);
      CHECK(message.find('\n') == std::string::npos);
    }
  }
  CHECK(files > 50);
}

}  // namespace
}  // namespace photile
