// `photile validate`: the table, the JSON and the exit codes.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "child_process.hpp"
#include "file_folder.hpp"

namespace photile::test {

using Catch::Contains;

TEST_CASE("validate prints expected, measured and error, and says the same in JSON") {
  const FileFolder folder;
  const Outcome outcome = run_photile({"validate", "--case", "point light", "--integrator", "path",
                                       "--paths", "100", "--json", folder / "readings.json"});
  INFO(outcome.errors);
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.output, Contains("expected") && Contains("point light over a surface") &&
                                 Contains("below the lamp") && Contains("ok"));
  const auto record = nlohmann::json::parse(folder.read("readings.json"));
  CHECK(record["seeds"] == 16);
  REQUIRE(record["readings"].size() == 4);
  for (const auto& reading : record["readings"]) {
    CHECK(reading["unit"] == "lx");
    CHECK(reading["path"]["verdict"] == "ok");
    CHECK(reading["path"]["value"] == Approx(reading["expected"].get<double>()).epsilon(0.001));
    CHECK_FALSE(reading.contains("photon_map"));
  }
}

TEST_CASE("readings that are too noisy for 1% make validate fail") {
  const Outcome outcome = run_photile(
      {"validate", "--case", "opposed", "--photons", "1000", "-k", "5", "--paths", "1", "--quiet"});
  CHECK(outcome.exit_code == 1);
  CHECK_THAT(outcome.output, Contains("too noisy"));
  CHECK_THAT(last_error(outcome, 1), Contains("1 of 1 readings") && Contains("--photons"));
}

TEST_CASE("an unknown case is a usage error that lists those there are") {
  CHECK_THAT(only_error(run_photile({"validate", "--case", "moonlight"}), 2),
             Contains("moonlight") && Contains("integrating sphere"));
}

}  // namespace photile::test
