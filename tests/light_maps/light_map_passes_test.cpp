// Nodes that several photon passes value: means of all, the same bits in any order of looking.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "node_sources.hpp"
#include "photile/light_groups.hpp"
#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "photon_passes.hpp"
#include "render/pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

/// A formula for each pass.
class PassFormulas : public FormulaSource {
 public:
  explicit PassFormulas(const std::vector<Formula>& formulas) : FormulaSource(formulas.front()) {
    for (std::size_t i = 1; i < formulas.size(); ++i) {
      passes_.push_back(std::make_unique<FormulaSource>(formulas[i]));
    }
  }
  std::span<NodeSource* const> further() const override { return shown_; }
  void show(std::size_t further) {
    while (shown_.size() < further) shown_.push_back(passes_[shown_.size()].get());
  }

 private:
  std::vector<std::unique_ptr<FormulaSource>> passes_;
  std::vector<NodeSource*> shown_;
};

Scene floor_and_walls() { return with_one_lamp(test::furnished_room(2)); }

std::vector<FormulaSource::Formula> three_formulas() {
  return {[](const glm::vec3& p, std::uint32_t) { return 2 + std::sin(9 * p.x) * p.y; },
          [](const glm::vec3& p, std::uint32_t) { return 5 + p.z + std::cos(7 * p.x + p.y); },
          [](const glm::vec3& p, std::uint32_t) { return 1 + p.x * p.x + 3 * p.y; }};
}

PrimaryHits part_of(const PrimaryHits& hits, std::size_t first, std::size_t step) {
  PrimaryHits part;
  for (std::size_t i = first; i < hits.size(); i += step) {
    add_hit(part, hits.position[i], hits.sided_triangle[i]);
  }
  return part;
}

/// Cell corners alone: interpolation is left out.
double error_of_nodes(const LightMaps& maps, const std::vector<FormulaSource::Formula>& formulas) {
  double worst = 0;
  for (std::uint32_t node = 0; node < maps.statistics().nodes; ++node) {
    const auto& [position, side] = maps.point(node);
    double mean = 0;
    for (const auto& formula : formulas) mean += double{formula(position, side)};
    mean /= static_cast<double>(formulas.size());
    worst = std::max(worst, std::abs(double{maps.values().irradiance[node].x} / mean - 1));
  }
  return worst;
}

RenderParameters with_passes(int passes) {
  RenderParameters parameters = small_picture(30'000, 32, 24);
  parameters.light_maps = LightMapMode::on;
  parameters.passes = passes;
  return parameters;
}

/// Rows of many lights, a lamp and its copies side by side.
Scene lamps_in_rows() {
  Scene scene = test::furnished_room(2);
  add_lamps(scene, 20);
  return scene;
}

Camera from(double x) { return Camera::look_at({x, 0.3, 1.5}, {2, 2, 0.5}, {0, 0, 1}, 1.0); }

constexpr double no_bound = std::numeric_limits<double>::infinity();

/// Root of the mean squared relative error of a floor one metre below a lamp of 1 cd, (1 +
/// d^2)^(-3/2) at the distance d from the point below it, in a view of 1.6 x 1.6 m; quick frames of
/// so many passes of 50,000 photons.
double error_after(int passes) {
  Scene scene = test::plate(test::diffuse(glm::vec3(1.0f)), 6.0f, 3);
  scene.lights.push_back(test::point_light("lamp", {0, 0, 1}));
  RenderParameters parameters;
  parameters.photons.emitted_photons = 50'000u * static_cast<std::uint64_t>(passes);
  parameters.photons.max_path_length = 1;
  parameters.neighbours =
      100'000;  // the radius bounds the estimate, and with it the spacing of nodes
  parameters.radius = 0.32;
  parameters.passes = passes;
  parameters.light_maps = LightMapMode::on;
  constexpr int side = 20;
  SceneRenderer renderer(scene, std::span(&test::device(), 1), parameters);
  const Camera camera =
      Camera::look_at({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 2.0 * std::atan(0.8 / 4.0));
  std::vector<glm::vec3> picture(side * side);
  const float power = 4 * 3.14159265f;  // that makes 1 cd
  const std::vector<glm::vec3> powers(1, glm::vec3(power));
  renderer.draw(camera, {side, side, 1}, powers, no_bound, picture);
  double squares = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double u = 1.6 * ((x + 0.5) / side - 0.5), v = 1.6 * ((y + 0.5) / side - 0.5);
      const double expected = std::pow(1.0 + u * u + v * v, -1.5) / 3.14159265358979;
      const double error = double{picture[static_cast<std::size_t>(y * side + x)].x} / expected - 1;
      squares += error * error / (side * side);
    }
  }
  return std::sqrt(squares);
}

}  // namespace

TEST_CASE("Nodes hold the mean of all passes", "[light_map_passes]") {
  const Scene scene = floor_and_walls();
  PassFormulas source(three_formulas());
  LightMaps maps(scene, quiet_parameters(0.2));
  maps.fill(points_on(scene, 6), source, Progress::none());
  CHECK(error_of_nodes(maps, {three_formulas()[0]}) < 1e-6);
  source.show(2);
  CHECK(maps.refine(source, Progress::none(), 0) == 2 * maps.statistics().nodes);
  CHECK(maps.refine(source, Progress::none()) == 0);
  CHECK(error_of_nodes(maps, three_formulas()) < 1e-6);
}

