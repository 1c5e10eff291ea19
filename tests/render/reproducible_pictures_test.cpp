// What changes no picture: lamps of more power, and instances in place of copies. Threads, devices,
// processes, windings and kept photons are in tests/equal_bits.
#include <string>
#include <string_view>

#include "device/context.hpp"
#include "instanced_scenes.hpp"
#include "neighbour_comparison.hpp"
#include "photile/errors.hpp"
#include "photon_sets.hpp"
#include "pictures.hpp"

namespace photile::test {
namespace {

RenderParameters small_parameters() { return small_picture(30'000, 64, 48); }

/// Sum over the pixels of each layer.
std::vector<double> sums(const LightLayers& picture) {
  std::vector<double> sums;
  for (const auto& layer : picture.layers) {
    double sum = 0;
    for (const glm::vec3& radiance : layer.radiance) sum += luminance(glm::dvec3(radiance));
    sums.push_back(sum);
  }
  return sums;
}

TEST_CASE("lamps of twice the power render the same bits per unit of power") {
  Scene scene = furnished_room(2);
  RenderParameters parameters = small_parameters();
  if (GENERATE(false, true)) {  // nodes are refined where light at the lamps' powers varies
    parameters.light_maps = LightMapMode::on;
    parameters.light_map_rays = 8;
  }
  const auto once = render(scene, room_camera(), device(), parameters).layers;
  for (Light& light : scene.lights) light.power *= 2;
  CHECK(same_bits(once, render(scene, room_camera(), device(), parameters).layers));
}

TEST_CASE("another seed renders another picture") {
  const Scene scene = furnished_room(2);
  RenderParameters parameters = small_parameters();
  const auto first = render(scene, room_camera(), device(), parameters).layers;
  parameters.seed = 2;
  CHECK_FALSE(same_bits(first, render(scene, room_camera(), device(), parameters).layers));
}

TEST_CASE("a cancelled rendering stops with Interrupted") {
  struct Cancelled : Progress {
    bool cancelled() const override { return true; }
  } progress;
  const Scene scene = furnished_room(2);
  CHECK_THROWS_AS(render(scene, room_camera(), device(), small_parameters(), progress),
                  Interrupted);
}

TEST_CASE("instances render the picture of the flattened scene") {
  const Scene scene = room_of_balls();
  RenderParameters parameters = small_picture(30'000, 64, 48);
  parameters.radius = 0.15;
  const LightLayers shared = render(scene, room_camera(), device(), parameters).layers;
  const LightLayers flat = render(flattened(scene), room_camera(), device(), parameters).layers;
  REQUIRE(shared.layers.size() == flat.layers.size());
  // A photon in a thousand parts from its twin; an estimate has some 50 photons, and a path that
  // passes an edge on the other side changes a few of them.
  for (std::size_t light = 0; light < shared.layers.size(); ++light) {
    CHECK(sums(shared)[light] == Approx(sums(flat)[light]).epsilon(2e-3));
    std::size_t close = 0;
    const auto& a = shared.layers[light].radiance;
    const auto& b = flat.layers[light].radiance;
    for (std::size_t i = 0; i < a.size(); ++i) {
      close += glm::distance(a[i], b[i]) <= 0.02f * glm::length(b[i]);
    }
    CHECK(static_cast<double>(close) > 0.95 * static_cast<double>(a.size()));
  }
}

TEST_CASE("neighbours in a scene with instances equal the oracle's") {
  const Scene scene = room_of_balls(6);
  const RayScene rays(scene);
  const Photons photons = trace_photons(rays, {.emitted_photons = 4'000}).photons;
  PrimaryHitParameters film;
  film.width = 24;
  film.height = 18;
  film.samples_per_pixel = 1;
  const PrimaryHits hits = trace_primary_hits(rays, room_camera(), film, 0, film.height).hits;
  const double radius = 0.3;
  const PhotonMaps maps(device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  Estimator estimator(maps, scene, {20, 0});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  CHECK(count_differences(hits, estimator.nearest(hits), oracle, photons,
                          static_cast<float>(radius)) == 0);
}

// Pictures within a small part of the device's memory: the same bits.

RenderParameters tiny_parameters() { return small_picture(20'000, 48, 36); }

Device limited_device(std::uint64_t bytes) {
  DeviceOptions options;
  options.memory_bytes = bytes;
  return Device(options);
}

const Scene& room() {
  static const Scene scene = furnished_room(4);
  return scene;
}

double figure(const RunStatistics& statistics, const std::string& name) {
  for (const StageStatistics& stage : statistics) {
    for (const auto& [figure, value] : stage.figures) {
      if (figure == name) return value;
    }
  }
  throw std::out_of_range(name);
}

TEST_CASE("a picture within a tenth of the memory, of small maps a fiftieth, has the same bits",
          "[slow]") {
  const MapMode maps = GENERATE(MapMode::triangle, MapMode::automatic);
  RenderParameters parameters = tiny_parameters();
  parameters.maps = maps;
  Device device;
  const RenderResult expected = render(room(), room_camera(), device, parameters);
  const std::uint64_t taken = device.peak_allocated_bytes();
  // Both light and radiance need several pages of photons, maps and hits then.
  const double records = 30 * figure(expected.statistics, "references");
  CHECK(records > 0.2 * static_cast<double>(taken));
  // A map has to fit as a whole: that of the room's largest patch takes a sixteenth.
  const std::vector<std::uint64_t> divisors = maps == MapMode::triangle
                                                  ? std::vector<std::uint64_t>{10, 50}
                                                  : std::vector<std::uint64_t>{10};
  for (const std::uint64_t divisor : divisors) {
    Device small = limited_device(taken / divisor);
    const RenderResult result = render(room(), room_camera(), small, parameters);
    CAPTURE(maps == MapMode::automatic, taken, divisor);
    CHECK(same_bits(result.layers, expected.layers));
    CHECK(small.peak_allocated_bytes() <= taken / divisor);
  }
}

// The shapes of the maps of so small a room (100 bytes each, always whole) are most of a tenth.
TEST_CASE("maps that keep normals give the same bits within an eighth of the memory") {
  Scene scene = room();
  const std::size_t first = scene.vertices.size();
  add_torus(scene, 0.5f, 0.15f, 48, 24);
  for (std::size_t i = first; i < scene.vertices.size(); ++i) {
    scene.vertices[i] += glm::vec3(1.9f, 1.5f, 1.6f);
  }
  RenderParameters parameters = tiny_parameters();
  parameters.maps = MapMode::patch;
  Device device;
  const RenderResult expected = render(scene, room_camera(), device, parameters);
  CHECK(figure(expected.statistics, "normal-filtered maps") > 0);
  Device small = limited_device(device.peak_allocated_bytes() / 8);
  const RenderResult result = render(scene, room_camera(), small, parameters);
  CHECK(same_bits(result.layers, expected.layers));
}

TEST_CASE("a picture of one light within a tenth of the memory that it takes has the same bits") {
  // A diffuse scene with one light sums in vectors: bits must not depend on what shares a page.
  // Coloured walls, since sums of equal numbers hardly depend on their order.
  const Scene box = closed_box(diffuse({0.7f, 0.5f, 0.3f}), 5);
  const Camera camera = Camera::look_at({0.1, 0.1, 0.2}, {1, 0.9, 0.6}, {0, 0, 1}, 1.2);
  const RenderParameters parameters = tiny_parameters();
  Device device;
  const LightLayers expected = render(box, camera, device, parameters).layers;
  Device small = limited_device(device.peak_allocated_bytes() / 10);
  CHECK(same_bits(render(box, camera, small, parameters).layers, expected));
}

const auto names_the_limit = Catch::Predicate<DeviceMemoryError>(
    [](const DeviceMemoryError& error) {
      return std::string(error.what()).find("memory limit") != std::string::npos;
    },
    "names the memory limit");

TEST_CASE("a memory too small for the triangles alone is refused with the remedy") {
  Device small = limited_device(2'000);
  CHECK_THROWS_MATCHES(render(room(), room_camera(), small, small_picture(20, 48, 36)),
                       DeviceMemoryError, names_the_limit);
}

/// Knows which stages began.
class Stages : public Progress {
 public:
  void begin(std::string_view stage, std::uint64_t, std::string_view) override {
    begun.emplace_back(stage);
  }
  std::vector<std::string> begun;
};

TEST_CASE("photons of which one map does not fit are refused before they are traced") {
  const Scene box = closed_box(diffuse(0.5f), 5);
  const Camera camera = Camera::look_at({0.1, 0.1, 0.2}, {1, 0.9, 0.6}, {0, 0, 1}, 1.2);
  RenderParameters parameters = small_picture(1'000'000, 48, 36);
  parameters.passes = GENERATE(1, 2);
  Device small = limited_device(100'000);
  Stages stages;
  CHECK_THROWS_MATCHES(render(box, camera, small, parameters, stages), DeviceMemoryError,
                       names_the_limit);
  CHECK(stages.begun.empty());
}

}  // namespace
}  // namespace photile::test
