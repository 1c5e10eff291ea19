// Prints hashes of everything that the build, knn and density kernels compute on fixed photons and
// hits, one per line. Two runtimes agree in every bit if they print the same.
//
//   photile_fingerprint PHOTONS HITS [--every-kernel | --lanes]
//
// With --every-kernel the kd-trees, brute force and glossy surfaces are run, too, so that a checker
// sees each kernel and each of its specialisations once. With --lanes the estimates are those of
// groups of 32 and 64 work-items, as on GPUs, and nothing else is run. The device is the best there
// is, or those that PHOTILE_DEVICE names: several share the hits. Exit code 3 where a result is not
// a finite number.
#include <fmt/format.h>
#include <xxhash.h>

#include <cstdlib>
#include <memory>
#include <string_view>

#include "command/command_line.hpp"
#include "estimate/photon_estimate.hpp"
#include "maps/map_store.hpp"
#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photon_sets.hpp"
#include "structures/structure.hpp"

namespace photile::test {
namespace {

constexpr double radius = 0.25;  // metres

struct Case {
  std::string name;
  Scene scene;
  std::string structure = "uniform-grid";
  int neighbours = 50;
  std::optional<EstimateTuning> tuning = std::nullopt;
  DensityKernel kernel = DensityKernel::constant;

  EstimateParameters parameters() const {
    return {.neighbours = neighbours, .tuning = tuning, .kernel = kernel};
  }
};

struct Sizes {
  std::size_t photons, hits;
};

bool all_finite = true;

template <class T>
void print_hash(const Case& test, const char* what, std::span<const T> values) {
  fmt::print("{} {} {:016x} of {}\n", test.name, what,
             XXH3_64bits(values.data(), values.size_bytes()), values.size());
}

void print_hash(const Case& test, const char* what, const std::vector<glm::vec3>& values) {
  for (const glm::vec3& value : values) {
    all_finite &= std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
  }
  print_hash(test, what, std::span(values));
}

template <class T>
void print_hash(const Case& test, const char* what, device::Context& context,
                const device::Buffer<T>& buffer) {
  std::vector<T> values(buffer.size());
  context.read(buffer, std::span(values));
  print_hash(test, what, std::span<const T>(values));
}

/// A torus of small triangles, a plate of large ones, and a crowd of photons in one point of it:
/// more than insertion sort takes in one cell.
Scene torus_and_plate(std::size_t lights, bool glossy) {
  Scene scene = empty_scene(lights);
  if (glossy) {
    scene.materials[0].specular = glm::vec3(0.04f, 0.2f, 0.6f);
    scene.materials[0].roughness = 0.3f;
  }
  add_plate(scene, {-1.5f, -1.5f, -0.5f}, {3, 0, 0}, {0, 3, 0.1f}, 2);
  add_torus(scene, 1.0f, 0.4f, 12, 8);
  return scene;
}

/// Two large triangles with photons on one side: nothing comes near the other.
Photons photons_of(const Scene& scene, std::size_t count) {
  const std::size_t crowd = count / 4;
  Photons photons = uniform_photons(scene, count - crowd, 71);
  std::mt19937_64 random(72);
  const auto [a, b, c] = scene.corners(0);
  for (std::size_t i = 0; i < crowd; ++i) {
    add_photon(photons, scene, 0.5f * a + 0.3f * b + 0.2f * c, 0, random);
  }
  return sort_by_oriented_face(std::move(photons), 2 * scene.triangle_count());
}

PrimaryHits hits_of(const Scene& scene, std::size_t count) {
  PrimaryHits hits = uniform_hits(scene, count, 73);
  if (!needs_of(scene).glossy) return hits;
  std::mt19937_64 random(74);
  std::uniform_real_distribution<float> uniform(-0.5f, 0.5f);
  for (const std::uint32_t map : hits.oriented_face) {
    const glm::vec3 normal(face_normal(scene, map));
    const glm::vec3 offset(uniform(random), uniform(random), uniform(random));
    hits.outgoing.push_back(glm::normalize(normal + offset));
    hits.lobe.push_back({scene.materials[0].specular, scene.materials[0].roughness, normal});
  }
  return hits;
}

void print_fingerprint(std::span<Device> devices, const Case& test, const Sizes& sizes) {
  const Photons photons = photons_of(test.scene, sizes.photons);
  const PrimaryHits hits = hits_of(test.scene, sizes.hits);
  const NeighbourGroups groups = find_neighbour_groups(test.scene, {radius, 60});
  std::vector<PhotonMaps> all_maps;
  if (test.structure == "uniform-grid") {
    all_maps = estimate::build_maps_on_each(devices, test.scene, photons, groups, {radius},
                                            Progress::none());
  } else {
    for (Device& device : devices) {
      all_maps.push_back(structures::build(structures::named(test.structure), device, test.scene,
                                           photons, groups, {radius}));
    }
  }
  const PhotonMaps& maps = all_maps.back();
  for (std::size_t i = 0; i < maps::store_of(maps).pages.size(); ++i) {
    const maps::MapPage& page = maps::store_of(maps).pages.use(i);
    device::Context& context = device::context_of(maps.device());
    print_hash(test, "cell_start", context, page.cell_start);
    print_hash(test, "record_photon", context, page.record_photon);
    print_hash(test, "record_position", context, page.record_position);
    print_hash(test, "record_flux", context, page.record_flux);
  }
  Estimator estimator(maps, test.scene, test.parameters());
  const NeighbourLists lists = estimator.nearest(hits);
  print_hash(test, "neighbours", std::span(lists.photons));
  print_hash(test, "squared_radius", std::span(lists.squared_radius));
  estimate::PhotonEstimate light(
      devices, test.scene,
      {std::make_shared<const std::vector<PhotonMaps>>(std::move(all_maps)), test.parameters()});
  const LightTable estimates = light.at(hits, Progress::none());
  print_hash(test, "irradiance", estimates.irradiance);
  if (needs_of(test.scene).glossy) print_hash(test, "radiance", estimates.radiance);
  if (!estimates.light.empty()) {
    print_hash(test, "lights", std::span(estimates.light));
    print_hash(test, "first", std::span(estimates.first));
  }
}

std::vector<Case> cases(bool every_kernel) {
  std::vector<Case> list{{"one-light", torus_and_plate(1, false)},
                         {"three-lights", torus_and_plate(3, false)},
                         {"many-lights", torus_and_plate(300, false)}};
  const auto add_weighted = [&](DensityKernel kernel, std::size_t lights, bool glossy) {
    list.push_back({fmt::format("{}-{}-lights", name_of(kernel), lights),
                    torus_and_plate(lights, glossy), "uniform-grid", 50, std::nullopt, kernel});
  };
  add_weighted(DensityKernel::cone, 1, false);
  add_weighted(DensityKernel::cone, 3, false);
  if (!every_kernel) return list;
  add_weighted(DensityKernel::cone, 20, true);
  list.push_back({"glossy", torus_and_plate(1, true)});
  list.push_back({"glossy-three-lights", torus_and_plate(3, true)});
  list.push_back({"glossy-many-lights", torus_and_plate(20, true)});
  list.push_back({"kdtree-3d-many-lights", torus_and_plate(20, false), "kdtree-3d"});
  for (const structures::Structure& structure : structures::all()) {
    if (structure.name == "uniform-grid") continue;
    list.push_back({structure.name, torus_and_plate(1, false), structure.name});
  }
  // Lists too long for private memory.
  list.push_back({"kdtree-3d-k-300", torus_and_plate(1, false), "kdtree-3d", 300});
  return list;
}

std::vector<Case> cases_of_lanes() {
  std::vector<Case> list;
  for (const int width : {32, 64}) {
    const EstimateTuning tuning{EstimateStrategy::lanes, width, 4, width};
    const auto add = [&](std::string_view name, std::size_t lights, bool glossy, int neighbours,
                         DensityKernel kernel = DensityKernel::constant) {
      list.push_back({fmt::format("{}-lanes-{}", width, name), torus_and_plate(lights, glossy),
                      "uniform-grid", neighbours, tuning, kernel});
    };
    add("one-light", 1, false, 50);
    add("three-lights", 3, false, 50);
    add("many-lights", 300, false, 50);
    add("glossy", 1, true, 50);
    add("glossy-many-lights", 20, true, 50);
    // More candidates than a group keeps.
    add("k-1000", 1, false, 1000);
    add("cone", 1, false, 50, DensityKernel::cone);
  }
  return list;
}

}  // namespace
}  // namespace photile::test