TEST_CASE("Nodes hold the same bits whenever they came to be, and whenever passes did",
          "[light_map_passes]") {
  const Scene scene = floor_and_walls();
  const PrimaryHits hits = points_on(scene, 6);
  PassFormulas source(three_formulas());
  source.show(2);
  LightMaps at_once(scene, quiet_parameters(0.2));
  at_once.fill(hits, source, Progress::none());
  at_once.refine(source, Progress::none());
  const std::vector<float> expected = read_all(at_once, hits);

  PassFormulas late(three_formulas());
  LightMaps maps(scene, quiet_parameters(0.2));
  maps.fill(part_of(hits, 2, 3), late, Progress::none());
  late.show(1);
  maps.refine(late, Progress::none(), 100);  // in the middle of a pass
  maps.fill(part_of(hits, 0, 3), late, Progress::none(), 1);
  late.show(2);
  maps.refine(late, Progress::none(), 300);
  // Some are forgotten, and come back.
  std::vector<std::uint8_t> keep(maps.statistics().nodes);
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = i % 3 > 0 ? 1 : 0;
  maps.forget(keep);
  maps.fill(hits, late, Progress::none());
  while (maps.refine(late, Progress::none(), 1000) > 0) {
  }
  CHECK(maps.statistics().nodes == at_once.statistics().nodes);
  CHECK(read_all(maps, hits) == expected);
}

TEST_CASE("A pass that fails leaves nodes as they were", "[light_map_passes]") {
  const Scene scene = floor_and_walls();
  const PrimaryHits hits = points_on(scene, 3);
  std::vector<FormulaSource::Formula> formulas = three_formulas();
  bool fails = true;
  formulas[1] = [&, whole = formulas[1]](const glm::vec3& p, std::uint32_t side) {
    if (fails && p.x > 1) throw DeviceError("gone");
    return whole(p, side);
  };
  PassFormulas source(formulas);
  LightMaps maps(scene, quiet_parameters(0.2));
  maps.fill(hits, source, Progress::none());
  const std::vector<float> first = read_all(maps, hits);
  source.show(2);
  CHECK_THROWS_AS(maps.refine(source, Progress::none()), DeviceError);
  CHECK(read_all(maps, hits) == first);
  fails = false;
  CHECK(maps.refine(source, Progress::none()) == 0);
  CHECK(error_of_nodes(maps, three_formulas()) < 1e-6);
}

TEST_CASE("What was looked at before changes no bit of a picture of several passes",
          "[light_map_passes]") {
  for (const int rays : {0, 8}) {
    for (const Scene& scene : {test::furnished_room(2), lamps_in_rows()}) {
      RenderParameters parameters = with_passes(3);
      parameters.light_map_rays = rays;
      const std::span<Device> devices(&test::device(), 1);
      const LightLayers expected = render(scene, from(2), test::device(), parameters).layers;

      SceneRenderer whole(scene, devices, parameters);
      whole.render(from(0.5), parameters.film);
      CHECK(same_bits(whole.render(from(2), parameters.film).layers, expected));

      // Passes come one after another, and there are frames between them.
      SceneRenderer grown(scene, devices, parameters, nullptr, {}, Progress::none(),
                          SceneRenderer::Passes::first);
      const std::vector<glm::vec3> powers(light_groups_of(scene).groups.size(), glm::vec3(1.0f));
      std::vector<glm::vec3> grown_frame(24 * 16), frame(24 * 16);
      grown.draw(from(1), {24, 16, 1}, powers, no_bound, grown_frame);
      for (const int pass : {1, 2}) {
        grown.add(*grown.prepare_pass(pass, {}));
        grown.draw(from(pass), {24, 16, 1}, powers, 1e-4, grown_frame);
      }
      CHECK(same_bits(grown.render(from(2), parameters.film).layers, expected));
      grown.draw(from(1), {24, 16, 1}, powers, no_bound, grown_frame);
      whole.draw(from(1), {24, 16, 1}, powers, no_bound, frame);
      CHECK(grown_frame == frame);
    }
  }
}

TEST_CASE("Frames of a bounded time show all passes in the end", "[light_map_passes]") {
  const Scene scene = test::furnished_room(2);
  SceneRenderer renderer(scene, std::span(&test::device(), 1), with_passes(4));
  const std::vector<glm::vec3> powers(light_groups_of(scene).groups.size(), glm::vec3(1.0f));
  std::vector<glm::vec3> frame(24 * 16), expected(24 * 16);
  std::size_t frames = 0;
  while (renderer.draw(from(1), {24, 16, 1}, powers, 1e-3, frame).lacking > 0) {
    REQUIRE(++frames < 10'000);
  }
  CHECK(frames > 1);
  SceneRenderer at_once(scene, std::span(&test::device(), 1), with_passes(4));
  CHECK(at_once.draw(from(1), {24, 16, 1}, powers, no_bound, expected).lacking == 0);
  CHECK(frame == expected);
}

TEST_CASE("With more passes the error of frames falls as theory says", "[light_map_passes]") {
  const double one = error_after(1);
  CHECK(one > 0.03);  // there is something to lose
  // Slack as in photon_passes_test.cpp; the lattice is that of the first pass.
  for (const int passes : {4, 16}) {
    const double error = error_after(passes);
    CAPTURE(passes, one, error, error / one, predicted_of_passes(passes));
    CHECK(error < 1.25 * predicted_of_passes(passes) * one);
  }
}

}  // namespace photile::test
