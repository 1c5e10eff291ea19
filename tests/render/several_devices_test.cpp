// Several devices that share a picture. That it is the picture of one is in tests/equal_bits.
#include <atomic>
#include <thread>

#include "estimate/load_balance.hpp"
#include "photile/errors.hpp"
#include "pictures.hpp"

namespace photile::test {
namespace {

/// Large enough for all rounds: the warm-up, the probe, and a share by throughput.
RenderParameters parameters() { return small_picture(30'000, 160, 120, 4); }

std::vector<Device> halves() { return open_devices({.selector = "/2"}); }

TEST_CASE("the statistics name each device with its share") {
  const Scene scene = furnished_room(4);
  std::vector<Device> devices = halves();
  const auto result = render(scene, room_camera(), devices, parameters());
  const auto stage = std::find_if(result.statistics.begin(), result.statistics.end(),
                                  [](const auto& s) { return s.stage == "radiance estimate"; });
  REQUIRE(stage != result.statistics.end());
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const std::string name = "share of " + devices[i].info().id + " " + devices[i].info().name;
    const auto figure = std::find_if(stage->figures.begin(), stage->figures.end(),
                                     [&](const auto& f) { return f.first == name; });
    REQUIRE(figure != stage->figures.end());
    CHECK(figure->second == result.device_fractions[i]);
    CHECK(figure->second > 0);
  }
  CHECK(result.device_fractions[0] + result.device_fractions[1] == Approx(1));
}

TEST_CASE("the error of one device names it, stops the others and hides their interruption") {
  std::vector<Device> devices = halves();
  const std::size_t failing = GENERATE(0u, 1u);
  std::atomic<int> stopped = 0;
  const auto work = [&](std::size_t i, Progress& progress) {
    if (i == failing) throw DeviceError("clFinish failed", -36);
    while (!progress.cancelled()) std::this_thread::yield();
    ++stopped;
    progress.throw_if_cancelled();
  };
  try {
    estimate::for_each_device(devices, Progress::none(), work);
    FAIL("no error");
  } catch (const DeviceError& error) {
    CHECK_THAT(error.what(),
               Catch::StartsWith(devices[failing].info().id) && Catch::EndsWith("clFinish failed"));
    CHECK(error.status == -36);
  }
  CHECK(stopped == 1);
}

TEST_CASE("a device without memory is told from one that fails") {
  std::vector<Device> devices = halves();
  const auto work = [](std::size_t i, Progress&) {
    if (i == 1) throw DeviceMemoryError("no memory", -4);
  };
  CHECK_THROWS_AS(estimate::for_each_device(devices, Progress::none(), work), DeviceMemoryError);
}

TEST_CASE("a wish to stop reaches every device") {
  struct Cancelled : Progress {
    bool cancelled() const override { return true; }
  } progress;
  std::vector<Device> devices = halves();
  std::atomic<int> heard = 0;
  CHECK_THROWS_AS(estimate::for_each_device(devices, progress,
                                            [&](std::size_t, Progress& shared) {
                                              heard += shared.cancelled();
                                              shared.throw_if_cancelled();
                                            }),
                  Interrupted);
  CHECK(heard == 2);
}

TEST_CASE("only the first of several devices tells its progress") {
  struct Listener : Progress {
    std::atomic<int> begun{0}, units{0}, ended{0};
    void begin(std::string_view, std::uint64_t, std::string_view) override { ++begun; }
    void advance(std::uint64_t count) override { units += static_cast<int>(count); }
    void end() override { ++ended; }
  } listener;
  std::vector<Device> devices = halves();
  estimate::for_each_device(devices, listener, [](std::size_t, Progress& shared) {
    shared.begin("stage", 3, "units");
    shared.advance(3);
    shared.end();
  });
  CHECK(listener.begun == 1);
  CHECK(listener.units == 3);
  CHECK(listener.ended == 1);
}

TEST_CASE("rendering on no device is refused") {
  CHECK_THROWS_AS(render(furnished_room(4), room_camera(), std::span<Device>(), parameters()),
                  UsageError);
}

// The share of each device follows its throughput.

constexpr std::size_t many = 1'000'000;

/// A balance after its first two rounds, on devices that take so many seconds for a hit.
estimate::LoadBalance measured(const std::vector<double>& seconds_per_hit) {
  estimate::LoadBalance balance(seconds_per_hit.size());
  for (int round = 0; round < 2; ++round) {
    const std::vector<std::size_t> cuts = balance.cuts(balance.round(many));
    for (std::size_t i = 0; i < seconds_per_hit.size(); ++i) {
      const std::size_t hits = cuts[i + 1] - cuts[i];
      // Compiling the kernels takes the first round 10 s on the last device.
      const double compiling = round == 0 && i + 1 == seconds_per_hit.size() ? 10 : 0;
      balance.record(i, hits, compiling + seconds_per_hit[i] * static_cast<double>(hits));
    }
    balance.end_round();
  }
  return balance;
}

TEST_CASE("one device takes all hits at once") {
  const estimate::LoadBalance balance(1);
  CHECK(balance.round(many) == many);
  CHECK(balance.cuts(many) == std::vector<std::size_t>{0, many});
}

TEST_CASE("the first hits are few and shared evenly") {
  const estimate::LoadBalance balance(4);
  const std::size_t hits = balance.round(many);
  CHECK(hits < many / 10);
  CHECK(balance.cuts(hits) == std::vector<std::size_t>{0, hits / 4, hits / 2, 3 * hits / 4, hits});
  CHECK(balance.round(3) == 3);
}

TEST_CASE("measured devices share hits by their throughput, whatever compiling took") {
  const estimate::LoadBalance balance = measured({1e-6, 3e-6, 6e-6});
  CHECK(balance.round(many) == many);
  // Throughputs of 6 : 2 : 1.
  const std::vector<std::size_t> cuts = balance.cuts(900);
  CHECK(cuts == std::vector<std::size_t>{0, 600, 800, 900});
}

TEST_CASE("cuts ascend from nothing to all hits, for any number of hits") {
  const estimate::LoadBalance balance = measured({1e-6, 1.0, 1e-6, 2e-6});
  for (const std::size_t count : {0u, 1u, 2u, 3u, 5u, 1000u}) {
    const std::vector<std::size_t> cuts = balance.cuts(count);
    REQUIRE(cuts.size() == 5);
    CHECK(cuts.front() == 0);
    CHECK(cuts.back() == count);
    CHECK(std::is_sorted(cuts.begin(), cuts.end()));
  }
}

TEST_CASE("where no time was measured all devices share evenly") {
  const estimate::LoadBalance balance = measured({0.0, 1e-6});
  CHECK(balance.cuts(100) == std::vector<std::size_t>{0, 50, 100});
}

TEST_CASE("shares count every hit") {
  estimate::LoadBalance balance(2);
  CHECK(balance.fractions() == std::vector<double>{0, 0});
  balance.record(0, 30, 1);
  balance.record(1, 10, 1);
  balance.end_round();
  CHECK(balance.fractions() == std::vector<double>{0.75, 0.25});
}

}  // namespace
}  // namespace photile::test
