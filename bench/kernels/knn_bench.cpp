// The estimate from k nearest photons against their number (figure 6 of Graglia et al. 2012): every
// structure of photile on the OpenCL device, nanoflann and Embree on the host, all hardware
// threads. Each result is checked against a search in double precision.
//
// Slow cases answer fewer queries, so that a case keeps to --seconds-per-case.
//
// With --points and --queries the photons and the queries are those of files: docs/bench-points.md.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <numeric>

#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photile/statistics.hpp"
#include "structures/structure.hpp"
#include "structures/visits.hpp"
#include "support/bench_record.hpp"
#include "support/estimate_check.hpp"
#include "support/hit_sample.hpp"
#include "support/host_search.hpp"
#include "support/least_work.hpp"
#include "support/morton_order.hpp"
#include "support/point_bench.hpp"
#include "support/workload.hpp"

namespace {

using namespace photile;
using namespace photile::bench;

struct Settings {
  BenchOptions common;
  // Empty: those of the plan.
  std::vector<std::string> workloads;
  std::vector<std::uint64_t> photons;
  std::vector<int> neighbours;
  std::size_t plane_queries = 524'288;
  int width = 512, height = 512;
  std::vector<std::string> structures;  ///< names; empty: all
  float photons_per_cell = defaults::photons_per_cell;
  std::string strategy;  ///< of uniform grids; "": that of the device

  void make_quick() {
    if (workloads.empty()) workloads = {"plane", "living-room"};
    if (photons.empty()) photons = {2'000};
    if (neighbours.empty()) neighbours = {defaults::neighbours, 200};
    plane_queries = 4'096;
    width = height = 32;
  }
};

/// What is measured of a workload.
struct Plan {
  std::string workload;
  std::vector<std::uint64_t> photons;
  std::vector<int> neighbours;

