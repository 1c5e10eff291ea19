// The bench on photons of files: every structure answers as a search in double precision does, and
// rows are as docs/bench-points.md says.
#include "support/point_bench.hpp"

#include <stdlib.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include "source_folder.hpp"
#include "structures/structure.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

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

}  // namespace

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
  CHECK(json["schema version"] == 1);
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
  std::set<std::string> expected{"nanoflann", "nanoflann-heap", "embree"};
  for (const structures::Structure& structure : structures::all()) {
    if (structure.global || structure.is_grid()) expected.insert(structure.name);
  }
  CHECK(structures == expected);
}

TEST_CASE("a bench on photons of files notices 17 times the flux") {
  const TemporaryFolder folder;
  const std::string file = "estimate/estimate_hit.clh", right = "1.0f / area";
  std::ifstream kernel(source_folder() / "kernels" / file);
  std::string text(std::istreambuf_iterator<char>(kernel), {});
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

}  // namespace photile::test
