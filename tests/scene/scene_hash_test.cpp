// The hash that tells saved photon maps of one scene from those of another knows every light.
#include <catch2/catch.hpp>
#include <functional>
#include <set>

#include "common/content_hash.hpp"
#include "scene/scene_queries.hpp"

namespace photile::test {
namespace {

std::string hash_of(const Scene& scene) {
  ContentHash hash;
  scene::add_scene(scene, hash);
  return hash.hex();
}

/// A scene of one light of every kind that needs data of its own.
Scene scene_with(float texel, double rotation, float candela) {
  Scene scene;
  scene.environments.emplace_back(
      "sky", 2, 1, std::vector<glm::vec3>{glm::vec3(1.0f), glm::vec3(texel)}, rotation);
  scene.distributions.emplace_back("lamp", PhotometricAxes{}, std::vector<double>{0, 90},
                                   std::vector<double>{0, 360},
                                   std::vector<float>{1, candela, 1, candela});
  scene.lights.resize(2);
  return scene;
}

TEST_CASE("scenes whose lights differ in anything have different hashes") {
  std::set<std::string> hashes{hash_of(scene_with(2, 0, 3)), hash_of(scene_with(2.001f, 0, 3)),
                               hash_of(scene_with(2, 1, 3)), hash_of(scene_with(2, 0, 3.001f))};
  const std::vector<std::function<void(Light&)>> changes{
      [](Light& light) { light.distribution = 0; },
      [](Light& light) { light.environment = 0; },
      [](Light& light) { light.angular_diameter = 0.01f; },
      [](Light& light) {
        light.x_axis = {0, 1, 0};
      },
      [](Light& light) { light.emission_texture = 0; },
      [](Light& light) { light.texel_radiance.g = 1; },
  };
  for (const auto& change : changes) {
    Scene scene = scene_with(2, 0, 3);
    change(scene.lights[1]);
    hashes.insert(hash_of(scene));
  }
  CHECK(hashes.size() == 4 + changes.size());
}

}  // namespace
}  // namespace photile::test
