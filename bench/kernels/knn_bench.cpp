// The estimate from k nearest photons against their number (figure 6 of Graglia et al. 2012), and
// lists of these: every structure of photile on the OpenCL device, nanoflann and Embree on the
// host, all hardware threads, in turns. Each result is checked against a search in double
// precision.
//
// Slow cases answer fewer queries, so that a case keeps to --seconds-per-case.
//
// With --points and --queries the photons and the queries are those of files:
// docs/kernels/points.md.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <type_traits>

#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "structures/structure.hpp"
#include "structures/visits.hpp"
#include "support/bench_record.hpp"
#include "support/estimate_check.hpp"
#include "support/hit_sample.hpp"
#include "support/morton_order.hpp"
#include "support/point_bench.hpp"
#include "support/rivals.hpp"
#include "support/turns.hpp"
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
  static const std::vector<int> neighbours{16, 50, 200, 1000};
  static const std::vector<Plan> all{{"plane", powers, neighbours},
                                     {"living-room", powers, neighbours},
                                     {"fine-mesh", powers, neighbours},
                                     {"classroom", {1'000'000}, {50, 200}}};
  return all;
}

/// Left out are millions of photons at every k but one: building over them would take most of the
/// run.
bool affordable(std::size_t photons, int k) {
  return photons <= 3'000'000 || k == defaults::neighbours;
}

/// Brute force would take minutes.
bool worth_running(const structures::Structure& structure, std::size_t photons) {
  return structure.name != "brute-force" || photons <= 15'000;
}

/// Photons and k of one column of the figure.
struct Case {
  const Workload& workload;
  const Photons& photons;
  int k;
  double radius;
  NeighbourGroups groups;
  PrimaryHits hits;  ///< those of the workload, in the order of the maps
  EstimateCheck check;
};

/// A sample of hits contains those of every larger stride up to this.
constexpr std::size_t most_stride = 64;

/// A sample of as many hits as `run` affords: a warm-up and three repeats within the budget. Where
/// the host runs it, other programs that slow it down make it no smaller.
HitSample affordable_hits(const PrimaryHits& hits, const Repeats& repeats, bool on_host,
                          const std::function<void(const PrimaryHits&)>& run) {
  constexpr double passes = 4;
  const HitSample pilot = block_sample(hits, most_stride);
  run(pilot.hits);  // compiles kernels
  RunTimes times;
  times.count([&] { run(pilot.hits); });
  const double waited = times.wall.seconds[0], computed = times.processor.seconds[0];
  const double hits_per_second =
      static_cast<double>(pilot.index.size()) / (on_host ? std::min(waited, computed) : waited);
  const double affordable = hits_per_second * repeats.seconds_per_case / passes;
  std::size_t stride = 1;
  while (stride<most_stride&& static_cast<double>(hits.size() / stride)> affordable) {
    stride *= 2;
  }
  return block_sample(hits, stride);
}

/// Lists are as many bytes as the device may have: k and photons of those that are timed.
bool worth_listing(std::size_t photons, int k) {
  return k <= 200 && photons > 500'000 && photons < 2'000'000;
}

class KnnBench {
 public:
  explicit KnnBench(const Settings& settings)
      : repeats_(settings.common.repeats),
        structures_(settings.structures),
        photons_per_cell_(settings.photons_per_cell),
        record_("knn", settings.common),
        device_({.selector = settings.common.device, .profile = true}) {
    for (const EstimateStrategy strategy : all_estimate_strategies) {
      if (name_of(strategy) != settings.strategy) continue;
      tuning_ = shipped_tuning(device_.info(), strategy);
    }
    record_.set("photons per cell", photons_per_cell_);
    record_.set("strategy", settings.strategy.empty() ? "of the device" : settings.strategy);
    record_.set_device(device_.info());
    for (const auto& [library, version] : rival_versions()) record_.set_version(library, version);
  }

