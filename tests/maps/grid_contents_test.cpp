// The grids on the device against a host reference: every photon is in the maps that it must be in,
// in the cell that its projection falls in, in ascending order.
#include <catch2/catch.hpp>
#include <map>
#include <numeric>
#include <set>

#include "maps/build_steps.hpp"
#include "maps/map_shapes.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"
#include "photile/photon_maps.hpp"
#include "photon_sets.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

template <class T>
std::vector<T> download(const device::Buffer<T>& buffer) {
  std::vector<T> values(buffer.size());
  device::context_of(device()).read(buffer, std::span(values));
  return values;
}

/// Distance from a point to a triangle in double precision: to the plane where the foot of the
/// perpendicular lies inside, else to the nearest of the three edges.
double distance_to_triangle(glm::dvec3 p, const std::array<glm::vec3, 3>& corners) {
  const glm::dvec3 a = corners[0], b = corners[1], c = corners[2];
  const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const glm::dvec3 foot = p - normal * glm::dot(p - a, normal);
  const auto inside = [&](glm::dvec3 from, glm::dvec3 to) {
    return glm::dot(glm::cross(to - from, foot - from), normal) >= 0;
  };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return glm::length(p - foot);
  const auto to_edge = [&](glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 edge = to - from;
    const double t = glm::clamp(glm::dot(p - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
    return glm::length(p - (from + t * edge));
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

struct Contents {
  std::map<std::uint32_t, std::vector<std::uint32_t>> photons_of_map;
  bool cells_ascend = true;
  bool cells_agree = true;
  bool records_agree = true;
};

/// Whether a coordinate lies in a column or row, or beyond the grid at the border it is clamped to.
bool in_cell(double coordinate, double minimum, double size, std::uint32_t index,
             std::uint32_t count, double slack) {
  const double low = minimum + index * size - slack;
  const double high = minimum + (index + 1) * size + slack;
  return (index == 0 || coordinate >= low) && (index + 1 == count || coordinate <= high);
}

Contents read_contents(const PhotonMaps& photon_maps, const Photons& photons) {
  Contents contents;
  const std::span<const std::uint32_t> map_of = photon_maps.map_of();
  for (std::size_t i = 0; i < maps::store_of(photon_maps).pages.size(); ++i) {
    const maps::MapPage& page = maps::store_of(photon_maps).pages.use(i);
    const auto grids = download(page.grids);
    const auto cell_start = download(page.cell_start);
    const auto record_photon = download(page.record_photon);
    const auto position = download(page.record_position);
    const auto flux = download(page.record_flux);
    for (std::uint32_t map = page.first_map; map < page.last_map; ++map) {
      const PhotileGrid& grid = grids[map - page.first_map];
      const auto own = std::find(map_of.begin(), map_of.end(), map);  // without patches
      const auto oriented_face = static_cast<std::uint32_t>(own - map_of.begin());
      for (std::uint32_t cell = 0; cell < grid.columns * grid.rows; ++cell) {
        const std::uint32_t start = cell_start[grid.first_cell + cell];
        const std::uint32_t end = cell_start[grid.first_cell + cell + 1];
        for (std::uint32_t entry = start; entry < end; ++entry) {
          const std::uint32_t photon = record_photon[entry];
          contents.photons_of_map[oriented_face].push_back(photon);
          if (entry > start && record_photon[entry - 1] >= photon) contents.cells_ascend = false;
          const glm::dvec3 local = glm::dvec3(photons.position[photon]) -
                                   glm::dvec3(grid.origin_x, grid.origin_y, grid.origin_z);
          const double u = glm::dot(local, glm::dvec3(grid.u_axis_x, grid.u_axis_y, grid.u_axis_z));
          const double v = glm::dot(local, glm::dvec3(grid.v_axis_x, grid.v_axis_y, grid.v_axis_z));
          if (!in_cell(u, grid.minimum_u, grid.cell_width, cell % grid.columns, grid.columns,
                       grid.slack) ||
              !in_cell(v, grid.minimum_v, grid.cell_height, cell / grid.columns, grid.rows,
                       grid.slack)) {
            contents.cells_agree = false;
          }
          for (int c = 0; c < 3; ++c) {
            const std::size_t plane = c * std::size_t{page.record_stride} + entry;
            if (position[plane] != photons.position[photon][c] ||
                flux[plane] != photons.flux[photon][c]) {
              contents.records_agree = false;
            }
          }
        }
      }
    }
  }
  return contents;
}

///   given_up   the maps are built from photons that go on the way
void check_against_reference(const Scene& scene, const Photons& photons, double radius,
                             bool given_up = false) {
  const NeighbourGroups groups = find_neighbour_groups(scene, {radius, 60});
  const PhotonMaps photon_maps =
      given_up ? PhotonMaps(device(), scene, Photons(photons), groups, {radius, 4})
               : PhotonMaps(device(), scene, photons, groups, {radius, 4});
  Contents contents = read_contents(photon_maps, photons);
  CHECK(contents.cells_ascend);
  CHECK(contents.cells_agree);
  CHECK(contents.records_agree);

  const double cos_angle = std::cos(glm::radians(60.0));
  // Photons may be inserted a little beyond the radius, for their positions are rounded.
  float largest = 0;
  for (const glm::vec3& v : scene.vertices) {
    largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  const double reach = radius * 1.0001 + 10.0 * std::numeric_limits<float>::epsilon() * largest;
  std::uint64_t missing = 0, surplus = 0, references = 0;
  for (std::uint32_t map = 0; map < 2 * scene.triangle_count(); ++map) {
    const auto& found = contents.photons_of_map[map];
    const std::set<std::uint32_t> held(found.begin(), found.end());
    CHECK(held.size() == found.size());
    references += found.size();
    for (std::uint32_t photon = 0; photon < photons.size(); ++photon) {
      const std::uint32_t own = photons.oriented_face[photon];
      const bool agrees =
          own == map || normals_agree(face_normal(scene, own), face_normal(scene, map), cos_angle);
      const double distance =
          triangle_of(own) == triangle_of(map)
              ? 0.0
              : distance_to_triangle(photons.position[photon], scene.corners(triangle_of(map)));
      if (agrees && distance <= radius && !held.contains(photon)) ++missing;
      if ((!agrees || distance > reach) && held.contains(photon)) ++surplus;
    }
  }
  CHECK(missing == 0);
  CHECK(surplus == 0);
  CHECK(photon_maps.statistics().references == references);
}

TEST_CASE("the shared grid struct has the same size on the device as on the host") {
  auto& context = device::context_of(device());
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  const Photons photons = uniform_photons(scene, 100, 1, false);
  const PhotonMaps photon_maps(device(), scene, photons, find_neighbour_groups(scene, {0.1, 60}),
                               {0.1, 4});
  // A device that laid the struct out otherwise would not return the values it was sized with.
  const auto grids = download(maps::store_of(photon_maps).pages.use(0).grids);
  int with_photons = 0;
  for (const PhotileGrid& grid : grids) {
    if (grid.columns == 0) continue;
    ++with_photons;
    CHECK(grid.minimum_u == Approx(-0.1));
    CHECK(grid.inverse_cell_width * grid.cell_width == Approx(1.0));
    CHECK(grid.inverse_cell_height * grid.cell_height == Approx(1.0));
    CHECK(grid.cell_height == Approx(PHOTILE_CELL_ASPECT * grid.cell_width));
    CHECK(grid.u_axis_x * grid.u_axis_x + grid.u_axis_y * grid.u_axis_y == Approx(1.0));
  }
  CHECK(with_photons == 2);  // the front of either triangle
  context.finish();
}

TEST_CASE("grid contents equal the host reference on a folded plate") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3},
                                 {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 2},
                                 {{0, 0, -0.02f}, {1, 0, 0}, {0, 1, 0}, 1}});
  check_against_reference(scene, uniform_photons(scene, 3000, 11), 0.15, GENERATE(false, true));
}

TEST_CASE("grid contents equal the host reference on a torus, triangles smaller than the radius") {
  Scene scene = empty_scene(3);
  add_torus(scene, 1.0f, 0.4f, 24, 12);
  check_against_reference(scene, uniform_photons(scene, 2000, 12), 0.3);
}

TEST_CASE("grid contents equal the host reference far from the origin") {
  Scene scene = scene_of_plates({{{148376, 1234, -223423}, {4, 0, 1}, {0, 4, 1}, 3}});
  check_against_reference(scene, uniform_photons(scene, 1000, 13), 0.5);
}

TEST_CASE("a needle triangle and photons in one point are inserted like any other") {
  Scene scene = empty_scene();
  add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0.5f, 1e-6f, 0});
  add_plate(scene, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  std::mt19937_64 random(5);
  Photons photons;
  for (int i = 0; i < 500; ++i) add_photon(photons, scene, {0.5f, 0, 0}, 0, random);
  for (int i = 0; i < 500; ++i) {
    add_photon(photons, scene, random_point(scene, 1, random), 2, random);
  }
  check_against_reference(scene, sort_by_oriented_face(std::move(photons), 6), 0.2);
}