  Plan restricted(const Settings& settings) const {
    return {workload, settings.photons.empty() ? photons : settings.photons,
            settings.neighbours.empty() ? neighbours : settings.neighbours};
  }
};

const std::vector<Plan>& plans() {
  static const std::vector<std::uint64_t> powers{1'000, 10'000, 100'000, 1'000'000, 10'000'000};
  static const std::vector<int> neighbours{16, 50, 100, 200, 500, 1000};
  static const std::vector<Plan> all{{"plane", powers, neighbours},
                                     {"living-room", powers, neighbours},
                                     {"fine-mesh", powers, {16, 50, 200, 1000}},
                                     {"classroom", {1'000'000}, {50, 200}}};
  return all;
}

/// Left out are brute force where it would take minutes, and the trees over millions of photons at
/// every k but one: their builds would take most of the run.
bool worth_running(const structures::Structure& structure, std::size_t photons, int k) {
  constexpr std::size_t most_for_brute_force = 15'000, most_for_every_k = 3'000'000;
  if (structure.name == "brute-force") return photons <= most_for_brute_force;
  if (structure.is_grid()) return true;
  return photons <= most_for_every_k || k == defaults::neighbours;
}

/// Photons and k of one column of the figure.
struct Case {
  const Workload& workload;
  const Photons& photons;
  const NormalFilter& filter;
  int k;
  double radius;
  NeighbourGroups groups;
  PrimaryHits hits;  ///< those of the workload, in the order of the maps
  EstimateCheck check;
};

/// A sample of hits contains those of every larger stride up to this.
constexpr std::size_t most_stride = 64;

/// A sample of as many hits as `run` affords: a warm-up and three repeats within the budget.
HitSample affordable_hits(const PrimaryHits& hits, const Repeats& repeats,
                          const std::function<void(const PrimaryHits&)>& run) {
  constexpr double passes = 4;
  const HitSample pilot = block_sample(hits, most_stride);
  run(pilot.hits);  // compiles kernels
  const Stopwatch stopwatch;
  run(pilot.hits);
  const double hits_per_second = static_cast<double>(pilot.index.size()) / stopwatch.seconds();
  const double affordable = hits_per_second * repeats.seconds_per_case / passes;
  std::size_t stride = 1;
  while (stride<most_stride&& static_cast<double>(hits.size() / stride)> affordable) {
    stride *= 2;
  }
  return block_sample(hits, stride);
}

class KnnBench {
 public:
  explicit KnnBench(const Settings& settings)
      : repeats_(settings.common.repeats),
        structures_(settings.structures),
        photons_per_cell_(settings.photons_per_cell),
        record_("knn", settings.common),
        device_({.selector = settings.common.device}) {
    for (const EstimateStrategy strategy : all_estimate_strategies) {
      if (name_of(strategy) != settings.strategy) continue;
      tuning_ = shipped_tuning(device_.info(), strategy);
    }
    record_.set("photons per cell", photons_per_cell_);
    record_.set("strategy", settings.strategy.empty() ? "of the device" : settings.strategy);
    record_.set_device(device_.info());
    record_.set_version("nanoflann", nanoflann_version());
    record_.set_version("embree", embree_version());
  }

  void run(const Workload& workload, const Plan& plan) {
    for (const std::uint64_t count : plan.photons) {
      const Photons photons = workload.photons(count);
      const NormalFilter filter(*workload.scene, defaults::group_angle_degrees);
      const reference::DensityOracle oracle(*workload.scene, photons,
                                            reference::PhotonFilter::grouped,
                                            defaults::group_angle_degrees);
      const SearchInput input{photons, filter, workload.scene->lights.size()};
      const auto index = make_nanoflann_index(photons);
      const auto list = make_nanoflann_search(input, index, Candidates::sorted_list);
      const auto heap = make_nanoflann_search(input, index, Candidates::heap);
      const auto embree = make_embree_search(input);
      for (const int k : plan.neighbours) {
        if (static_cast<std::size_t>(k) >= photons.size()) continue;  // no k-th to find
        const double radius = automatic_radius(photons, k);
        NeighbourGroups groups = default_groups(*workload.scene, photons, radius);
        PrimaryHits hits = in_map_order(workload.hits, groups);
        EstimateCheck check(oracle, photons.size(), {k, radius}, hits,
                            block_sample(hits, most_stride).index);
        const Case c{workload, photons,           filter,          k,
                     radius,   std::move(groups), std::move(hits), std::move(check)};
        run_host(c, "nanoflann", *list, given_order);
        run_host(c, "nanoflann-heap", *heap, given_order);
        // Rivals differ little in how much their order matters: once is enough.
        if (k == defaults::neighbours) run_host(c, "nanoflann-morton", *list, morton_order);
        run_host(c, "embree", *embree, given_order);
        for (const structures::Structure& structure : structures::all()) {
          if (!requested(structure) || !worth_running(structure, photons.size(), k)) continue;
          run_device(c, structure);
        }
      }
    }
  }

  /// Whether all results were right.
  bool finish() {
    record_.write();
    return faults_ == 0;
  }

 private:
  using Order = std::vector<std::uint32_t> (*)(std::span<const glm::vec3>);

  static std::vector<std::uint32_t> given_order(std::span<const glm::vec3> positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    return order;
  }

  bool requested(const structures::Structure& structure) const {
    return structures_.empty() ||
           std::find(structures_.begin(), structures_.end(), structure.name) != structures_.end();
  }

  /// The times of a row, and how near they come to what no search can do without.
  static void set_seconds(nlohmann::json& row, const Case& c, const HitSample& asked,
                          const Timing& timing) {
    row["seconds"] = to_json(timing);
    LeastWork(asked.index.size(), c.k).add_to(row, timing.median());
  }

  nlohmann::json row_of(const Case& c, const std::string& structure, const HitSample& asked) const {
    return {{"workload", c.workload.name}, {"structure", structure},
            {"photons", c.photons.size()}, {"k", c.k},
            {"radius", c.radius},          {"queries", asked.index.size()}};
  }

  void run_host(const Case& c, const std::string& name, const HostSearch& search, Order order_of) {
    const SearchParameters parameters{static_cast<std::size_t>(c.k), static_cast<float>(c.radius)};
    DensityAnswers answers;
    std::vector<std::uint32_t> order;
    const auto estimate = [&](const PrimaryHits& hits) {
      if (order.size() != hits.size()) order = order_of(hits.position);
      search.estimate(hits, order, parameters, answers);
    };
    const HitSample asked = affordable_hits(c.hits, repeats_, estimate);
    order.clear();
    const Timing timing = measure(repeats_, [&] { estimate(asked.hits); });
    nlohmann::json row = row_of(c, name, asked);
    set_seconds(row, c, asked, timing);
    add(c, std::move(row), answers.irradiance, asked,
        c.check.radii_that_differ(answers.squared_radius, asked.index));
  }

  void run_device(const Case& c, const structures::Structure& structure) {
    const std::string& name = structure.name;
    try {
      const PhotonMaps maps =
          structures::build(structure, device_, *c.workload.scene, c.photons, c.groups,
                            {.radius = c.radius, .photons_per_cell = photons_per_cell_});
      Estimator estimator(
          maps, *c.workload.scene,
          {.neighbours = c.k, .radius = c.radius, .tuning = tuning_, .area = AreaMode::disc});
      Estimates estimates;
      const auto estimate = [&](const PrimaryHits& hits) { estimates = estimator.estimate(hits); };
      const HitSample asked = affordable_hits(c.hits, repeats_, estimate);
      nlohmann::json row = row_of(c, name, asked);
      set_seconds(row, c, asked, measure(repeats_, [&] { estimate(asked.hits); }));
      row["references"] = maps.statistics().references;
      if (!structure.is_grid()) {
        constexpr std::size_t most_hits = 4096;
        const HitSample some = thinned(block_sample(c.hits, most_stride), most_hits);
        const structures::Visits visits = structures::count_visits(maps, some.hits, c.k);
        row["nodes visited"] = visits.nodes;
        row["photons visited"] = visits.photons;
      }
      const PrimaryHits checked = hits_at(c.hits, c.check.index()).hits;
      add(c, std::move(row), estimates.irradiance, asked,
          c.check.radii_that_differ(estimator.nearest(checked).squared_radius, c.check.index()));
    } catch (const DeviceError& error) {
      nlohmann::json row = row_of(c, name, {});
      row["failure"] = error.what();  // out of memory: a result too
      record_.add(std::move(row));
    }
  }

  void add(const Case& c, nlohmann::json row, std::span<const glm::vec3> irradiance,
           const HitSample& asked, std::uint64_t radii_that_differ) {
    const std::uint64_t irradiances = c.check.irradiances_that_differ(irradiance, asked.index);
    row["radii that differ"] = radii_that_differ;
    row["irradiances that differ"] = irradiances;
    if (radii_that_differ + irradiances > 0) {
      print_fault(fmt::format("{}: {} photons, k = {}, {}", c.workload.name, c.photons.size(), c.k,
                              row["structure"].get<std::string>()),
                  radii_that_differ + irradiances);
    }
    faults_ += radii_that_differ + irradiances;
    record_.add(std::move(row));
  }

  Repeats repeats_;
  std::vector<std::string> structures_;
  float photons_per_cell_;
  std::optional<EstimateTuning> tuning_;
  BenchRecord record_;
  Device device_;
  std::uint64_t faults_ = 0;
};

/// None where the scene's folder is missing.
std::optional<Workload> workload_of(const std::string& name, const Settings& settings) {
  if (name == "plane") return plane_workload(settings.plane_queries);
  if (name == "living-room") {
    return interior_workload(name, living_room(), settings.width, settings.height);
  }
  if (name == "fine-mesh") {
    constexpr std::uint32_t cells = 100;  // 100,000 triangles, as in the paper's table
    return interior_workload(name, waved_hall(cells), settings.width, settings.height);
  }
  std::optional<Scene> scene = classroom();
  if (!scene) return std::nullopt;
  return interior_workload(name, std::move(*scene), settings.width, settings.height);
}

bool run(Settings& settings) {
  if (settings.common.quick) settings.make_quick();
  KnnBench bench(settings);
  const auto& requested = settings.workloads;
  for (const Plan& plan : plans()) {
    const bool chosen =
        std::find(requested.begin(), requested.end(), plan.workload) != requested.end();
    if (!requested.empty() && !chosen) continue;
    const std::optional<Workload> workload = workload_of(plan.workload, settings);
    if (workload) bench.run(*workload, plan.restricted(settings));
  }
  return bench.finish();
}

}  // namespace

int main(int argument_count, char** arguments) {
  Settings settings;
  CLI::App command("Time of the density estimate against the number of photons", "knn");
  add_options(command, settings.common);
  command.add_option("--photons", settings.photons, "photon counts");
  command.add_option("--neighbours,-k", settings.neighbours, "values of k");
  std::vector<std::string> workloads;
  for (const Plan& plan : plans()) workloads.push_back(plan.workload);
  command.add_option("--workloads", settings.workloads, "what is measured; default: all")
      ->check(CLI::IsMember(workloads));
  std::vector<std::string> structures, strategies;
  for (const structures::Structure& structure : structures::all()) {
    structures.push_back(structure.name);
  }
  for (const EstimateStrategy strategy : all_estimate_strategies) {
    strategies.emplace_back(name_of(strategy));
  }
  command.add_option("--structure", settings.structures, "structures of photile; default: all")
      ->check(CLI::IsMember(structures));
  command.add_option("--cells", settings.photons_per_cell, "photons per cell of uniform grids")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI::Option* const strategy =
      command
          .add_option("--strategy", settings.strategy,
                      "how uniform grids are queried; default: that of the device")
          ->check(CLI::IsMember(strategies));
  PointBenchSettings points;
  CLI::Option* const file =
      command.add_option("--points", points.photons, "photons of a .npy or .csv file, no scene");
  CLI::Option* const queries =
      command.add_option("--queries", points.queries, "where they are searched: a file, too");
  file->needs(queries)->excludes("--photons")->excludes("--workloads")->excludes(strategy);
  queries->needs(file);
  command.add_option("--radius", points.radius, "metres, with --points; default: automatic")
      ->check(CLI::PositiveNumber)
      ->needs(file);
  return run_bench(command, argument_count, arguments, [&] {
    if (points.photons.empty()) return run(settings);
    points.neighbours = settings.neighbours;
    points.structures = settings.structures;
    points.photons_per_cell = settings.photons_per_cell;
    if (points.neighbours.empty()) points.neighbours = {defaults::neighbours};
    return run_point_bench(settings.common, points);
  });
}
