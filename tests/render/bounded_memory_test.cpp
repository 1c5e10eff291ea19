// Pictures within a small part of the device's memory: the same bits.
#include <catch2/catch.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "device/context.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"
#include "photon_sets.hpp"
#include "pictures.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"

namespace photile::test {
namespace {

using test::room_camera;
using test::same_bits;

RenderParameters tiny_parameters() { return small_picture(20'000, 48, 36); }

Device limited_device(std::uint64_t bytes) {
  DeviceOptions options;
  options.memory_bytes = bytes;
  return Device(options);
}

const Scene& room() {
  static const Scene scene = test::furnished_room(4);
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

}  // namespace

TEST_CASE("a picture within a tenth of the memory, of small maps a fiftieth, has the same bits",
          "[slow]") {
  const MapMode maps = GENERATE(MapMode::triangle, MapMode::automatic);
  RenderParameters parameters = tiny_parameters();
  parameters.maps = maps;
  Device device;
  const RenderResult expected = render(room(), test::room_camera(), device, parameters);
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
    const RenderResult result = render(room(), test::room_camera(), small, parameters);
    CAPTURE(maps == MapMode::automatic, taken, divisor);
    CHECK(test::same_bits(result.layers, expected.layers));
    CHECK(small.peak_allocated_bytes() <= taken / divisor);
  }
}

// The shapes of the maps of so small a room (100 bytes each, always whole) are most of a tenth.
TEST_CASE("maps that keep normals give the same bits within an eighth of the memory") {
  Scene scene = room();
  const std::size_t first = scene.vertices.size();
  test::add_torus(scene, 0.5f, 0.15f, 48, 24);
  for (std::size_t i = first; i < scene.vertices.size(); ++i) {
    scene.vertices[i] += glm::vec3(1.9f, 1.5f, 1.6f);
  }
  RenderParameters parameters = tiny_parameters();
  parameters.maps = MapMode::patch;
  Device device;
  const RenderResult expected = render(scene, test::room_camera(), device, parameters);
  CHECK(figure(expected.statistics, "normal-filtered maps") > 0);
  Device small = limited_device(device.peak_allocated_bytes() / 8);
  const RenderResult result = render(scene, test::room_camera(), small, parameters);
  CHECK(test::same_bits(result.layers, expected.layers));
}

TEST_CASE("a picture of one light within a tenth of the memory that it takes has the same bits") {
  // A diffuse scene with one light sums in vectors: bits must not depend on what shares a page.
  // Coloured walls, since sums of equal numbers hardly depend on their order.
  const Scene box = test::closed_box(test::diffuse({0.7f, 0.5f, 0.3f}), 5);
  const Camera camera = Camera::look_at({0.1, 0.1, 0.2}, {1, 0.9, 0.6}, {0, 0, 1}, 1.2);
  const RenderParameters parameters = tiny_parameters();
  Device device;
  const LightLayers expected = render(box, camera, device, parameters).layers;
  Device small = limited_device(device.peak_allocated_bytes() / 10);
  CHECK(test::same_bits(render(box, camera, small, parameters).layers, expected));
}

const auto names_the_limit = Catch::Predicate<DeviceMemoryError>(
    [](const DeviceMemoryError& error) {
      return std::string(error.what()).find("memory limit") != std::string::npos;
    },
    "names the memory limit");

TEST_CASE("a memory too small for the triangles alone is refused with the remedy") {
  Device small = limited_device(2'000);
  CHECK_THROWS_MATCHES(render(room(), test::room_camera(), small, small_picture(20, 48, 36)),
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
  const Scene box = test::closed_box(test::diffuse(glm::vec3(0.5f)), 5);
  const Camera camera = Camera::look_at({0.1, 0.1, 0.2}, {1, 0.9, 0.6}, {0, 0, 1}, 1.2);
  RenderParameters parameters = small_picture(1'000'000, 48, 36);
  parameters.passes = GENERATE(1, 2);
  Device small = limited_device(100'000);
  Stages stages;
  CHECK_THROWS_MATCHES(render(box, camera, small, parameters, stages), DeviceMemoryError,
                       names_the_limit);
  CHECK(stages.begun.empty());
}

}  // namespace photile::test
