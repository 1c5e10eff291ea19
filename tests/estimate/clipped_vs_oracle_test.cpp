// Estimates over discs clipped to the surface against polygon clipping in double precision, on
// plates, curved surfaces and real meshes, for every structure and strategy.
#include <catch2/catch.hpp>

#include "estimates_comparison.hpp"
#include "oracle/clipped_area.hpp"
#include "photile/load_scene.hpp"
#include "photon_sets.hpp"
#include "source_folder.hpp"
#include "structures/structure.hpp"
#include "test_device.hpp"
#include "test_tunings.hpp"

namespace photile::test {
namespace {

/// Areas are compared with polygons of 4096 corners, and computed from floats: a ten-thousandth of
/// the whole disc, where the clipped one is a tenth of that at least.
constexpr double area_tolerance = 1e-3;

ExpectedEstimates expected_clipped(const Scene& scene, const Photons& photons,
                                   const SurfaceIndex& surface, const PrimaryHits& hits, int k,
                                   double radius, DensityKernel kernel) {
  const reference::ClippedArea area(scene, photons, surface, 60);
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  ExpectedEstimates expected;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    expected.push_back(oracle.irradiance(area, hits.position[i], hits.oriented_face[i], k,
                                         static_cast<float>(radius), kernel));
  }
  return expected;
}

/// Estimates over discs clipped to `surface`, by each structure and strategy.
void check_clipped_to(const std::shared_ptr<const SurfaceIndex>& surface, const Scene& scene,
                      const Photons& photons, const PrimaryHits& hits, double radius, int k,
                      DensityKernel kernel, MapMode mode = MapMode::triangle) {
  const std::size_t lights = scene.lights.size();
  const auto expected = expected_clipped(scene, photons, *surface, hits, k, radius, kernel);
  const NeighbourGroups groups = find_map_groups(scene, photons, mode, {radius, 60});
  for (const std::string_view structure : {"uniform-grid", "kdtree-3d"}) {
    for (const EstimateTuning& tuning : tunings_of(device().info())) {
      if (structure != "uniform-grid" && tuning.strategy != EstimateStrategy::select) {
        continue;
      }
      const PhotonMaps maps = structures::build(structures::named(structure), device(), scene,
                                                photons, groups, {radius, 4});
      EstimateParameters parameters;
      parameters.neighbours = k;
      parameters.kernel = kernel;
      parameters.tuning = tuning;
      parameters.surface = surface;
      const LightTable estimates = Estimator(maps, scene, parameters).estimate(hits);
      const auto irradiance = by_light(estimates.irradiance, estimates, lights);
      REQUIRE(irradiance.size() == hits.size() * lights);
      CAPTURE(structure, name_of(tuning.strategy), name_of(kernel), k, radius, lights);
      CHECK(worst_difference(irradiance, expected) <= area_tolerance);
    }
  }
}

/// Checks areas without unlit regions: uniform photons leave none.
void check_clipped(const Scene& scene, const Photons& photons, const PrimaryHits& hits,
                   double radius, int k, DensityKernel kernel, MapMode mode = MapMode::triangle) {
  check_clipped_to(std::make_shared<const SurfaceIndex>(
                       index_surface(scene, landed_on(scene, photons), radius, 60)),
                   scene, photons, hits, radius, k, kernel, mode);
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
  for (int i = 0; i < corners; ++i) add_triangle(scene, centre, corner(i), corner(i + 1));
}

/// One region round a slit from `centre` along `u`: the triangle above it has the whole edge, those
/// below meet in a T-junction on it. And a needle of 6 degrees beside it.
void add_slit_and_needle(Scene& scene, const glm::vec3& centre, const glm::vec3& u,
                         const glm::vec3& v) {
  const auto at = [&](float x, float y) { return centre + x * u + y * v; };
  add_triangle(scene, at(0, 0), at(1, 0), at(0.5f, 1));
  add_triangle(scene, at(0, 0), at(0.5f, 1), at(-1, 0));
  add_triangle(scene, at(0, 0), at(-1, 0), at(0.5f, -1));
  add_triangle(scene, at(0, 0), at(0.5f, -1), at(0.4f, 0));
  add_triangle(scene, at(0.4f, 0), at(0.5f, -1), at(1, 0));
  add_triangle(scene, at(2, 0), at(3, 0), at(3, 0.1f));
}

/// Each corner of any triangle that lies on another one's border, as a hit on that one.
void add_hits_on_junctions(PrimaryHits& hits, const Scene& scene) {
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto corners = scene.corners(t);
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 a(corners[i]), b(corners[(i + 1) % 3]);
      for (const glm::vec3& vertex : scene.vertices) {
        const glm::dvec3 p(vertex);
        const double beside = glm::length(glm::cross(p - a, b - a)) / glm::length(b - a);
        const double along = glm::dot(p - a, b - a) / glm::dot(b - a, b - a);
        if (beside > 1e-5 || along < 0.01 || along > 0.99) continue;
        add_grey_hit(hits, vertex, oriented(t, 0));
      }
    }
  }
}

