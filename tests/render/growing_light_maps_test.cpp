// Light maps that grow in rounds: what rounds lead to, and how much better it is.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include <tbb/global_control.h>

#include "pictures.hpp"
#include "render/refinement.hpp"

namespace photile::test {
namespace {

/// A part of little work.
RenderParameters little_work() {
  RenderParameters parameters = small_picture(10'000, 32, 24, 2);
  parameters.neighbours = 50;
  parameters.light_map_rays = 16;
  return parameters;
}

/// What rounds lead to.
RenderResult grown(const Scene& scene, const RenderParameters& part, int parts) {
  RenderSession session(std::make_shared<const PreparedScene>(scene), {&device(), 1}, part,
                        Progress::none());
  const Camera camera = room_camera();
  const HitSource hits = camera_hits(camera);
  RenderResult result;
  refine({.parts = parts},
         {.add =
              [&](int more, Progress& progress) {
                session.add_parts(more, progress);
                result = session.render(hits, session.film(), progress);
                return result.standard_error;
              }},
         Progress::none());
  return result;
}

/// Mean squared difference of the mix of all lights, relative to its squared mean.
double squared_error(const LightLayers& picture, const LightLayers& reference) {
  const auto mixed = [](const LightLayers& layers) {
    std::vector<double> mix(layers.layers.front().radiance.size());
    for (const auto& layer : layers.layers) {
      for (std::size_t i = 0; i < mix.size(); ++i) {
        mix[i] += luminance(glm::dvec3(layer.radiance[i]));
      }
    }
    return mix;
  };
  const std::vector<double> found = mixed(picture), truth = mixed(reference);
  double squares = 0, sum = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    squares += (found[i] - truth[i]) * (found[i] - truth[i]);
    sum += truth[i];
  }
  const auto count = static_cast<double>(truth.size());
  return squares / count / (sum / count * sum / count);
}

}  // namespace

/// Rounds lead to the picture that its settings make, bit for bit.
void check_rounds(int parts) {
  Scene scene = furnished_room(3);
  if (GENERATE(false, true)) add_lamps(scene, 20);  // more than layers are dense for
  const RenderResult rounds = grown(scene, little_work(), parts);
  CHECK(rounds.used.passes == parts);
  CHECK(rounds.used.light_map_rays == 16 * parts);
  CHECK(rounds.used.film.samples_per_pixel == 2 * parts);
  CHECK(rounds.used.photons.emitted_photons == (parts < 16 ? 10'000 : 40'000));
  for (const std::size_t threads : {1u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const RenderResult again = render(scene, room_camera(), device(), rounds.used);
    CHECK(same_bits(again.layers, rounds.layers));
    CHECK(again.used.light_map_rays == rounds.used.light_map_rays);
  }
}

TEST_CASE("growing light maps: rounds lead to the picture that its settings make") {
  check_rounds(3);
}
TEST_CASE("growing light maps: many rounds lead to the picture that its settings make", "[slow]") {
  check_rounds(17);
}

TEST_CASE("growing light maps: one part is the picture of its settings") {
  const Scene scene = furnished_room(3);
  RenderParameters all = of_parts(little_work(), 1);
  CHECK(same_bits(grown(scene, little_work(), 1).layers,
                  render(scene, room_camera(), device(), all).layers));
}

TEST_CASE("growing light maps: the error falls to that of the same work in one round", "[slow]") {
  // Nothing that rounds leave undone shows: photons of the first one, lattices too coarse.
  const Scene scene = furnished_room(0);
  RenderParameters part = little_work();
  part.film.samples_per_pixel = 4;
  constexpr int parts = 16;
  const LightLayers truth =
      trace_paths(scene, room_camera(),
                  {.width = 32, .height = 24, .samples_per_pixel = 8192, .seed = 7})
          .layers;
  RenderParameters at_once = of_parts(part, parts);
  at_once.passes = 1;
  const auto error = [&](const RenderResult& picture) {
    return squared_error(picture.layers, truth);
  };
  const double first = error(grown(scene, part, 1)), last = error(grown(scene, part, parts));
  const double of_one_round = error(render(scene, room_camera(), device(), at_once));
  CAPTURE(first, last, of_one_round);
  CHECK(last < first / 3);
  CHECK(last < 1.5 * of_one_round);
}

TEST_CASE("growing light maps: parts smaller than a ray have one") {
  RenderParameters asked = little_work();
  asked.passes = 40;  // 16 rays and 2 samples are to be divided
  asked.light_maps = LightMapMode::on;
  const RenderResult picture = render(furnished_room(0), room_camera(), device(), asked);
  CHECK(picture.used.light_map_rays == 40);
  CHECK(picture.used.film.samples_per_pixel == 40);
}

TEST_CASE("growing light maps: photons alone do not grow them, and walks do not") {
  const Scene scene = furnished_room(0);
  RenderParameters several = of_parts(little_work(), 3);
  const Catch::Matchers::StdString::ContainsMatcher refusal = Catch::Contains("there are 3");
  CHECK_THROWS_WITH(SceneRenderer(scene, {&device(), 1}, several), refusal);
  several.light_map_rays = 0;
  CHECK_THROWS_WITH(render(scene, room_camera(), device(), several), refusal);
}

}  // namespace photile::test