int main(int count, char** arguments) {
  using namespace photile;
  using namespace photile::test;
  if (count < 3) {
    fmt::print(stderr, "usage: photile_fingerprint PHOTONS HITS [--every-kernel | --lanes]\n");
    return static_cast<int>(app::ExitCode::usage);
  }
  const Sizes sizes{std::strtoul(arguments[1], nullptr, 10),
                    std::strtoul(arguments[2], nullptr, 10)};
  const std::string_view set = count > 3 ? arguments[3] : "";
  try {
    std::vector<Device> devices = open_devices();
    for (const Device& device : devices) {
      fmt::print(stderr, "device: {} ({})\n", device.info().name, device.info().platform);
    }
    const char* const expected_devices = std::getenv("PHOTILE_FINGERPRINT_DEVICES");
    if (expected_devices != nullptr && std::to_string(devices.size()) != expected_devices) {
      throw DeviceError(fmt::format("{} devices, not {}", devices.size(), expected_devices));
    }
    for (const Case& test : set == "--lanes" ? cases_of_lanes() : cases(set == "--every-kernel")) {
      print_fingerprint(devices, test, sizes);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "photile_fingerprint: error: {}\n", error.what());
    return static_cast<int>(app::exit_code_of(error));
  }
  if (all_finite) return 0;
  fmt::print(stderr, "photile_fingerprint: error: an estimate is not a finite number\n");
  return static_cast<int>(app::ExitCode::input);
}