/// Each hit again, off its place by each of these lengths towards the middle of its triangle.
void add_hits_nearby(PrimaryHits& hits, const Scene& scene) {
  const std::size_t count = hits.position.size();
  for (const double length : {1e-6, 1e-5, 1e-4, 1e-3}) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto [a, b, c] = scene.corners(triangle_of(hits.oriented_face[i]));
      const glm::vec3 way = (a + b + c) / 3.0f - hits.position[i];
      add_grey_hit(hits, hits.position[i] + static_cast<float>(length) * glm::normalize(way),
                   hits.oriented_face[i]);
    }
  }
}

/// Each corner of each triangle, and the middle of each edge, as hits on that triangle.
PrimaryHits hits_on_vertices_and_edges(const Scene& scene) {
  PrimaryHits hits;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const auto corners = scene.corners(t);
    for (int i = 0; i < 3; ++i) {
      const glm::vec3& corner = corners[i];
      for (const glm::vec3& position : {corner, 0.5f * (corner + corners[(i + 1) % 3])}) {
        add_grey_hit(hits, position, oriented(t, 0));
      }
    }
  }
  return hits;
}

}  // namespace

TEST_CASE("clipped irradiance on plates of any triangulation equals the oracle's", "[long]") {
  for (const int cells : {1, 3, 40}) {
    Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0.3f, 1, 0}, cells}});
    const Photons photons = uniform_photons(scene, 6000, 51);
    const PrimaryHits hits = uniform_hits(scene, 300, 52);
    for (const DensityKernel kernel : all_density_kernels) {
      if (cells != 3 && kernel != DensityKernel::constant) continue;
      check_clipped(scene, photons, hits, 0.2, 50, kernel);
    }
    if (cells != 3) continue;
    for (const int k : {1, 16, 400}) {
      check_clipped(scene, photons, hits, 0.2, k, DensityKernel::constant);
    }
  }
}

TEST_CASE("clipped irradiance on vertices and edges to the last bit equals the oracle's") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0.3f, 1, 0}, 1},
                                 {{3, 0, 1}, {0.8f, 0.1f, 0.3f}, {-0.2f, 0.9f, 0.1f}, 3}});
  add_star(scene, {10, 20, 5}, {0.6f, 0.2f, 0.4f}, {0.1f, -0.7f, 0.3f}, 12);
  const Photons photons = uniform_photons(scene, 12'000, 51);
  const DensityKernel kernel = GENERATE(from_range(all_density_kernels));
  check_clipped(scene, photons, hits_on_vertices_and_edges(scene), 0.2, 50, kernel);
}

