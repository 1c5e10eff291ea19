// What does not change a picture: threads, memory, devices, instances.
#define TBB_PREVIEW_GLOBAL_CONTROL 1
#include <tbb/global_control.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <mutex>
#include <numeric>
#include <random>
#include <thread>

#include "device/context.hpp"
#include "estimate/load_balance.hpp"
#include "instanced_scenes.hpp"
#include "neighbour_comparison.hpp"
#include "photile/errors.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photons.hpp"
#include "photile/renderer.hpp"
#include "photile/surface_index.hpp"
#include "photon_sets.hpp"
#include "pictures.hpp"
#include "render/shared_photons.hpp"
#include "temporary_folder.hpp"
#include "test_device.hpp"
#include "test_scenes.hpp"
#include "thread_communicator.hpp"

namespace photile::test {
namespace {

using test::room_camera;
using test::same_bits;

// A seed gives the same picture each time, bit for bit.

RenderParameters small_parameters() { return small_picture(30'000, 64, 48); }

TEST_CASE("one, two and three threads render the same bits") {
  const Scene scene = test::furnished_room(4);
  std::vector<LightLayers> pictures;
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    pictures.push_back(render(scene, room_camera(), test::device(), small_parameters()).layers);
  }
  CHECK(same_bits(pictures[0], pictures[1]));
  CHECK(same_bits(pictures[0], pictures[2]));
}

TEST_CASE("one, two and three threads render the same bits of many lights") {
  Scene scene = test::furnished_room(4);
  add_lamps(scene, 20);
  std::vector<LightLayers> pictures;
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    pictures.push_back(render(scene, room_camera(), test::device(), small_parameters()).layers);
  }
  REQUIRE(pictures[0].sparse());
  CHECK(same_bits(pictures[0], pictures[1]));
  CHECK(same_bits(pictures[0], pictures[2]));
}

TEST_CASE("lamps of twice the power render the same bits per unit of power") {
  Scene scene = test::furnished_room(2);
  RenderParameters parameters = small_parameters();
  if (GENERATE(false, true)) {  // nodes are refined where light at the lamps' powers varies
    parameters.light_maps = LightMapMode::on;
    parameters.light_map_rays = 8;
  }
  const auto once = render(scene, room_camera(), test::device(), parameters).layers;
  for (Light& light : scene.lights) light.power *= 2;
  CHECK(same_bits(once, render(scene, room_camera(), test::device(), parameters).layers));
}

TEST_CASE("another seed renders another picture") {
  const Scene scene = test::furnished_room(2);
  RenderParameters parameters = small_parameters();
  const auto first = render(scene, room_camera(), test::device(), parameters).layers;
  parameters.seed = 2;
  CHECK_FALSE(same_bits(first, render(scene, room_camera(), test::device(), parameters).layers));
}

TEST_CASE("the same mesh with inconsistent winding renders the same bits") {
  const TemporaryFolder folder;
  const Scene room = test::furnished_room(4);
  std::mt19937 random(9);
  const auto write = [&](const std::string& name, bool flip) {
    std::ofstream obj(folder.path / (name + ".obj"));
    obj.precision(9);
    obj << "mtllib room.mtl\n";
    for (const glm::vec3& v : room.vertices) obj << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
    for (std::size_t t = 0; t < room.triangle_count(); ++t) {
      const bool lamp = room.triangle_light[t] != none;
      glm::uvec3 corners = room.triangles[t] + 1u;
      // A lamp's winding says where it shines; only the others may be wrong.
      const bool backwards = (room.front_side[t] == 1) != (!lamp && flip && random() % 2 == 0);
      if (backwards) std::swap(corners.y, corners.z);
      obj << "usemtl " << (lamp ? "lamp" : "wall") << "\nf " << corners.x << ' ' << corners.y << ' '
          << corners.z << '\n';
    }
  };
  std::ofstream(folder.path / "room.mtl")
      << "newmtl wall\nKd 0.6 0.5 0.4\nnewmtl lamp\nKd 0 0 0\nKe 10 9 8\n";
  write("consistent", false);
  write("inconsistent", true);
  const Scene consistent = load_scene(folder.path / "consistent.obj");
  const Scene inconsistent = load_scene(folder.path / "inconsistent.obj");
  REQUIRE(consistent.front_side != inconsistent.front_side);
  const auto first = render(consistent, room_camera(), test::device(), small_parameters());
  const auto second = render(inconsistent, room_camera(), test::device(), small_parameters());
  CHECK(same_bits(first.layers, second.layers));
}

TEST_CASE("a cancelled rendering stops with Interrupted") {
  struct Cancelled : Progress {
    bool cancelled() const override { return true; }
  } progress;
  const Scene scene = test::furnished_room(2);
  CHECK_THROWS_AS(render(scene, room_camera(), test::device(), small_parameters(), progress),
                  Interrupted);
}

// Pictures within a small part of the device's memory: the same bits.

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

/// With all maps, as for a walk: one picture makes those alone that it looks at, and takes less.
RenderResult render_by_all_maps(const Scene& scene, Device& device,
                                const RenderParameters& parameters) {
  SceneRenderer renderer(scene, {&device, 1}, parameters);
  return renderer.render(test::room_camera(), parameters.film);
}

TEST_CASE("a picture within a tenth and a fiftieth of the memory of all maps has the same bits",
          "[slow]") {
  const MapMode maps = GENERATE(MapMode::triangle, MapMode::automatic);
  RenderParameters parameters = tiny_parameters();
  parameters.maps = maps;
  Device device;
  const RenderResult expected = render_by_all_maps(room(), device, parameters);
  const std::uint64_t taken = device.peak_allocated_bytes();
  // Both light and radiance need several pages of photons, maps and hits then.
  const double entries = 30 * figure(expected.statistics, "references");
  CHECK(entries > 0.2 * static_cast<double>(taken));
  for (const std::uint64_t divisor : {10, 50}) {
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
  const RenderResult expected = render_by_all_maps(scene, device, parameters);
  CHECK(figure(expected.statistics, "mixed maps") > 0);
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

TEST_CASE("a memory too small for the triangles alone is refused with the remedy") {
  Device small = limited_device(2'000);
  CHECK_THROWS_MATCHES(
      render(room(), test::room_camera(), small, tiny_parameters()), DeviceMemoryError,
      Catch::Predicate<DeviceMemoryError>(
          [](const DeviceMemoryError& error) {
            return std::string(error.what()).find("memory limit") != std::string::npos;
          },
          "names the memory limit"));
}

// A scene with instances renders as the same scene without.

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

TEST_CASE("instances render the picture of the flattened scene") {
  const Scene scene = test::room_of_balls();
  RenderParameters parameters = small_picture(30'000, 64, 48);
  parameters.radius = 0.15;
  const LightLayers shared = render(scene, test::room_camera(), test::device(), parameters).layers;
  const LightLayers flat =
      render(test::flattened(scene), test::room_camera(), test::device(), parameters).layers;
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
  const Scene scene = test::room_of_balls(6);
  const RayScene rays(scene);
  const Photons photons = trace_photons(rays, {.emitted_photons = 4'000}).photons;
  PrimaryHitParameters film;
  film.width = 24;
  film.height = 18;
  film.samples_per_pixel = 1;
  const PrimaryHits hits = trace_primary_hits(rays, test::room_camera(), film, 0, film.height).hits;
  const double radius = 0.3;
  const PhotonMaps maps(test::device(), scene, photons, find_neighbour_groups(scene, {radius, 60}),
                        {radius, 4});
  Estimator estimator(maps, scene, {20, 0});
  const reference::DensityOracle oracle(scene, photons, reference::PhotonFilter::grouped, 60);
  CHECK(test::count_differences(hits, estimator.nearest(hits), oracle, photons,
                                static_cast<float>(radius)) == 0);
}

// Several devices render the picture of one.

/// The room's walls reflect a little in the second scene: its kernels estimate radiance as well.
Scene room(bool is_glossy) {
  Scene scene = test::furnished_room(4);
  if (is_glossy) scene.materials[0] = test::glossy({0.6f, 0.6f, 0.5f}, glm::vec3(0.04f), 0.3f);
  return scene;
}

/// Large enough for all rounds: the warm-up, the probe, and a share by throughput.
RenderParameters parameters() { return small_picture(30'000, 160, 120, 4); }

std::vector<Device> halves() { return open_devices({.selector = "/2"}); }

TEST_CASE("two sub-devices render the bits of one device") {
  const Scene scene = room(GENERATE(false, true));
  const auto expected = render(scene, test::room_camera(), test::device(), parameters());
  std::vector<Device> devices = halves();
  const auto result = render(scene, test::room_camera(), devices, parameters());
  CHECK(test::same_bits(result.layers, expected.layers));
  REQUIRE(result.device_shares.size() == 2);
  CHECK(result.device_shares[0] > 0);
  CHECK(result.device_shares[1] > 0);
  CHECK(result.device_shares[0] + result.device_shares[1] == Approx(1));
}

TEST_CASE("two sub-devices gather the bits of one device") {
  Scene scene = room(true);
  scene.materials[1] = test::mirror(glm::vec3(0.9f));  // caustics have maps of their own
  RenderParameters gathering = parameters();
  gathering.light_map_rays = 16;
  gathering.photons.emitted_photons = 100'000;
  const auto expected = render(scene, test::room_camera(), test::device(), gathering);
  std::vector<Device> devices = halves();
  CHECK(test::same_bits(render(scene, test::room_camera(), devices, gathering).layers,
                        expected.layers));
}

TEST_CASE("the statistics name each device with its share") {
  const Scene scene = room(false);
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
    CHECK(figure->second == result.device_shares[i]);
  }
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
  CHECK_THROWS_AS(render(room(false), test::room_camera(), std::span<Device>(), parameters()),
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
  CHECK(balance.shares() == std::vector<double>{0, 0});
  balance.record(0, 30, 1);
  balance.record(1, 10, 1);
  balance.end_round();
  CHECK(balance.shares() == std::vector<double>{0.75, 0.25});
}

// A rendering that several processes share; threads stand in for them, each with a device of its
// own. tests/mpi has real ones.

Scene glossy_room() {
  Scene scene = test::furnished_room(4);
  scene.materials[0] = test::glossy({0.6f, 0.6f, 0.5f}, glm::vec3(0.04f), 0.3f);
  scene.materials[1] = test::mirror(glm::vec3(0.9f));  // caustics have maps of their own
  return scene;
}

/// The picture of rank 0.
LightLayers shared_picture(const Scene& scene, std::uint32_t processes,
                           RenderParameters parameters) {
  LightLayers picture;
  on_threads(processes, [&](Communicator& communicator) {
    Device own;
    RenderParameters shared = parameters;
    shared.processes = &communicator;
    RenderResult result = render(scene, test::room_camera(), own, shared);
    if (communicator.rank() == 0) picture = std::move(result.layers);
  });
  return picture;
}

TEST_CASE("processes that share a rendering make the bits of one: light maps, nodes that gather") {
  const Scene scene = glossy_room();
  RenderParameters parameters = small_picture(30'000, 32, 24);
  parameters.light_map_rays = GENERATE(0, 8);
  const LightLayers expected =
      render(scene, test::room_camera(), test::device(), parameters).layers;
  CHECK(same_bits(shared_picture(scene, 3, parameters), expected));
}

TEST_CASE("estimates at hits are the same bits for any number of processes") {
  const Scene scene = glossy_room();
  RenderParameters parameters = small_picture(30'000, 32, 24);
  parameters.light_maps = LightMapMode::off;
  CHECK(same_bits(shared_picture(scene, 4, parameters), shared_picture(scene, 1, parameters)));
}

TEST_CASE("each process has all photons of its maps, in the order of one process, and no others") {
  const Scene scene = test::furnished_room(6);
  const RayScene rays(scene);
  constexpr double radius = 0.15;
  constexpr std::uint32_t processes = 4;
  const PhotonTracerParameters tracing{.emitted_photons = 20'000};
  const Photons all = trace_photons(rays, tracing).photons;
  const NeighbourGroups groups =
      find_map_groups(scene, all, MapMode::patch, {radius, 60}, Progress::none());
  std::vector<std::uint64_t> owned(processes), held(processes);
  on_threads(processes, [&](Communicator& communicator) {
    PhotonTracerParameters own = tracing;
    own.shard = {communicator.rank(), communicator.size()};
    Photons photons = trace_photons(rays, own).photons;
    photons.of_all = photons_of_all(communicator, photons);
    const bool known =
        photons.of_all->count == all.size() && photons.of_all->landed == landed_on(scene, all) &&
        find_map_groups(scene, photons, MapMode::patch, {radius, 60}).members == groups.members &&
        automatic_radius(photons, 20) == automatic_radius(all, 20);
    const MapOwners owners(scene, groups.patches, photons.of_all->landed, processes);
    PhotonsMoved moved;
    photons = to_owners(communicator, scene, groups, owners, radius, std::move(photons), moved);
    held[communicator.rank()] = photons.size();
    // It holds every photon of the triangles that it answers for, and those of others within the
    // radius.
    bool same = known;
    std::size_t lacking = 0;
    for (std::uint32_t s = 0; s + 1 < all.first_of.size(); ++s) {
      const bool own_triangle = owners.of(s) == communicator.rank();
      std::uint32_t next = photons.first_of[s];
      for (std::uint32_t i = all.first_of[s]; i < all.first_of[s + 1]; ++i) {
        const bool there = next < photons.first_of[s + 1] &&
                           photons.position[next] == all.position[i] &&
                           photons.flux[next] == all.flux[i];
        if (there) {
          ++next;
          owned[communicator.rank()] += own_triangle ? 1 : 0;
          continue;
        }
        same = same && !own_triangle;
        for (const std::uint32_t map : groups.of(s)) {
          if (owners.of_map(map) != communicator.rank()) continue;
          for (const std::uint32_t member : groups.patches.of(map / 2)) {
            const auto corners = scene.corners(triangle_of(member));
            const glm::dvec3 p(all.position[i]);
            const double apart = triangle_triangle_distance(
                {glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])},
                {p, p + glm::dvec3(1e-9, 0, 0), p + glm::dvec3(0, 1e-9, 0)});
            lacking += apart < 0.999 * radius ? 1 : 0;
          }
        }
      }
      same = same && next == photons.first_of[s + 1];
    }
    static std::mutex catch_is_no_friend_of_threads;
    const std::scoped_lock lock(catch_is_no_friend_of_threads);
    CHECK(same);
    CHECK(lacking == 0);
  });
  CHECK(std::accumulate(owned.begin(), owned.end(), std::uint64_t{0}) == all.size());
  for (const std::uint64_t count : owned) CHECK(count < all.size() / 2);
  for (const std::uint64_t count : held) CHECK(count < all.size());
}

}  // namespace
}  // namespace photile::test