TEST_CASE("naive maps hold exactly the photons of their own oriented face") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4}});
  const Photons photons = uniform_photons(scene, 4000, 14);
  const PhotonMaps photon_maps(device(), scene, photons, naive_groups(scene), {0.2, 4});
  Contents contents = read_contents(photon_maps, photons);
  CHECK(photon_maps.statistics().references == photons.size());
  std::size_t photons_held = 0;
  for (const auto& [map, held] : contents.photons_of_map) {
    photons_held += held.size();
    CHECK(held.size() == photons.first_of[map + 1] - photons.first_of[map]);
    for (const std::uint32_t photon : held) CHECK(photons.oriented_face[photon] == map);
  }
  CHECK(photons_held == photons.size());
}

TEST_CASE("maps without any photon are built and empty") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  const Photons photons = sort_by_oriented_face(Photons{}, 4);
  const PhotonMaps photon_maps(device(), scene, photons, find_neighbour_groups(scene, {0.1, 60}),
                               {0.1, 4});
  CHECK(photon_maps.statistics().references == 0);
  CHECK(maps::store_of(photon_maps).pages.empty());
}

TEST_CASE("two builds give the same bits") {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.4f, 16, 8);
  const Photons photons = uniform_photons(scene, 50'000, 15);
  const NeighbourGroups groups = find_neighbour_groups(scene, {0.2, 60});
  const PhotonMaps first(device(), scene, photons, groups, {0.2, 4});
  const PhotonMaps second(device(), scene, photons, groups, {0.2, 4});
  REQUIRE(maps::store_of(first).pages.size() == maps::store_of(second).pages.size());
  for (std::size_t i = 0; i < maps::store_of(first).pages.size(); ++i) {
    CHECK(download(maps::store_of(first).pages.use(i).record_photon) ==
          download(maps::store_of(second).pages.use(i).record_photon));
    CHECK(download(maps::store_of(first).pages.use(i).cell_start) ==
          download(maps::store_of(second).pages.use(i).cell_start));
  }
}