TEST_CASE(
    "slits, T-junctions and needles are clipped as by the oracle, at and near their corners") {
  Scene scene = empty_scene();
  add_slit_and_needle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_slit_and_needle(scene, {10, 3, 5}, {0.6f, 0.2f, 0.4f}, {-0.4f, 0.3f, 0.45f});
  const Photons photons = uniform_photons(scene, 12'000, 55);
  PrimaryHits hits = hits_on_vertices_and_edges(scene);
  add_hits_on_junctions(hits, scene);
  REQUIRE(hits.position.size() >= 2 * (6 * 6 + 1));
  add_hits_nearby(hits, scene);
  hits.pixel.resize(hits.position.size());
  check_clipped(scene, photons, hits, 0.2, 50, DensityKernel::constant);
}

TEST_CASE("clipped irradiance where surfaces bend out of the slab equals the oracle's", "[long]") {
  Scene scene = empty_scene();
  const glm::vec3 along(1, 0, 0);
  add_plate(scene, {0, 0, 0}, along, {0, 1, 0}, 4);
  // 24 degrees up, in triangles of which a disc holds many whole.
  add_plate(scene, {0, 1, 0}, along, {0, 0.9f, 0.4f}, 20);
  add_plate(scene, {0, -0.6f, -0.8f}, along, {0, 0.6f, 0.8f}, 4);  // 53 degrees down
  const Photons photons = uniform_photons(scene, 6'000, 57);
  const DensityKernel kernel = GENERATE(from_range(all_density_kernels));
  check_clipped(scene, photons, uniform_hits(scene, 150, 58), 0.3, 50, kernel);
}

TEST_CASE("a panel all under a plate counts whole for hits on it, and as nothing for those above") {
  Scene scene = empty_scene();
  // No wider than two radii: looked at triangle by triangle, by its own hits, too.
  add_plate(scene, {0, 0, 0}, {0.25f, 0, 0}, {0, 0.25f, 0}, 1);
  add_plate(scene, {-0.1f, -0.1f, 0.01f}, {0.5f, 0, 0}, {0, 0.5f, 0}, 1);
  const Photons photons = uniform_photons(scene, 1500, 61, false);
  const SurfaceIndex surface = index_surface(scene, landed_on(scene, photons), 0.2, 60);
  REQUIRE(surface.region[0] == PHOTILE_NO_REGION);
  REQUIRE(surface.open_fraction[oriented(0, 0)] == 0.0f);
  check_clipped(scene, photons, uniform_hits(scene, 100, 62, false), 0.2, 50,
                DensityKernel::constant);
}

TEST_CASE(
    "unlit regions of a floor are holes in it for hits on it and on a panel above, as by the "
    "oracle") {
  Scene scene = scene_of_plates(
      {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 1}, {{0.5f, 0.5f, 0.02f}, {1, 0, 0}, {0.1f, 0.8f, 0}, 1}});
  Photons photons;
  std::mt19937_64 random(65);
  const Photons everywhere = uniform_photons(scene, 20'000, 64, false);
  for (std::size_t i = 0; i < everywhere.size(); ++i) {
    const glm::vec3& p = everywhere.position[i];
    const bool is_covered = p.z == 0 && p.x > 0.5f && p.x < 1.6f && p.y > 0.5f && p.y < 1.3f;
    if (!is_covered) add_photon(photons, scene, p, everywhere.oriented_face[i], random);
  }
  photons = sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
  const PrimaryHits hits = uniform_hits(scene, 300, 66, false);
  const auto surface =
      std::make_shared<const SurfaceIndex>(index_surface(scene, photons, 0.15, 60));
  REQUIRE(surface->unlit_regions.size() >= 10);
  const auto is_dark = [&](std::size_t i) {
    return surface->component_at(hits.oriented_face[i], hits.position[i]) == PHOTILE_UNLIT_REGION;
  };
  std::size_t dark = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) dark += is_dark(i) ? 1 : 0;
  REQUIRE(dark >= 20);
  const DensityKernel kernel = GENERATE(from_range(all_density_kernels));
  check_clipped_to(surface, scene, photons, hits, 0.15, 50, kernel);

  // The maps of caustics have photons on few of the lit components. Where they have none on the
  // floor, the floor does not count as area, and its holes subtract none.
  Photons on_panel;
  for (std::size_t i = 0; i < photons.size(); ++i) {
    const glm::vec3& p = photons.position[i];
    if (p.z > 0) add_photon(on_panel, scene, p, photons.oriented_face[i], random);
  }
  on_panel = sort_by_oriented_face(std::move(on_panel), 2 * scene.triangle_count());
  PrimaryHits hits_on_panel;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!(hits.position[i].z > 0)) continue;
    hits_on_panel.position.push_back(hits.position[i]);
    hits_on_panel.oriented_face.push_back(hits.oriented_face[i]);
    hits_on_panel.diffuse_albedo.push_back(hits.diffuse_albedo[i]);
  }
  check_clipped_to(surface, scene, on_panel, hits_on_panel, 0.15, 400, kernel);
}

TEST_CASE("clipped irradiance on a torus equals the oracle's, coarse and fine, for every mode",
          "[slow]") {
  const auto [mode, kernel] =
      GENERATE(table<MapMode, DensityKernel>({{MapMode::triangle, DensityKernel::constant},
                                              {MapMode::patch, DensityKernel::constant},
                                              {MapMode::patch, DensityKernel::cone}}));
  for (const int rings : {24, 96}) {
    Scene scene = empty_scene(2);
    add_torus(scene, 1.0f, 0.4f, rings, rings / 2);
    const Photons photons = uniform_photons(scene, 20'000, 53);
    check_clipped(scene, photons, uniform_hits(scene, 200, 54), 0.3, 50, kernel, mode);
  }
}

TEST_CASE("clipped irradiance in the living room equals the oracle's", "[slow]") {
  Scene scene = load_scene(source_folder() / "scenes/living-room/living-room.gltf");
  for (Material& material : scene.materials) {  // no lobes
    material.specular = glm::vec3(0.0f);
    material.normal_texture = none;
  }
  const Photons photons = uniform_photons(scene, 60'000, 51);
  const DensityKernel kernel = GENERATE(from_range(all_density_kernels));
  check_clipped(scene, photons, uniform_hits(scene, 300, 52), 0.4, 50, kernel, MapMode::automatic);
}

}  // namespace photile::test
