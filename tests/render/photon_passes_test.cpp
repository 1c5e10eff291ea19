// Pictures from several photon passes: consistent, reproducible, bounded in memory.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include "photon_passes.hpp"

#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

RenderParameters small_parameters(int passes) {
  RenderParameters parameters = small_picture(30'000, 48, 36);
  parameters.passes = passes;
  return parameters;
}

RenderResult render_room(const RenderParameters& parameters) {
  static const Scene scene = test::furnished_room(4);
  return render(scene, test::room_camera(), test::device(), parameters);
}

std::uint64_t host_bytes(const RenderResult& result, const std::string& stage) {
  for (const StageStatistics& statistics : result.statistics) {
    if (statistics.stage == stage) return statistics.host_bytes;
  }
  throw std::out_of_range(stage);
}

/// Root of the mean squared relative error of the illuminance of a floor one metre below a lamp of
/// 1 cd, (1 + d^2)^(-3/2) at the distance d from the point below it, over the pixels of a view of
/// 1.6 x 1.6 m. `photons` for each pass.
double error_after(int passes, std::uint64_t photons, int neighbours, double radius) {
  Scene scene = test::plate(test::diffuse(glm::vec3(0.5f)), 6.0f, 3);
  scene.lights.push_back(test::point_light("lamp", {0, 0, 1}));
  const Camera camera =
      Camera::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(0.8 / 4.0));
  constexpr int side = 20;
  RenderParameters parameters;
  parameters.photons.emitted_photons = photons * static_cast<std::uint64_t>(passes);
  parameters.photons.max_path_length = 1;
  parameters.neighbours = neighbours;
  parameters.radius = radius;
  parameters.passes = passes;
  parameters.film.width = parameters.film.height = side;
  parameters.film.samples_per_pixel = 1;
  const LightLayers layers = render(scene, camera, test::device(), parameters).layers;
  double squares = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double u = 1.6 * ((x + 0.5) / side - 0.5), v = 1.6 * ((y + 0.5) / side - 0.5);
      const double expected = std::pow(1.0 + u * u + v * v, -1.5);
      const double lm = 4.0 * 3.14159265358979;  // that make 1 cd
      const auto pixel = static_cast<std::size_t>(y * side + x);
      const double error = lm * double{layers.layers[0].illuminance[pixel]} / expected - 1;
      squares += error * error / (side * side);
    }
  }
  return std::sqrt(squares);
}

/// The errors after 4, 16 and 64 passes against what theory leaves of that of one. Slack: a
/// quarter. The error of one pass is known to a few percent, since a view holds dozens of discs,
/// and terms of the bias beyond the second order make it a little less than in proportion to the
/// area.
void check_convergence(std::uint64_t photons, int neighbours, double radius) {
  const double one = error_after(1, photons, neighbours, radius);
  CHECK(one > 0.03);  // there is something to lose
  for (const int passes : {4, 16, 64}) {
    const double error = error_after(passes, photons, neighbours, radius);
    CAPTURE(passes, one, error, error / one, predicted_of_passes(passes));
    CHECK(error < 1.25 * predicted_of_passes(passes) * one);
  }
}

}  // namespace

TEST_CASE("with more passes the error falls as theory says, where k bounds the estimate") {
  // Where E photons fall on a square metre the disc of k has a radius of sqrt(k / pi E): here
  // 0.32 m below the lamp, and the radius lets it grow to 1 m.
  check_convergence(50'000, 1300, 1.0);
}

TEST_CASE("with more passes the error falls as theory says, where the radius bounds the estimate") {
  check_convergence(50'000, 100'000, 0.32);
}

TEST_CASE("one pass is the picture without passes") {
  CHECK(test::same_bits(render_room(small_parameters(1)).layers,
                        render_room(small_parameters(0)).layers));
}

TEST_CASE("passes on one, two and three threads render the same bits") {
  const LightLayers expected = render_room(small_parameters(3)).layers;
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    CHECK(test::same_bits(expected, render_room(small_parameters(3)).layers));
  }
}

TEST_CASE("passes share the photons and the samples of a pixel") {
  const RenderResult one = render_room(small_parameters(1));
  const RenderResult seven = render_room(small_parameters(7));
  CHECK(seven.used.passes == 7);
  CHECK(one.used.film.samples_per_pixel == 2);
  CHECK(seven.used.film.samples_per_pixel == 7);
  // The paths are the same, but that rounding may give a light one more or less.
  CHECK(static_cast<double>(seven.stored_photons) ==
        Approx(static_cast<double>(one.stored_photons)).epsilon(0.001));
}

TEST_CASE("photons in memory do not grow with the passes") {
  const auto render_passes = [](int passes) {
    RenderParameters parameters = small_parameters(passes);
    parameters.photons.emitted_photons *= static_cast<std::uint64_t>(passes);
    return render_room(parameters);
  };
  const RenderResult two = render_passes(2);
  const std::uint64_t device_peak = test::device().peak_allocated_bytes();
  const RenderResult ten = render_passes(10);
  CHECK(ten.stored_photons > 4.5 * static_cast<double>(two.stored_photons));
  // The lengths of 30,000 paths leave a deviation of 0.6% in what a pass stores.
  CHECK(static_cast<double>(host_bytes(ten, "trace photons")) <
        1.05 * static_cast<double>(host_bytes(two, "trace photons")));
  CHECK(static_cast<double>(test::device().peak_allocated_bytes()) <
        1.05 * static_cast<double>(device_peak));
}

TEST_CASE("more passes than paths still give every light a path in each") {
  RenderParameters parameters = small_parameters(20);
  parameters.photons.emitted_photons = 10;
  parameters.radius = 0.3;
  CHECK_NOTHROW(render_room(parameters));
}

TEST_CASE("a number of passes beyond the limit is refused") {
  CHECK_THROWS_AS(render_room(small_parameters(-1)), UsageError);
  CHECK_THROWS_AS(render_room(small_parameters(65'537)), UsageError);
}

}  // namespace photile::test
