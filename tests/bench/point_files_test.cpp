// Points of a file, timed; meshes, options and samples of the benches.

#include <catch2/catch.hpp>
#include <random>

#include "file_bytes.hpp"
#include "photile/load_scene.hpp"
#include "source_folder.hpp"
#include "structures/structure.hpp"
#include "support/bench_record.hpp"
#include "support/gltf_writer.hpp"
#include "support/hit_sample.hpp"
#include "support/point_bench.hpp"
#include "support/point_file.hpp"
#include "support/rivals.hpp"
#include "support/subdivision.hpp"
#include "support/workload.hpp"
#include "temporary_folder.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using bench::PointFile;
using bench::read_points;
using Catch::Contains;
using namespace bench;

// Points that a user brings: what files hold, and what is said of those that hold something else.

/// Writes an array as numpy.save does, by the format's description (NEP 1).
template <class Number>
std::string npy(const std::string& type, const std::string& order, const std::string& shape,
                const std::vector<Number>& numbers) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  header.append(63 - (10 + header.size()) % 64, ' ');
  header += '\n';
  std::string content("\x93NUMPY\x01\x00", 8);
  content += static_cast<char>(header.size() % 256);
  content += static_cast<char>(header.size() / 256);
  content += header;
  content.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
  return content;
}

TEST_CASE(
    "points of text and of both widths of NumPy's floats are read, with normals and without") {
  const TemporaryFolder folder;
  const PointFile text = read_points(
      put(folder.path / "a.csv", "x,y,z\n# a comment\n1, 2.5,-3e-2\n\n4;5;6\r\n7\t8 9"));
  CHECK(text.position == std::vector<glm::vec3>{{1, 2.5f, -0.03f}, {4, 5, 6}, {7, 8, 9}});
  CHECK(text.normal.empty());
  const PointFile single = read_points(put(
      folder.path / "a.npy", npy<float>("<f4", "False", "(2, 3)", {1, 2, 3, 0.1f, 0.2f, 0.3f})));
  CHECK(single.position == std::vector<glm::vec3>{{1, 2, 3}, {0.1f, 0.2f, 0.3f}});
  const PointFile twice = read_points(
      put(folder.path / "b.npy", npy<double>("<f8", "False", "(1, 6)", {1, 2, 3, 0, 0, -2})));
  CHECK(twice.position == std::vector<glm::vec3>{{1, 2, 3}});
  CHECK(twice.normal == std::vector<glm::vec3>{{0, 0, -1}});
}

TEST_CASE("files that hold no points are refused with what was found there") {
  const TemporaryFolder folder;
  const auto [name, content, message] = GENERATE(table<std::string, std::string, std::string>({
      {"a.csv", "", "holds no point"},
      {"a.csv", "x,y,z\n", "holds no point"},
      {"a.csv", "1,2,3\n1,2\n", "line 2 has 2 numbers"},
      {"a.csv", "1,2,3\nnone\n", "line 2: 'none'"},
      {"a.csv", "1,2,3\n1,2,3,0,0,1\n", "line 2 has 6 numbers, those before had 3"},
      {"a.csv", "1,2,inf\n", "line 1 has a number that is not finite"},
      {"a.csv", "1,2,3,0,0,0\n", "line 1 has a normal of no length"},
      {"a.txt", "1,2,3\n", "neither .npy nor .csv"},
      {"a.npy", "1,2,3\n", "is no NumPy array"},
      {"a.npy", npy<float>("<f4", "True", "(1, 3)", {1, 2, 3}), "columns one after the other"},
      {"a.npy", npy<int>("<i4", "False", "(1, 3)", {1, 2, 3}), "elements of type"},
      {"a.npy", npy<float>("<f4", "False", "(3,)", {1, 2, 3}), "has the shape"},
      {"a.npy", npy<float>("<f4", "False", "(1, 4)", {1, 2, 3, 4}), "has the shape"},
      {"a.npy", npy<float>("<f4", "False", "(2, 3)", {1, 2, 3}), "12 bytes for 2 rows"},
      {"a.npy", npy<float>("<f4", "False", "(0, 3)", {}), "holds no point"},
      {"a.npy", std::string("\x93NUMPY\x01\x00\xff\xff{'descr'", 18), "within its header"},
  }));
  CAPTURE(name, message);
  const auto file = put(folder.path / name, content);
  CHECK_THROWS_WITH(read_points(file), Contains(file.string()) && Contains(message));
  CHECK_THROWS_WITH(read_points(folder.path / "missing.npy"), Contains("no such file"));
}

// The bench on photons of files: every structure answers as a search in double precision does, and
// rows are as docs/kernels/points.md says.

/// Points near a saddle, with or without a normal.
void write_saddle(const std::filesystem::path& file, int count, unsigned seed, bool normals) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::ofstream out(file);
  for (int i = 0; i < count; ++i) {
    const double x = uniform(random), y = uniform(random);
    out << x << ',' << y << ',' << 0.3 * x * y;
    if (normals) out << ',' << -0.3 * y << ',' << -0.3 * x << ",1";
    out << '\n';
  }
}

