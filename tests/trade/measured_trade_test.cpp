#include <catch2/catch.hpp>

#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/path_tracer.hpp"
#include "source_folder.hpp"
#include "test_device.hpp"
#include "tools/trade/trade.hpp"

namespace photile::test {
namespace {

struct Subject {
  Scene scene = load_scene(test::source_folder() / "scenes/cornell-box/cornell-box.obj");
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

  std::vector<TradePoint> measure(const TradeAxes& axes) {
    return measure_trade({scene, scene.cameras.front(), {&test::device(), 1}, mix, reference},
                         parameters, axes);
  }
};

}  // namespace

TEST_CASE("a trade has all pairs of photons and neighbours, and every other value alone") {
  Subject subject;
  TradeAxes axes;
  axes.photons = {10'000, 40'000};
  axes.neighbours = {10, 40, 160};
  axes.radius_scales = {0.5};
  axes.samples = {2, 4};
  axes.node_rays = {8};
  axes.maps = {MapMode::naive};
  const std::vector<TradePoint> points = subject.measure(axes);
  // The parameters themselves are rendered once more.
  REQUIRE(points.size() == 2 * 3 + 1 + 2 + 1 + 1 + 1);
  const auto count = [&](const char* varied) {
    return std::count_if(points.begin(), points.end(),
                         [&](const TradePoint& point) { return point.varied == varied; });
  };
  CHECK(count("photons and neighbours") == 6);
  CHECK(count("radius") == 1);
  CHECK(count("samples") == 2);
  CHECK(count("node rays") == 1);
  CHECK(count("maps") == 1);
  const TradePoint& base = points[6];
  CHECK(base.varied == "nothing");
  CHECK(points.back().used.radius == Approx(0.5 * base.used.radius));
  for (const TradePoint& point : points) {
    CHECK(point.first_picture_seconds > point.frame_seconds);
    CHECK(point.device_bytes > 0);
    CHECK(point.error.relative_mse > 0);
  }
}

TEST_CASE("in a trade of structures time differs, the picture does not") {
  Subject subject;
  TradeAxes axes;
  axes.structures.assign(all_map_structures.begin(), all_map_structures.end());
  const std::vector<TradePoint> points = subject.measure(axes);
  REQUIRE(points.size() == all_map_structures.size() + 1);
  for (const TradePoint& point : points) {
    CHECK(point.error.relative_mse == Approx(points[0].error.relative_mse).epsilon(1e-3));
  }
}

TEST_CASE("more neighbours make a noisy picture more right") {
  // At 40,000 paths a picture of k = 3 is mostly noise: variance 1 / (k - 2).
  Subject subject;
  TradeAxes axes;
  axes.photons = {40'000};
  axes.neighbours = {3, 30};
  const std::vector<TradePoint> points = subject.measure(axes);
  CHECK(points[0].error.relative_error() > 2 * points[1].error.relative_error());
}

TEST_CASE("a reference of another size is refused") {
  Subject subject;
  subject.parameters.film.width = 32;
  CHECK_THROWS_AS(subject.measure({}), UsageError);
}

}  // namespace photile::test
