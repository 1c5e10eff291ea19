// The meshes that the scale bench makes and writes.
#include <algorithm>
#include <catch2/catch.hpp>

#include "support/gltf_writer.hpp"
#include "support/subdivision.hpp"
#include "support/workload.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

double area(const Scene& scene) {
  double sum = 0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) sum += triangle_area(scene, t);
  return sum;
}

glm::dvec3 front_normal(const Scene& scene, std::uint32_t triangle) {
  return sided_normal(scene, sided(triangle, scene.front_side[triangle]));
}

}  // namespace

TEST_CASE("subdividing keeps area, fronts, materials, lights and textures") {
  const Scene whole = bench::living_room();
  const Scene fine = bench::subdivided(whole);
  REQUIRE(fine.triangle_count() == 4 * whole.triangle_count());
  CHECK(area(fine) == Approx(area(whole)).epsilon(1e-5));
  REQUIRE(fine.corner_uv.size() == fine.triangle_count());
  std::size_t turned = 0, other_material = 0, other_light = 0, not_listed = 0, uv_moved = 0;
  for (std::uint32_t t = 0; t < fine.triangle_count(); ++t) {
    const std::uint32_t from = t / 4;
    turned += glm::dot(front_normal(fine, t), front_normal(whole, from)) < 0.99;
    other_material += fine.triangle_material[t] != whole.triangle_material[from];
    const std::uint32_t light = fine.triangle_light[t];
    other_light += light != whole.triangle_light[from];
    if (light != none) {
      const auto& listed = fine.lights[light].triangles;
      not_listed += std::find(listed.begin(), listed.end(), t) == listed.end();
    }
    // Where a corner is one of the whole's, so is its texture coordinate.
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        uv_moved += fine.corners(t)[i] == whole.corners(from)[j] &&
                    fine.corner_uv[t][i] != whole.corner_uv[from][j];
      }
    }
  }
  CHECK(turned == 0);
  CHECK(other_material == 0);
  CHECK(other_light == 0);
  CHECK(not_listed == 0);
  CHECK(uv_moved == 0);
}

TEST_CASE("a mesh that was written is read again as it was") {
  const TemporaryFolder folder;
  const Scene hall = bench::waved_hall(8);
  bench::write_gltf(hall, folder.path / "hall.gltf");
  const Scene read = load_scene(folder.path / "hall.gltf");
  CHECK(read.report.warnings.empty());
  REQUIRE(read.triangle_count() == hall.triangle_count());
  CHECK(area(read) == Approx(area(hall)).epsilon(1e-6));
  REQUIRE(read.lights.size() == 1);
  CHECK(read.lights[0].power == Approx(hall.lights[0].power));
  CHECK(read.lights[0].position == hall.lights[0].position);
  CHECK(read.materials[0].diffuse == hall.materials[0].diffuse);
  CHECK_FALSE(needs_of(read).glossy);
  std::size_t different = 0;
  for (std::uint32_t t = 0; t < read.triangle_count(); ++t) {
    different += read.corners(t) != hall.corners(t) || read.front_side[t] != hall.front_side[t];
  }
  CHECK(different == 0);
}

}  // namespace photile::test