  void run(const Workload& workload, const Plan& plan) {
    for (const std::uint64_t count : plan.photons) {
      const Photons photons = workload.photons(count);
      const NormalFilter filter(*workload.scene, defaults::group_angle_degrees);
      const reference::DensityOracle oracle(*workload.scene, photons,
                                            reference::PhotonFilter::grouped,
                                            defaults::group_angle_degrees);
      Rivals rivals(photons, filter, workload.hits.oriented_face, workload.scene->lights.size());
      for (const int k : plan.neighbours) {
        if (static_cast<std::size_t>(k) >= photons.size()) continue;  // no k-th to find
        if (!affordable(photons.size(), k)) continue;
        const double radius = automatic_radius(photons, k);
        NeighbourGroups groups = default_groups(*workload.scene, photons, radius);
        PrimaryHits hits = in_map_order(workload.hits, groups);
        EstimateCheck check(oracle, photons.size(), {k, radius}, hits,
                            block_sample(hits, most_stride).index);
        const Case c{workload,        photons,         k, radius, std::move(groups),
                     std::move(hits), std::move(check)};
        run_case(c, rivals);
      }
    }
  }

  /// Whether all results were right.
  bool finish() {
    record_.write();
    return faults_ == 0;
  }

 private:
  bool requested(const structures::Structure& structure) const {
    return structures_.empty() ||
           std::find(structures_.begin(), structures_.end(), structure.name) != structures_.end();
  }

  bool on_host() const { return device_.info().type == DeviceType::cpu; }

