// The tuner: the search ends at the optimum, memory is bounded, choices survive on disk or are
// ignored.
#include "estimate/tuner.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>

#include "estimate/specialisation.hpp"
#include "estimate/tuning.hpp"
#include "estimate/tuning_search.hpp"
#include "estimate/tuning_store.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "temporary_folder.hpp"
#include "test_device.hpp"

namespace photile::test {

using namespace photile::estimate;

namespace {

constexpr SceneNeeds one_light{.light_count = 1};
constexpr SceneNeeds several_lights{.light_count = 5};
constexpr SceneNeeds glossy{.glossy = true, .light_count = 5};

DeviceInfo device_of_type(DeviceType type) {
  DeviceInfo info;
  info.type = type;
  info.max_work_group_size = 1024;
  return info;
}

/// Not what any device ships with.
constexpr EstimateTuning unusual{EstimateStrategy::tile, 4, 8, 16, 2.0f};

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("a stored tuning is read again, for scenes like those it was stored for only") {
  const TemporaryFolder folder;
  const auto file = tuning_file(folder.path, test::device().info());
  CHECK_FALSE(read_tuning(file, one_light));
  write_tuning(file, one_light, unusual);
  CHECK(read_tuning(file, one_light) == unusual);
  CHECK_FALSE(read_tuning(file, several_lights));
  CHECK_FALSE(read_tuning(file, glossy));
  const EstimateTuning other = shipped_tuning(test::device().info());
  write_tuning(file, glossy, other);
  CHECK(read_tuning(file, glossy) == other);
  CHECK(read_tuning(file, one_light) == unusual);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("devices and drivers have tunings of their own") {
  DeviceInfo info = test::device().info();
  const auto file = tuning_file("folder", info);
  info.driver_version += " next";
  CHECK(tuning_file("folder", info) != file);
  info = test::device().info();
  info.name += " other";
  CHECK(tuning_file("folder", info) != file);
}

TEST_CASE("a tuning of other kernels, or a damaged file, counts as none and can be replaced") {
  const TemporaryFolder folder;
  const auto file = folder.path / "tuning.json";
  write_tuning(file, one_light, unusual);
  const std::string good = read_text(file);
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    REQUIRE(text.find(from) != std::string::npos);
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string hash = good.substr(good.find("\"kernels\": \"") + 12, 32);
  const std::string damaged[] = {
      "",
      "no JSON",
      "[]",
      "{}",
      "null",
      std::string(100'000, '['),
      good.substr(0, good.size() / 2),
      replaced(hash, std::string(32, '0')),
      replaced("\"variants\": {", "\"variants\": [{},{\"x\":{") + "]}",
      replaced("\"tile\"", "\"other\""),
      replaced("\"tile\"", "7"),
      replaced("\"vector_width\": 4", "\"vector_width\": 5"),
      replaced("\"vector_width\": 4", "\"vector_width\": 4e300"),
      replaced("\"hits_per_item\": 8", "\"hits_per_item\": -8"),
      replaced("\"hits_per_item\": 8", "\"hits\": 8"),
      replaced("\"work_group_size\": 16", "\"work_group_size\": 1e4"),
      replaced("\"work_group_size\": 16", "\"work_group_size\": 100000"),
      replaced("\"photons_per_cell\": 2.0", "\"photons_per_cell\": 0"),
      replaced("\"photons_per_cell\": 2.0", "\"photons_per_cell\": null"),
      replaced("\"private_distances\": false", "\"private_distances\": 2")};
  for (const std::string& text : damaged) {
    CAPTURE(text.substr(0, 400));
    write_text(file, text);
    CHECK_FALSE(read_tuning(file, one_light));
    write_tuning(file, one_light, unusual);
    CHECK(read_tuning(file, one_light) == unusual);
  }
}

TEST_CASE("a tuning file that cannot be written is an error that names it") {
  const TemporaryFolder folder;
  const auto file = folder.path / "missing" / "tuning.json";
  CHECK_THROWS_WITH(write_tuning(file, one_light, unusual),
                    Catch::Matchers::Contains(file.string()));
  CHECK_THROWS_AS(write_tuning(file, one_light, unusual), OutputError);
}

TEST_CASE("no work-group uses more private memory than allowed, whatever the tuning and k") {
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    if (strategy == EstimateStrategy::lanes) continue;  // keeps it in local memory
    for (const int width : vector_widths) {
      for (const int group : {1, 16, 64, 256}) {
        for (const int k : {1, 50, 256, 257, 1008, limits::max_neighbours}) {
          for (const SceneNeeds& needs : {one_light, several_lights, glossy}) {
            const Specialisation choice = specialise({strategy, width, 16, group}, needs, k);
            CHECK(choice.private_bytes() >= 4u * static_cast<unsigned>(std::min(k, 256)));
            CHECK(choice.work_group_size >= 1);
            CHECK(choice.work_group_size * choice.private_bytes() <= 512u * 1024);
          }
        }
      }
    }
  }
}

TEST_CASE("groups of lanes keep to the local memory that every device has, or are none") {
  const SceneNeeds many_lights{.glossy = true, .light_count = 300};
  for (const int width : lane_widths) {
    for (const int k : {1, 50, 1000, 3000, 10'000, limits::max_neighbours}) {
      for (const SceneNeeds& needs : {one_light, several_lights, glossy, many_lights}) {
        const Specialisation choice =
            specialise({EstimateStrategy::lanes, width, 4, width}, needs, k);
        CAPTURE(width, k, needs.light_count);
        CHECK(choice.local_bytes() <= 32u * 1024);
        const bool lanes = choice.strategy == EstimateStrategy::lanes;
        if (lanes) CHECK(choice.work_group_size == static_cast<std::size_t>(width));
        if (k <= 1000) CHECK(lanes);
        if (lanes) CHECK(choice.capacity % width == 0);
      }
    }
  }
}

TEST_CASE("devices that are no CPUs work in lanes, as many as they run in step") {
  DeviceInfo gpu = device_of_type(DeviceType::gpu);
  for (const auto& [in_step, width] : std::vector<std::pair<std::uint32_t, int>>{
           {0, 32}, {8, 32}, {16, 16}, {32, 32}, {64, 64}, {128, 32}}) {
    gpu.lanes = in_step;
    CHECK(shipped_tuning(gpu).strategy == EstimateStrategy::lanes);
    CHECK(shipped_tuning(gpu).vector_width == width);
    CHECK(tuning_problem(shipped_tuning(gpu)).empty());
  }
  gpu.lanes = 64;
  gpu.max_work_group_size = 32;
  CHECK(shipped_tuning(gpu).vector_width == 32);
  gpu.max_work_group_size = 8;
  CHECK(shipped_tuning(gpu).strategy == EstimateStrategy::select);
  CHECK(shipped_tuning(device_of_type(DeviceType::cpu)).strategy == EstimateStrategy::select);
}

TEST_CASE("every alternative differs in its parameter, has a kernel, and keeps to the memory") {
  for (const DeviceType type : {DeviceType::cpu, DeviceType::gpu}) {
    for (const SceneNeeds& needs : {one_light, several_lights, glossy}) {
      for (const int k : {16, 50, 500}) {
        std::vector<EstimateTuning> tunings{shipped_tuning(device_of_type(type))};
        for (std::size_t i = 0; i < tunings.size() && i < 200; ++i) {
          const EstimateTuning from = tunings[i];
          for (const TuningParameter parameter : all_tuning_parameters) {
            for (const EstimateTuning& tuning : alternatives(parameter, from, needs, k)) {
              CHECK(tuning_problem(tuning).empty());
              CHECK_FALSE(tuning == from);
              const Specialisation choice = specialise(tuning, needs, k);
              CHECK(choice.strategy == tuning.strategy);
              CHECK(choice.work_group_size == static_cast<std::size_t>(tuning.work_group_size));
              if (std::find(tunings.begin(), tunings.end(), tuning) == tunings.end()) {
                tunings.push_back(tuning);
              }
            }
          }
        }
      }
    }
  }
}

TEST_CASE("the search finds the optimum of a cost that is separable in the parameters") {
  const EstimateTuning optimum{EstimateStrategy::select, 8, 64, 16, 2.0f};
  std::vector<EstimateTuning> asked;
  const TuningCost cost = [&](const EstimateTuning& tuning) {
    asked.push_back(tuning);
    double time = tuning.strategy == optimum.strategy ? 1.0 : 3.0;
    time += std::abs(std::log2(tuning.vector_width / 8.0));
    time += std::abs(std::log2(tuning.hits_per_item / 64.0));
    time += std::abs(std::log2(tuning.work_group_size / 16.0));
    return time + std::abs(std::log2(tuning.photons_per_cell / 2.0));
  };
  for (const DeviceType type : {DeviceType::cpu, DeviceType::gpu}) {
    asked.clear();
    const EstimateTuning start = shipped_tuning(device_of_type(type));
    CHECK(search_tuning(start, one_light, 50, cost, 0.03) == optimum);
    CHECK(asked.front() == start);
    for (std::size_t i = 0; i < asked.size(); ++i) {
      CHECK(std::count(asked.begin(), asked.end(), asked[i]) == 1);
    }
  }
}

TEST_CASE("the search follows a strategy whose gain shows at another width only") {
  const TuningCost cost = [](const EstimateTuning& tuning) {
    const bool tile = tuning.strategy == EstimateStrategy::tile;
    return tile ? 1.0 + std::abs(tuning.vector_width - 4) : 20.0;
  };
  const auto best =
      search_tuning(shipped_tuning(device_of_type(DeviceType::gpu)), one_light, 50, cost, 0.03);
  CHECK(best.strategy == EstimateStrategy::tile);
  CHECK(best.vector_width == 4);
}

TEST_CASE("the search stays where nothing gains enough, or nothing else runs") {
  const EstimateTuning start = shipped_tuning(device_of_type(DeviceType::cpu));
  const TuningCost noise = [&](const EstimateTuning& tuning) {
    return tuning == start ? 1.0 : 0.98;
  };
  CHECK(search_tuning(start, one_light, 50, noise, 0.03) == start);
  const TuningCost alone = [&](const EstimateTuning& tuning) {
    return tuning == start ? 1.0 : std::numeric_limits<double>::infinity();
  };
  CHECK(search_tuning(start, one_light, 50, alone, 0.03) == start);
  const TuningCost nothing = [](const EstimateTuning&) {
    return std::numeric_limits<double>::infinity();
  };
  CHECK(search_tuning(start, one_light, 50, nothing, 0.03) == start);
}

TEST_CASE(
    "tuning a device times what it chooses, and chooses nothing slower than what is shipped") {
  const auto result = tune_on_sample(test::device(), one_light, 16, {4000, 32}, Progress::none());
  REQUIRE_FALSE(result.trials.empty());
  CHECK(result.trials.front().tuning == shipped_tuning(test::device().info()));
  const auto chosen =
      std::find_if(result.trials.begin(), result.trials.end(),
                   [&](const TuningTrial& trial) { return trial.tuning == result.best; });
  REQUIRE(chosen != result.trials.end());
  CHECK(chosen->microseconds_per_hit <= result.trials.front().microseconds_per_hit);
  std::set<EstimateStrategy> strategies;
  for (const TuningTrial& trial : result.trials) {
    CHECK(trial.microseconds_per_hit > 0);
    if (std::isfinite(trial.microseconds_per_hit)) strategies.insert(trial.tuning.strategy);
  }
  // A CPU's vectors are no lanes, and their kernels are not compiled for it.
  CHECK(strategies == std::set<EstimateStrategy>{EstimateStrategy::select, EstimateStrategy::heap,
                                                 EstimateStrategy::tile});
}

TEST_CASE("the tuner's sample holds what it says and is the same every time") {
  const auto sample = make_tuning_sample(glossy, 50, {1000, 10});
  CHECK(sample.photons.size() == 1000);
  REQUIRE(sample.hits.size() == 100);
  CHECK(needs_of(sample.scene).glossy);
  CHECK(needs_of(sample.scene).light_count == 5);
  CHECK(std::is_sorted(sample.hits.sided_triangle.begin(), sample.hits.sided_triangle.end()));
  CHECK(make_tuning_sample(glossy, 50, {1000, 10}).photons.position == sample.photons.position);
  // The k-th of n uniform photons on the unit square lies at sqrt(k / (pi n)) on average.
  CHECK(sample.radius == Approx(2 * std::sqrt(50 / (3.14159265358979 * 1000))));
}

TEST_CASE("tuning for an impossible k is refused") {
  CHECK_THROWS_AS(tune_estimate(test::device(), one_light, 0), UsageError);
}

}  // namespace photile::test