TEST_CASE("photons that are given up leave the normals that kept ones do, and are gone") {
  Scene scene = empty_scene();
  add_torus(scene, 1.0f, 0.4f, 16, 8);
  const Photons photons = uniform_photons(scene, 50'000, 15);
  Photons given_up = photons;
  const NeighbourGroups groups = find_map_groups(scene, photons, MapMode::patch, {0.2, 60});
  const PhotonMaps kept(device(), scene, photons, groups, {0.2, 4});
  const PhotonMaps gone(device(), scene, std::move(given_up), groups, {0.2, 4});
  REQUIRE(kept.statistics().normal_filtered_maps > 0);
  CHECK(given_up.size() == 0);
  REQUIRE(maps::store_of(kept).pages.size() == 1);
  const maps::MapPage& first = maps::store_of(kept).pages.use(0);
  const maps::MapPage& second = maps::store_of(gone).pages.use(0);
  CHECK(download(first.record_position) == download(second.record_position));
  CHECK(download(first.record_flux) == download(second.record_flux));
  CHECK(download(first.record_normal) == download(second.record_normal));
}

TEST_CASE("a radius beyond the groups' or no number is refused") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  const Photons photons = uniform_photons(scene, 10, 1);
  const NeighbourGroups groups = find_neighbour_groups(scene, {0.1, 60});
  for (const double radius : {0.2, 0.0, -1.0, std::nan("")}) {
    CHECK_THROWS_AS(PhotonMaps(device(), scene, photons, groups, {radius, 4}), UsageError);
  }
}

