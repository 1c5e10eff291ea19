// Photon maps that get better in the background, and the frames that are rendered from them.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "loading/light_changes.hpp"
#include "loading/surroundings.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "view/frame_worker.hpp"
#include "view/photon_worker.hpp"
#include "view/scene_loader.hpp"

namespace photile::test {

using namespace photile::view;

namespace {

/// A lamp over a floor of one square metre.
Scene lit_floor() {
  test::SceneBuilder builder;
  const std::uint32_t grey = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.quad({-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f}, {-0.5f, 0, -0.5f}, grey);
  builder.add(test::point_light("lamp", {0, 1, 0}, 100));
  return builder.build();
}

Camera from_above() { return Camera::look_at({0, 1, 1}, {0, 0, 0}, {0, 1, 0}, glm::radians(40.0)); }

RenderParameters few_photons() {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 40'000;
  return parameters;
}

std::vector<Device> one_device() {
  std::vector<Device> devices;
  devices.emplace_back();
  return devices;
}

/// Waits for what another thread does; a minute is an error.
template <class Condition>
void wait_for(const Condition& condition) {
  for (int i = 0; i < 6000 && !condition(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  REQUIRE(condition());
}

/// A viewer of a scene, and the photons that are traced for him.
struct Viewer {
  explicit Viewer(FrameRequest request, const RenderParameters& parameters = few_photons(),
                  int most_samples = 4, Scene room = lit_floor())
      : scene(std::move(room)),
        frames(most_samples, 30),
        photons(scene, one_device, parameters, std::nullopt, {},
                [this](std::shared_ptr<MapGeneration> maps) { frames.use(std::move(maps)); }) {
    frames.show(std::move(request));
  }

  /// The frame at rest, of this many paths.
  std::shared_ptr<const Frame> finished(std::uint64_t paths = 40'000) {
    wait_for([&] { return frames.finished() && frames.latest()->emitted_photons == paths; });
    CHECK_FALSE(frames.take_error());
    CHECK_FALSE(photons.take_error());
    return frames.latest();
  }

  const Scene scene;
  FrameWorker frames;
  PhotonWorker photons;
};

}  // namespace

TEST_CASE("a viewer that stands still sees what render gives, bit for bit") {
  Viewer viewer({from_above(), 40, 30, false});
  const auto frame = viewer.finished();
  CHECK(frame->samples_per_pixel == 4);

  RenderParameters parameters = few_photons();
  parameters.film = {40, 30, 4};
  const RenderResult expected = render(viewer.scene, from_above(), test::device(), parameters);
  CHECK(frame->layers.layers[0].radiance == expected.layers.layers[0].radiance);
  CHECK(frame->layers.layers[0].illuminance == expected.layers.layers[0].illuminance);
  CHECK_FALSE(frame->reflections);
  REQUIRE(frame->photons);
  CHECK(frame->photons->position.size() == expected.stored_photons);
  CHECK(luminance(glm::dvec3(frame->layers.layers[0].radiance[15 * 40 + 20])) > 0);
}

TEST_CASE("with light maps a viewer moves in quick frames, and at rest sees what render gives") {
  RenderParameters parameters = few_photons();
  parameters.light_maps = LightMapMode::on;
  const std::vector<glm::vec3> powers{glm::vec3(100.0f)};
  Camera camera = from_above();
  camera.position.x += 0.1;
  Viewer viewer({camera, 400, 300, true, false, powers}, parameters);
  FrameWorker& frames = viewer.frames;
  wait_for([&] { return frames.latest() && frames.latest()->emitted_photons == 40'000; });
  const auto quick = frames.latest();
  REQUIRE(quick->mixed.size() == 293 * 220);  // as many as 64,000 pixels, rounded up
  CHECK(quick->mixed[110 * 293 + 146].x > 0);
  CHECK_FALSE(frames.finished());

  frames.show({from_above(), 40, 30, false, false, powers});
  const auto frame = viewer.finished();
  CHECK(frame->mixed.empty());
  parameters.film = {40, 30, 4};
  const RenderResult expected = render(viewer.scene, from_above(), test::device(), parameters);
  CHECK(frame->layers.layers[0].radiance == expected.layers.layers[0].radiance);
}

TEST_CASE("of several passes a viewer at rest sees what render gives of all") {
  RenderParameters parameters = few_photons();
  parameters.photons.emitted_photons = 45'000;
  parameters.passes = 3;
  parameters.film = {40, 30, 4};
  parameters.light_maps = LightMapMode::off;
  Viewer viewer({from_above(), 40, 30, false, false, {glm::vec3(100.0f)}}, parameters);
  const auto frame = viewer.finished(45'000);
  const RenderResult expected = render(viewer.scene, from_above(), test::device(), parameters);
  CHECK(frame->layers.layers[0].radiance == expected.layers.layers[0].radiance);
}

TEST_CASE(
    "the first picture of nodes that gather has light everywhere, and no samples are made of it") {
  const Scene scene = lit_floor();
  RenderParameters parameters = few_photons();
  parameters.light_map_rays = 16;
  FrameWorker frames(4, 30);
  frames.show({from_above(), 40, 30, false, false, {glm::vec3(100.0f)}});
  std::vector<std::shared_ptr<MapGeneration>> delivered;
  std::atomic<int> count{0};
  PhotonWorker photons(scene, one_device, parameters, std::nullopt, {},
                       [&](std::shared_ptr<MapGeneration> maps) {
                         if (delivered.empty()) frames.use(maps);
                         delivered.push_back(std::move(maps));
                         ++count;
                       });
  wait_for([&] { return count == 2; });
  const std::shared_ptr<MapGeneration> first = delivered[0], whole = delivered[1];
  CHECK_FALSE(first->whole);
  CHECK(whole->whole);
  CHECK(whole->coarser == first);
  CHECK(first->lit);
  wait_for([&] { return frames.latest() && frames.latest()->lacking == 0; });
  const auto smooth = frames.latest();
  REQUIRE(smooth->mixed.size() == 40 * 30);
  // 100 lm over the floor are 8 cd, at a metre below it, half of which is reflected evenly.
  CHECK(smooth->mixed[15 * 40 + 20].y ==
        Approx(100 / (4 * glm::pi<double>()) * 0.5 / glm::pi<double>()).epsilon(0.03));
  CHECK_FALSE(frames.finished());
  frames.use(whole);
  wait_for([&] { return frames.finished(); });
  CHECK(frames.latest()->mixed.empty());
  CHECK_FALSE(frames.take_error());
  CHECK_FALSE(photons.take_error());
}

TEST_CASE("a lamp that is turned down is seen in the next quick frame") {
  RenderParameters parameters = few_photons();
  parameters.light_maps = LightMapMode::on;
  Viewer viewer({from_above(), 40, 30, true, false, {glm::vec3(100.0f)}}, parameters);
  FrameWorker& frames = viewer.frames;
  wait_for([&] { return frames.latest() && frames.latest()->emitted_photons == 40'000; });
  std::shared_ptr<const Frame> bright, dark;
  for (int i = 0; i < 20; ++i) {  // until all nodes are there
    bright = frames.latest();
    frames.show({from_above(), 40, 30, true, false, {glm::vec3(100.0f)}});
    wait_for([&] { return frames.latest() != bright; });
  }
  bright = frames.latest();
  frames.show({from_above(), 40, 30, true, false, {glm::vec3(50.0f)}});
  wait_for([&] { return frames.latest() != bright; });
  dark = frames.latest();
  for (std::size_t i = 0; i < bright->mixed.size(); ++i) {
    CHECK(dark->mixed[i].x == Approx(0.5 * bright->mixed[i].x).epsilon(1e-6));
  }
}

TEST_CASE("pooled layers of a frame are the sums of its lights at their powers") {
  test::SceneBuilder builder;
  const std::uint32_t grey = builder.add(test::diffuse(glm::vec3(0.5f)));
  builder.quad({-0.5f, 0, 0.5f}, {0.5f, 0, 0.5f}, {0.5f, 0, -0.5f}, {-0.5f, 0, -0.5f}, grey);
  LayerMixdown mixdown{{"odd", "even"}, {}, {}};
  for (std::uint32_t i = 0; i < 10; ++i) {
    const float x = -0.4f + 0.08f * static_cast<float>(i);
    builder.add(test::point_light("lamp" + std::to_string(i), {x, 0.5f, 0}, 100));
    mixdown.layer_of.push_back(i % 2);
    mixdown.scale.push_back(static_cast<float>(i));
  }
  Viewer viewer({from_above(), 40, 30, false, false, {}, std::make_shared<LayerMixdown>(mixdown)},
                few_photons(), 4, builder.build());
  const auto frame = viewer.finished();
  REQUIRE(frame->layers.layers.size() == 2);
  RenderParameters parameters = few_photons();
  parameters.film = {40, 30, 4};
  const LightLayers all =
      render(viewer.scene, from_above(), test::device(), parameters).layers.dense();
  for (const std::size_t layer : {0u, 1u}) {
    for (std::size_t pixel = 0; pixel < 40 * 30; ++pixel) {
      float expected = 0;
      for (std::size_t light = layer; light < 10; light += 2) {
        expected += mixdown.scale[light] * all.layers[light].radiance[pixel].x;
      }
      REQUIRE(frame->layers.layers[layer].radiance[pixel].x == Approx(expected).epsilon(1e-4));
    }
  }
}

TEST_CASE("reflections come with a frame where they are asked for: none of a matt floor") {
  Viewer viewer({from_above(), 40, 30, false, true}, few_photons(), 1);
  const auto frame = viewer.finished();
  REQUIRE(frame->reflections);
  REQUIRE(frame->reflections->layers[0].radiance.size() == 40 * 30);
  for (const glm::vec3& radiance : frame->reflections->layers[0].radiance) {
    CHECK(radiance == glm::vec3(0.0f));
  }
}

TEST_CASE("a frame is of the last viewpoint that was asked for") {
  Camera camera = from_above();
  Viewer viewer({camera, 40, 30, true}, few_photons(), 1);
  for (int step = 0; step < 20; ++step) {
    camera.position.x += 0.01;
    viewer.frames.show({camera, 40, 30, true});
  }
  viewer.frames.show({camera, 44, 33, false});
  const auto frame = viewer.finished();
  CHECK(frame->camera.position == camera.position);
  CHECK(frame->layers.width == 44);
}

TEST_CASE("what fails in the background is told, and ends nothing else") {
  const Scene scene = lit_floor();
  PhotonWorker photons(
      scene, []() -> std::vector<Device> { throw DeviceError("no device today"); }, few_photons(),
      std::nullopt, {}, [](std::shared_ptr<MapGeneration>) {});
  std::exception_ptr error;
  wait_for([&] { return error || (error = photons.take_error()); });
  CHECK_THROWS_WITH(std::rethrow_exception(error), "no device today");
  CHECK_FALSE(photons.take_error());
}

TEST_CASE("ending in the middle of the work waits for no photons") {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 400'000'000;  // minutes
  Viewer viewer({from_above(), 400, 300, false}, parameters, 1024);
  wait_for([&] { return !viewer.photons.progress().stage.empty(); });
}

// Which skies of a live page follow the hour.

TEST_CASE("a place makes a sky of patches, unless another sky or sun is asked for") {
  SceneLoadOptions options;
  options.situation = {.site = Site{52.5, 13.4, 1}, .north_degrees = 30};
  options.situation.time = LocalTime{2026, 6, 21, 9};
  SceneLoadOptions overcast = options, sunny = options, nowhere;
  const SkySituation taken = take_moving_sky(options);
  CHECK(taken.site);
  REQUIRE(taken.time);
  CHECK(taken.time->month == 6);
  REQUIRE(options.sky);
  CHECK((options.sky->kind == SkyKind::patches && options.sky->patches == 145));
  CHECK((!options.situation.site && !options.situation.time));
  CHECK(options.situation.north_degrees == 30);
  overcast.sky = Sky::parse("overcast=10000");
  CHECK(!take_moving_sky(overcast).site);
  CHECK(overcast.situation.time);
  sunny.sun = Sun::parse("80000");
  CHECK(!take_moving_sky(sunny).site);
  CHECK((!take_moving_sky(nowhere).site && !nowhere.sky));
  nowhere.sky = Sky::parse("patches=577");
  CHECK(!take_moving_sky(nowhere).site);
  CHECK(nowhere.sky->patches == 577);
  Scene floor = plate(diffuse(glm::vec3(0.5f)), 1);
  loading::add_surroundings(floor, nowhere);
  loading::group_lights(floor, nowhere.light_groups);
  CHECK(light_groups_of(floor).groups.size() == 1);
}

}  // namespace photile::test