TEST_CASE("every structure answers queries of files, and each row says what its schema promises") {
  const TemporaryFolder folder;
  const bool normals = GENERATE(false, true);
  write_saddle(folder.path / "photons.csv", 3000, 1, normals);
  write_saddle(folder.path / "queries.csv", 200, 2, normals);
  bench::BenchOptions options;
  options.repeats.most = 1;
  options.output = folder.path / "rows.json";
  options.device = "cpu";
  REQUIRE(bench::run_point_bench(options, {.photons = folder.path / "photons.csv",
                                           .queries = folder.path / "queries.csv",
                                           .neighbours = {20}}));
  const auto json = nlohmann::json::parse(std::ifstream(options.output));
  CHECK(json["schema version"] == 2);
  CHECK(json.contains("commit"));
  CHECK(json.contains("command line"));
  std::set<std::string> structures;
  for (const auto& row : json["results"]) {
    structures.insert(row["structure"].get<std::string>());
    CHECK(row["photons"] == 3000);
    CHECK(row["queries"] == 200);
    CHECK(row["radii that differ"] == 0);
    CHECK(row["irradiances that differ"] == 0);
    CHECK(row["bytes"] == 200 * (24 * 20 + 24));
    CHECK(row["GB/s"].get<double>() ==
          Approx(row["bytes"].get<double>() / row["seconds"]["median"].get<double>() / 1e9));
  }
  std::set<std::string> expected;
  for (const auto& [library, version] : bench::rival_versions()) expected.insert(library);
  for (const structures::Structure& structure : structures::all()) {
    if (structure.global || structure.is_grid()) expected.insert(structure.name);
  }
  CHECK(structures == expected);
}

TEST_CASE("a bench on photons of files notices 17 times the flux") {
  const TemporaryFolder folder;
  const std::string file = "estimate/estimate_hit.clh", right = "1.0f / area";
  std::string text = bytes_of(source_folder() / "kernels" / file);
  REQUIRE(text.find(right) != std::string::npos);
  text.insert(text.find(right), "17.0f * ");
  std::filesystem::create_directory(folder.path / "estimate");
  std::ofstream(folder.path / file) << text;
  write_saddle(folder.path / "photons.csv", 3000, 1, false);
  write_saddle(folder.path / "queries.csv", 200, 2, false);
  bench::BenchOptions options;
  options.repeats.most = 1;
  options.device = "cpu";
  const auto is_right = [&] {
    return bench::run_point_bench(options, {.photons = folder.path / "photons.csv",
                                            .queries = folder.path / "queries.csv",
                                            .neighbours = {20},
                                            .structures = {"uniform-grid"}});
  };
  ::setenv("PHOTILE_KERNEL_DIR", folder.path.c_str(), 1);
  const bool with_fault = is_right();
  ::unsetenv("PHOTILE_KERNEL_DIR");
  CHECK_FALSE(with_fault);
  CHECK(is_right());
}

// What every bench understands.

TEST_CASE("a quick bench repeats once, or as often as it is told") {
  const auto [arguments, repeats] = GENERATE(table<std::string, int>(
      {{"--quick", 1}, {"--quick --repeats 3", 3}, {"--repeats 3 --quick", 3}, {"", 5}}));
  INFO(arguments);
  BenchOptions options;
  CLI::App command;
  add_options(command, options);
  command.parse(arguments);
  CHECK(options.repeats.most == repeats);
}

// Which hits slow cases of the knn bench are asked.

TEST_CASE("block samples hold every n-th block, and those of every multiple of n") {
  const PrimaryHits hits = bench::plane_workload(5000).hits;
  CHECK(bench::block_sample(hits, 1).index.size() == 5000);
  const bench::HitSample half = bench::block_sample(hits, 2);
  const bench::HitSample eighth = bench::block_sample(hits, 8);
  // Blocks of 256: 0, 2, ... 18 of 19 whole ones and a last of 136; of these 0, 8, 16.
  CHECK(half.index.size() == 10 * 256);
  CHECK(eighth.index.size() == 3 * 256);
  CHECK(std::includes(half.index.begin(), half.index.end(), eighth.index.begin(),
                      eighth.index.end()));
  std::size_t different = 0;
  for (std::size_t i = 0; i < half.index.size(); ++i) {
    different += half.hits.position[i] != hits.position[half.index[i]];
    different += half.hits.oriented_face[i] != hits.oriented_face[half.index[i]];
  }
  CHECK(different == 0);
}

TEST_CASE("a thinned sample keeps its places in the whole") {
  const PrimaryHits hits = bench::plane_workload(5000).hits;
  const bench::HitSample sample = bench::thinned(bench::block_sample(hits, 4), 100);
  REQUIRE(sample.index.size() <= 100);
  CHECK(sample.index.size() > 50);
  CHECK(sample.hits.size() == sample.index.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < sample.index.size(); ++i) {
    different += sample.hits.position[i] != hits.position[sample.index[i]];
  }
  CHECK(different == 0);
}

// The meshes that the scale bench makes and writes.

double area(const Scene& scene) {
  double sum = 0;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) sum += triangle_area(scene, t);
  return sum;
}

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

}  // namespace
}  // namespace photile::test
