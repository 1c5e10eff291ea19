#include "trade/trade.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "source_folder.hpp"
#include "test_device.hpp"

namespace photile::test {
namespace {

struct Subject {
  Scene scene = load_scene(source_folder() / "scenes/cornell-box/cornell-box.obj");
  LightMix mix = LightMix::of(scene, defaults::lumen_per_watt);
  RenderParameters parameters;
  Image reference;

  Subject() {
    parameters.photons.emitted_photons = 40'000;
    parameters.film.width = parameters.film.height = 48;
    parameters.film.samples_per_pixel = 1;
    PrimaryHitParameters film = eye_rays(parameters);
    film.samples_per_pixel = 256;
    reference = mixed_picture(trace_paths(scene, scene.cameras.front(), film).layers, mix)->root();
  }

  std::vector<trade::TradePoint> measure(const std::vector<trade::TradeSettings>& settings) {
    return trade::measure_trade({scene, scene.cameras.front(), {&device(), 1}, mix, reference},
                                settings);
  }
};

trade::TradePoint point(double seconds, double relative_error) {
  trade::TradePoint result;
  result.first_picture_seconds = seconds;
  result.error.relative_mse = relative_error * relative_error;
  return result;
}

}  // namespace

TEST_CASE("a trade has all pairs of photons and neighbours, and every other setting alone") {
  RenderParameters base;
  base.photons.emitted_photons = 40'000;
  base.neighbours = 48;
  base.kernel = DensityKernel::cone;
  std::map<std::string, int> count;
  std::set<std::pair<std::uint64_t, int>> pairs;
  for (const trade::TradeSettings& one : trade::settings_around(base)) {
    ++count[one.varied];
    const RenderParameters& p = one.parameters;
    if (one.varied == "photons and neighbours") {
      pairs.emplace(p.photons.emitted_photons, p.neighbours);
    } else if (one.varied != "work of good") {
      CHECK(p.photons.emitted_photons == 40'000);
      CHECK(p.neighbours == 48);
    }
    if (one.varied != "kernel") CHECK(p.kernel == DensityKernel::cone);
  }
  CHECK(pairs.size() == 16);
  CHECK(pairs.contains({2500, 3}));
  CHECK(pairs.contains({160'000, 192}));
  CHECK(count["nothing"] == 1);
  CHECK(count["kernel"] == 1);  // that which is not the one given
  CHECK(count["samples_per_pixel"] == 2);
  CHECK(count["work of good"] == 5);
}

TEST_CASE("each setting of a trade is rendered with, timed and compared") {
  Subject subject;
  RenderParameters other = subject.parameters;
  other.neighbours = 10;
  const std::vector<trade::TradePoint> points =
      subject.measure({{"nothing", subject.parameters}, {"neighbours", other}});
  REQUIRE(points.size() == 2);
  CHECK(points[1].settings.varied == "neighbours");
  CHECK(points[1].used.neighbours == 10);
  for (const trade::TradePoint& point : points) {
    CHECK(point.first_picture_seconds > point.frame_seconds);
    CHECK(point.device_bytes > 0);
    CHECK(point.error.relative_mse > 0);
  }
}

TEST_CASE("more neighbours make a noisy picture more right") {
  // At 40,000 paths a picture of k = 3 is mostly noise: variance 1 / (k - 2).
  Subject subject;
  RenderParameters few = subject.parameters, many = subject.parameters;
  few.neighbours = 3;
  many.neighbours = 30;
  const std::vector<trade::TradePoint> points = subject.measure({{"few", few}, {"many", many}});
  CHECK(points[0].error.relative_error() > 2 * points[1].error.relative_error());
}

TEST_CASE("the fastest settings within an error are found, or none") {
  const std::vector<trade::TradePoint> points{point(1, 0.10), point(3, 0.05), point(2, 0.07)};
  CHECK(trade::fastest_within(points, 0.5) == &points[0]);
  CHECK(trade::fastest_within(points, 0.08) == &points[2]);
  CHECK(trade::fastest_within(points, 0.05) == &points[1]);
  CHECK(trade::fastest_within(points, 0.04) == nullptr);
}

}  // namespace photile::test
