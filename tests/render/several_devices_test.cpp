// Several devices that share a picture. That it is the picture of one is in tests/equal_bits.
#include <atomic>
#include <catch2/catch.hpp>
#include <thread>

#include "estimate/load_balance.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using test::room_camera;

/// Large enough for all rounds: the warm-up, the probe, and a share by throughput.
RenderParameters parameters() { return small_picture(30'000, 160, 120, 4); }

std::vector<Device> halves() { return open_devices({.selector = "/2"}); }

}  // namespace

TEST_CASE("the statistics name each device with its share") {
  const Scene scene = furnished_room(4);
  std::vector<Device> devices = halves();
  const auto result = render(scene, test::room_camera(), devices, parameters());
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
  CHECK_THROWS_AS(render(furnished_room(4), test::room_camera(), std::span<Device>(), parameters()),
                  UsageError);
}

}  // namespace photile::test
