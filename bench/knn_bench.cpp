// The estimate from k nearest photons against their number (figure 6 of Graglia et al. 2012): every
// structure of photile on the OpenCL device, nanoflann and Embree on the host, all hardware
// threads. Each result is checked against nanoflann's.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <numeric>
#include <set>

#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "support/agreement.hpp"
#include "support/bench_record.hpp"
#include "support/host_search.hpp"
#include "support/morton_order.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Settings {
  BenchOptions common;
  std::vector<std::uint64_t> plane_photons{1'000, 10'000, 100'000, 1'000'000, 4'000'000};
  std::vector<std::uint64_t> interior_photons{100'000, 1'000'000, 4'000'000};
  std::vector<int> neighbours{16, 50, 100, 200};
  std::vector<std::string> workloads{"plane", "living-room", "classroom"};
  std::size_t plane_queries = 524'288;
  int width = 512, height = 512;

  void make_quick() {
    plane_photons = {2'000};
    interior_photons = {20'000};
    neighbours = {16};
    workloads = {"plane", "living-room"};
    plane_queries = 4'096;
    width = height = 32;
    common.repeats = {1, 1};
  }
};

/// Photons and k of one column of the figure, with the answers that all must give.
struct Case {
  const Workload& workload;
  const Photons& photons;
  const NormalFilter& filter;
  int k;
  double radius;
  NeighbourGroups groups;
  HitSample sample;
  DensityAnswers reference;
};

class KnnBench {
 public:
  explicit KnnBench(const Settings& settings)
      : settings_(settings),
        record_("knn", settings.common),
        device_({.selector = settings.common.device}) {
    record_.set_device(device_.info());
    record_.set_version("nanoflann", nanoflann_version());
    record_.set_version("embree", embree_version());
  }

  void run(const Workload& workload, const std::vector<std::uint64_t>& photon_counts) {
    for (const std::uint64_t count : photon_counts) {
      const Photons photons = workload.photons(count);
      const NormalFilter filter(*workload.scene, defaults::group_angle_degrees);
      const SearchInput input{photons, filter, workload.scene->lights.size()};
      const std::unique_ptr<HostSearch> list =
          make_nanoflann_search(input, Candidates::sorted_list);
      const std::unique_ptr<HostSearch> heap = make_nanoflann_search(input, Candidates::heap);
      const std::unique_ptr<HostSearch> embree = make_embree_search(input);
      for (const int k : settings_.neighbours) {
        const double radius = automatic_radius(photons, k);
        Case c{workload,
               photons,
               filter,
               k,
               radius,
               find_neighbour_groups(*workload.scene, {radius}),
               sample_of(workload.hits, 4096),
               {}};
        std::vector<std::uint32_t> given(workload.hits.size());
        std::iota(given.begin(), given.end(), 0u);
        run_host(c, "nanoflann", *list, given);
        run_host(c, "nanoflann-heap", *heap, given);
        run_host(c, "nanoflann-morton", *list, morton_order(workload.hits.position));
        run_host(c, "embree", *embree, given);
        for (const MapStructure structure : all_map_structures) run_device(c, structure);
      }
    }
  }

  /// Whether all results agreed.
  bool finish() {
    record_.write();
    return disagreements_ == 0;
  }

 private:
  nlohmann::json row_of(const Case& c, const std::string& structure) const {
    return {{"workload", c.workload.name}, {"structure", structure},
            {"photons", c.photons.size()}, {"k", c.k},
            {"radius", c.radius},          {"queries", c.workload.hits.size()}};
  }

  /// The first answers of a case become the reference.
  void run_host(Case& c, const std::string& name, const HostSearch& search,
                const std::vector<std::uint32_t>& order) {
    DensityAnswers answers;
    const SearchParameters parameters{static_cast<std::size_t>(c.k), static_cast<float>(c.radius)};
    const Timing timing = measure(settings_.common.repeats, [&] {
      search.estimate(c.workload.hits, order, parameters, answers);
    });
    if (c.reference.squared_radius.empty()) c.reference = answers;
    nlohmann::json row = row_of(c, name);
    row["seconds"] = to_json(timing);
    row["radii that differ"] =
        count_radius_differences(answers.squared_radius, c.reference.squared_radius, 1e-5);
    add(c, std::move(row), answers.irradiance);
  }

  void run_device(const Case& c, MapStructure structure) {
    constexpr std::size_t most_for_brute_force = 10'000;
    if (structure == MapStructure::brute_force && c.photons.size() > most_for_brute_force) return;
    nlohmann::json row = row_of(c, std::string(name_of(structure)));
    try {
      const PhotonMaps maps(device_, *c.workload.scene, c.photons, c.groups,
                            {.radius = c.radius, .structure = structure});
      Estimator estimator(maps, *c.workload.scene, {c.k, c.radius});
      Estimates estimates;
      row["seconds"] = to_json(measure(settings_.common.repeats,
                                       [&] { estimates = estimator.estimate(c.workload.hits); }));
      row["references"] = maps.statistics().references;
      const NeighbourLists nearest = estimator.nearest(c.sample.hits);
      std::vector<float> expected;
      for (const std::uint32_t i : c.sample.index) {
        expected.push_back(c.reference.squared_radius[i]);
      }
      row["radii that differ"] = count_radius_differences(nearest.squared_radius, expected, 1e-5);
      add(c, std::move(row), estimates.irradiance);
    } catch (const DeviceError& error) {
      row["failure"] = error.what();  // out of memory: a result too
      record_.add(std::move(row));
    }
  }

  /// Off the plane, neighbours that lie at the radius itself may be one more or fewer by rounding,
  /// which changes the sum but not the disc: there only the radii are held to agree.
  void add(const Case& c, nlohmann::json row, const std::vector<glm::vec3>& irradiance) {
    std::uint64_t differences = row["radii that differ"];
    if (c.workload.name == "plane") {
      const std::uint64_t different = irradiances_that_differ(c, irradiance);
      row["irradiances that differ"] = different;
      differences += different;
    }
    if (differences > 0) {
      std::cerr << fmt::format("{}: {} photons, k = {}: {} differs from nanoflann at {} hits\n",
                               c.workload.name, c.photons.size(), c.k,
                               row["structure"].get<std::string>(), differences);
    }
    disagreements_ += differences;
    record_.add(std::move(row));
  }

  /// Ties left out, unless there are too many to be ties.
  static std::uint64_t irradiances_that_differ(const Case& c,
                                               const std::vector<glm::vec3>& irradiance) {
    const std::vector<std::size_t> hits =
        irradiance_differences(irradiance, c.reference.irradiance, 1e-4);
    constexpr std::size_t most_ties = 100;
    if (hits.size() > most_ties) return hits.size();
    const PrimaryHits& all = c.workload.hits;
    return static_cast<std::uint64_t>(std::count_if(hits.begin(), hits.end(), [&](std::size_t hit) {
      return !has_tied_rim(c.photons, c.filter, all.position[hit], all.sided_triangle[hit],
                           c.reference.squared_radius[hit]);
    }));
  }

  const Settings& settings_;
  BenchRecord record_;
  Device device_;
  std::uint64_t disagreements_ = 0;
};

bool run(Settings& settings) {
  if (settings.common.quick) settings.make_quick();
  KnnBench bench(settings);
  const std::set<std::string> wanted(settings.workloads.begin(), settings.workloads.end());
  if (wanted.contains("plane")) {
    bench.run(plane_workload(settings.plane_queries), settings.plane_photons);
  }
  if (wanted.contains("living-room")) {
    bench.run(interior_workload("living-room", living_room(), settings.width, settings.height),
              settings.interior_photons);
  }
  std::optional<Scene> shared = wanted.contains("classroom") ? classroom() : std::nullopt;
  if (shared) {
    bench.run(interior_workload("classroom", std::move(*shared), settings.width, settings.height),
              settings.interior_photons);
  }
  return bench.finish();
}

}  // namespace

int main(int argument_count, char** arguments) {
  Settings settings;
  CLI::App command("Time of the density estimate against the number of photons", "knn");
  add_options(command, settings.common);
  command.add_option("--plane-photons", settings.plane_photons, "counts on the plane");
  command.add_option("--interior-photons", settings.interior_photons, "counts in interiors");
  command.add_option("--neighbours,-k", settings.neighbours, "values of k");
  command.add_option("--workloads", settings.workloads, "plane, living-room, classroom");
  return run_bench(command, argument_count, arguments, [&] { return run(settings); });
}
