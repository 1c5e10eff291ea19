// Estimates over discs clipped to the surface against polygon clipping in double precision, on
// plates, curved surfaces and real meshes, for every structure and strategy.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "estimates_comparison.hpp"
#include "oracle/clipped_area.hpp"
#include "photon_sets.hpp"
#include "source_folder.hpp"
#include "test_device.hpp"

using namespace photile;

namespace {

/// Areas are compared with polygons of 4096 corners, and computed from floats: a ten-thousandth of
/// the whole disc, where the clipped one is a tenth of that at least.
constexpr double area_tolerance = 1e-3;

test::ExpectedEstimates expected_clipped(const Scene& scene, const Photons& photons,
                                         const PrimaryHits& hits, int k, double radius,
                                         DensityKernel kernel) {
  const SurfaceIndex surface = index_surface(scene, landed_on(scene, photons), radius, 60);
  const reference::ClippedArea area(scene, photons, surface, 60);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  test::ExpectedEstimates expected;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    expected.push_back(oracle.irradiance(area, hits.position[i], hits.sided_triangle[i], k,
                                         static_cast<float>(radius), kernel));
  }
  return expected;
}

void check_clipped(const Scene& scene, const Photons& photons, const PrimaryHits& hits,
                   double radius, int k, DensityKernel kernel, MapMode mode = MapMode::triangle) {
  const std::size_t lights = scene.lights.size();
  const auto expected = expected_clipped(scene, photons, hits, k, radius, kernel);
  const NeighbourGroups groups = find_map_groups(scene, photons, mode, {radius, 60});
  for (const MapStructure structure : {MapStructure::uniform_grid, MapStructure::kdtree_3d}) {
    for (const EstimateStrategy strategy : all_estimate_strategies) {
      if (structure != MapStructure::uniform_grid && strategy != EstimateStrategy::select) continue;
      const PhotonMaps maps(test::device(), scene, photons, groups, {radius, 4, structure});
      EstimateParameters parameters;
      parameters.neighbours = k;
      parameters.kernel = kernel;
      parameters.tuning = shipped_tuning(test::device().info());
      parameters.tuning->strategy = strategy;
      const Estimates estimates = Estimator(maps, scene, parameters).estimate(hits);
      const auto irradiance = test::by_light(estimates.irradiance, estimates, lights);
      REQUIRE(irradiance.size() == hits.size() * lights);
      CAPTURE(name_of(structure), static_cast<int>(strategy), name_of(kernel), k, radius, lights);
      CHECK(test::worst_difference(irradiance, expected) <= area_tolerance);
    }
  }
}

/// Triangles round `centre` whose outer corners lie far off it and near it in turn: corners of
/// the border of less and of more than half a turn.
void add_star(Scene& scene, const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v,
              int corners) {
  const auto corner = [&](int i) {
    const float turn =
        glm::two_pi<float>() * static_cast<float>(i % corners) / static_cast<float>(corners);
    return centre + (i % 2 == 0 ? 1.0f : 0.5f) * (std::cos(turn) * u + std::sin(turn) * v);
  };
  for (int i = 0; i < corners; ++i) test::add_triangle(scene, centre, corner(i), corner(i + 1));
}

/// Each corner of each triangle, and the middle of each edge, as hits on that triangle.
PrimaryHits hits_on_vertices_and_edges(const Scene& scene) {
  PrimaryHits hits;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto corners = scene.corners(t);
    for (int i = 0; i < 3; ++i) {
      const glm::vec3& corner = corners[i];
      for (const glm::vec3& position : {corner, 0.5f * (corner + corners[(i + 1) % 3])}) {
        hits.position.push_back(position);
        hits.sided_triangle.push_back(sided(t, 0));
        hits.diffuse_albedo.emplace_back(0.5f);
      }
    }
  }
  return hits;
}

}  // namespace

TEST_CASE("clipped irradiance on plates of any triangulation equals the oracle's", "[long]") {
  for (const int cells : {1, 3, 40}) {
    Scene scene = test::empty_scene();
    test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0.3f, 1, 0}, cells);
    const Photons photons = test::uniform_photons(scene, 6000, 51);
    const PrimaryHits hits = test::uniform_hits(scene, 300, 52);
    check_clipped(scene, photons, hits, 0.2, 50, DensityKernel::constant);
    if (cells != 3) continue;
    for (const int k : {1, 16, 400}) {
      check_clipped(scene, photons, hits, 0.2, k, DensityKernel::constant);
    }
    check_clipped(scene, photons, hits, 0.2, 50, DensityKernel::cone);
    check_clipped(scene, photons, hits, 0.2, 50, DensityKernel::epanechnikov);
  }
}

TEST_CASE("clipped irradiance on vertices and edges to the last bit equals the oracle's") {
  Scene scene = test::empty_scene();
  test::add_plate(scene, {0, 0, 0}, {1, 0, 0}, {0.3f, 1, 0}, 1);
  test::add_plate(scene, {3, 0, 1}, {0.8f, 0.1f, 0.3f}, {-0.2f, 0.9f, 0.1f}, 3);
  add_star(scene, {10, 20, 5}, {0.6f, 0.2f, 0.4f}, {0.1f, -0.7f, 0.3f}, 12);
  const Photons photons = test::uniform_photons(scene, 12'000, 51);
  const DensityKernel kernel = GENERATE(DensityKernel::constant, DensityKernel::cone);
  check_clipped(scene, photons, hits_on_vertices_and_edges(scene), 0.2, 50, kernel);
}

TEST_CASE("clipped irradiance on a torus equals the oracle's, coarse and fine, for every mode",
          "[slow]") {
  const auto [mode, kernel] =
      GENERATE(table<MapMode, DensityKernel>({{MapMode::triangle, DensityKernel::constant},
                                              {MapMode::patch, DensityKernel::constant},
                                              {MapMode::triangle, DensityKernel::cone},
                                              {MapMode::patch, DensityKernel::epanechnikov}}));
  for (const int rings : {24, 96}) {
    Scene scene = test::empty_scene(2);
    test::add_torus(scene, 1.0f, 0.4f, rings, rings / 2);
    const Photons photons = test::uniform_photons(scene, 20'000, 53);
    check_clipped(scene, photons, test::uniform_hits(scene, 200, 54), 0.3, 50, kernel, mode);
  }
}

TEST_CASE("clipped irradiance in the living room equals the oracle's", "[slow]") {
  Scene scene = load_scene(test::source_folder() / "scenes/living-room/living-room.gltf");
  for (Material& material : scene.materials) material.specular = glm::vec3(0.0f);  // no lobes
  const Photons photons = test::uniform_photons(scene, 60'000, 51);
  const DensityKernel kernel = GENERATE(from_range(all_density_kernels));
  check_clipped(scene, photons, test::uniform_hits(scene, 300, 52), 0.4, 50, kernel,
                MapMode::automatic);
}