  void run_case(const Case& c, Rivals& rivals) {
    const bool lists = worth_listing(c.photons.size(), c.k);
    const SearchParameters parameters{static_cast<std::size_t>(c.k), static_cast<float>(c.radius)};
    std::vector<Contestant> contestants;
    const std::size_t tried = std::max<std::size_t>(500'000 / parameters.k, 512);
    const HitSample trial = thinned(block_sample(c.hits, most_stride), tried);
    for (const Rivals::Library& library : rivals.at_their_best(trial.hits, parameters)) {
      contestants.push_back(rival<DensityAnswers>(c, library, parameters));
      if (lists) contestants.push_back(rival<ListAnswers>(c, library, parameters));
    }
    for (const structures::Structure& structure : structures::all()) {
      if (!requested(structure) || !worth_running(structure, c.photons.size())) continue;
      try {
        const auto searched = std::make_shared<Searched>(structure, *this, c);
        contestants.push_back(estimate_by(c, structure, searched));
        if (lists && structure.name == "uniform-grid") {
          contestants.push_back(list_by(c, structure, searched));
        }
      } catch (const DeviceError& error) {  // out of memory: a result too
        nlohmann::json row = row_of(c, structure.name, {});
        row["failure"] = error.what();
        record_.add(std::move(row));
      }
    }
    faults_ += take_turns(contestants, repeats_);
    for (Contestant& one : contestants) record_.add(std::move(one.row));
  }

  nlohmann::json row_of(const Case& c, const std::string& structure, const HitSample& asked) const {
    return {{"workload", c.workload.name}, {"structure", structure},
            {"photons", c.photons.size()}, {"k", c.k},
            {"radius", c.radius},          {"queries", asked.index.size()}};
  }

  /// The answers that differ from the oracle's, which the row tells.
  static std::uint64_t differences(nlohmann::json& row, std::uint64_t radii,
                                   std::uint64_t irradiances) {
    row["radii that differ"] = radii;
    row["irradiances that differ"] = irradiances;
    return radii + irradiances;
  }

  /// A library at its best: of estimates, or of lists.
  template <class Answers>
  Contestant rival(const Case& c, const Rivals::Library& library,
                   const SearchParameters& parameters) {
    constexpr bool lists = std::is_same_v<Answers, ListAnswers>;
    struct State {
      HitSample asked;
      std::vector<std::uint32_t> order;
      Answers answers;
    };
    const auto state = std::make_shared<State>();
    const auto ask = [state, parameters, search = library.best().search](const PrimaryHits& hits) {
      if (state->order.size() != hits.size()) state->order = morton_order(hits.position);
      if constexpr (lists) {
        search->nearest(hits, state->order, parameters, state->answers);
      } else {
        search->estimate(hits, state->order, parameters, state->answers);
      }
    };
    state->asked = affordable_hits(c.hits, repeats_, true, ask);
    state->order.clear();
    Contestant one{row_of(c, library.name + (lists ? list_rows : ""), state->asked),
                   [ask, state] { ask(state->asked.hits); },
                   [&c, state](nlohmann::json& row) {
                     const auto& of = state->asked.index;
                     std::uint64_t irradiances = 0;
                     if constexpr (!lists) {
                       irradiances = c.check.irradiances_that_differ(state->answers.irradiance, of);
                     }
                     return differences(
                         row, c.check.radii_that_differ(state->answers.squared_radius, of),
                         irradiances);
                   }};
    library.add_to(one.row);
    return one;
  }

  /// Photons in a structure, with who asks it.
  struct Searched {
    Searched(const structures::Structure& structure, KnnBench& bench, const Case& c)
        : maps(
              structures::build(structure, bench.device_, *c.workload.scene, c.photons, c.groups,
                                {.radius = c.radius, .photons_per_cell = bench.photons_per_cell_})),
          estimator(maps, *c.workload.scene,
                    {.neighbours = c.k,
                     .radius = c.radius,
                     .tuning = bench.tuning_,
                     .area = AreaMode::disc}) {}
    PhotonMaps maps;
    Estimator estimator;
    HitSample asked = {};  ///< of estimates
    LightTable estimates = {};
  };

  Contestant estimate_by(const Case& c, const structures::Structure& structure,
                         std::shared_ptr<Searched> searched) {
    const auto estimate = [searched](const PrimaryHits& hits) {
      searched->estimates = searched->estimator.estimate(hits);
    };
    searched->asked = affordable_hits(c.hits, repeats_, on_host(), estimate);
    return {row_of(c, structure.name, searched->asked),
            [estimate, searched] { estimate(searched->asked.hits); },
            [&c, &structure, searched](nlohmann::json& row) {
              row["references"] = searched->maps.statistics().references;
              if (!structure.is_grid()) add_visits(row, c, searched->maps);
              const PrimaryHits checked = hits_at(c.hits, c.check.index()).hits;
              return differences(
                  row,
                  c.check.radii_that_differ(searched->estimator.nearest(checked).squared_radius,
                                            c.check.index()),
                  c.check.irradiances_that_differ(searched->estimates.irradiance,
                                                  searched->asked.index));
            },
            &device_};
  }

  Contestant list_by(const Case& c, const structures::Structure& structure,
                     std::shared_ptr<Searched> searched) {
    const auto found = std::make_shared<NeighbourLists>();
    const auto list = [searched, found](const PrimaryHits& hits) {
      *found = searched->estimator.nearest(hits, ListOrder::any);
    };
    const auto asked =
        std::make_shared<HitSample>(affordable_hits(c.hits, repeats_, on_host(), list));
    return {row_of(c, structure.name + list_rows, *asked), [list, asked] { list(asked->hits); },
            [&c, found, asked](nlohmann::json& row) {
              return differences(row,
                                 c.check.radii_that_differ(found->squared_radius, asked->index), 0);
            },
            &device_};
  }

  static void add_visits(nlohmann::json& row, const Case& c, const PhotonMaps& maps) {
    constexpr std::size_t most_hits = 4096;
    const HitSample some = thinned(block_sample(c.hits, most_stride), most_hits);
    const structures::Visits visits = structures::count_visits(maps, some.hits, c.k);
    row["nodes visited"] = visits.nodes;
    row["photons visited"] = visits.photons;
  }

  static constexpr const char* list_rows = ", lists";

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