device::KernelSet kernels() {
  return {device::context_of(device()), "shared/scan.cl", maps::group_defines(device().info())};
}

TEST_CASE("the device's prefix sum equals the host's for awkward sizes") {
  const device::KernelSet scan = kernels();
  auto& context = scan.context();
  for (const std::size_t size :
       {1u, 2u, 7u, 93u, 2047u, 2048u, 2049u, 4096u, (1u << 20) + 1u, 5u * 1024u * 1024u}) {
    std::mt19937 random(static_cast<unsigned>(size));
    std::vector<std::uint32_t> values(size);
    for (auto& value : values) value = random() % 500;
    std::vector<std::uint32_t> expected(size);
    std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0u);

    auto buffer = context.upload(std::span<const std::uint32_t>(values), "test values");
    maps::exclusive_prefix_sum(scan, buffer);
    std::vector<std::uint32_t> scanned(size);
    context.read(buffer, std::span(scanned));
    CAPTURE(size);
    CHECK(scanned == expected);
  }
}

TEST_CASE("the prefix sum of nothing is nothing") {
  const device::KernelSet scan = kernels();
  auto buffer = scan.context().allocate<std::uint32_t>(0, "test values");
  CHECK_NOTHROW(maps::exclusive_prefix_sum(scan, buffer));
}

// The density_ratio of photons against densities with a closed form.

/// Photons on the front of a unit plate of two triangles (or of more), only where x < lit.
Photons photons_on_part(const Scene& scene, float lit, std::size_t count) {
  std::mt19937_64 random(61);
  auto pick = by_area(scene);
  Photons photons;
  while (photons.size() < count) {
    const std::uint32_t triangle = pick(random);
    const glm::vec3 point = random_point(scene, triangle, random);
    if (point.x < lit) add_photon(photons, scene, point, oriented(triangle, 0), random);
  }
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
}

TEST_CASE("density_ratio is one over the part of a surface that is lit evenly") {
  const int cells = GENERATE(1, 32);  // large triangles are divided, small ones are bins themselves
  const float lit = GENERATE(1.0f, 0.5f, 0.25f);
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells}});
  const Photons photons = photons_on_part(scene, lit, 60'000);
  Patches patch;  // one for all
  patch.first_of = {0, static_cast<std::uint32_t>(scene.triangle_count())};
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    patch.members.push_back(oriented(t, 0));
    patch.map_of.insert(patch.map_of.end(), {0u, 1u});
  }
  const std::vector<float> density_ratio = maps::photon_density_ratio(scene, photons, patch);
  REQUIRE(density_ratio.size() == 2);
  // The squared density integrates to (1 / lit)^2 lit = 1 / lit of that of photons spread evenly.
  // Bins of 16 photons and more estimate it to within a percent; those that the border of the lit
  // part cuts, one column of at least 32, blur it by at most a thirtieth.
  CAPTURE(cells, lit);
  CHECK(density_ratio[0] == Approx(1.0 / lit).epsilon(0.04));
  CHECK(density_ratio[1] == 1.0f);  // no photons on the back
}

TEST_CASE("photons one by one crowd nothing") {
  Scene scene = scene_of_plates({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1}});
  for (const std::size_t count : {0u, 1u}) {
    const Photons photons = photons_on_part(scene, 1.0f, count);
    for (const float value : maps::photon_density_ratio(scene, photons, {})) CHECK(value == 1.0f);
  }
}

}  // namespace
}  // namespace photile::test
