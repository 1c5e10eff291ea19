#include "support/point_bench.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photile/photon_cloud.hpp"
#include "photile/statistics.hpp"
#include "structures/structure.hpp"
#include "support/estimate_check.hpp"
#include "support/morton_order.hpp"
#include "support/point_file.hpp"
#include "support/rivals.hpp"
#include "support/turns.hpp"

namespace photile::bench {
namespace {

using structures::Structure;

/// Left out are brute force over so many photons that it takes minutes, and structures of a map
/// each: without a scene there are no triangles that have one.
bool worth_running(const Structure& structure, std::size_t photons) {
  constexpr std::size_t most_for_brute_force = 15'000;
  if (structure.name == "brute-force") return photons <= most_for_brute_force;
  return structure.global || structure.is_grid();
}

class PointBench {
 public:
  PointBench(const BenchOptions& options, const PointBenchSettings& settings)
      : repeats_(options.repeats),
        settings_(settings),
        record_("points", options),
        photons_(read_points(settings.photons)),
        queries_(read_points(settings.queries)),
        filter_(normals(), defaults::group_angle_degrees),
        stored_(stored()),
        hits_(hits()),
        rivals_(stored_, filter_, hits_.oriented_face, 1),
        oracle_({filter_.normals().begin(), filter_.normals().end()}, 1.0, stored_,
                defaults::group_angle_degrees) {
    if (photons_.normal.empty() != queries_.normal.empty()) {
      throw InputError(fmt::format("{} has {} and {} has {}: give both or neither",
                                   settings.photons.string(), normals_of(photons_),
                                   settings.queries.string(), normals_of(queries_)));
    }
    record_.set("photons per cell", settings.photons_per_cell);
    record_.set("photons", settings.photons.filename().string());
    record_.set("queries", settings.queries.filename().string());
    for (const auto& [library, version] : rival_versions()) record_.set_version(library, version);
  }

  bool run(std::vector<Device>& devices) {
    for (const int k : settings_.neighbours) {
      const double radius = settings_.radius > 0 ? settings_.radius : automatic_radius(stored_, k);
      check_.emplace(oracle_, stored_.size(), TimedEstimate{k, radius}, hits_);
      std::vector<Contestant> contestants;
      add_rivals(contestants, k, radius);
      for (Device& device : devices) {
        for (const Structure& structure : structures::all()) {
          if (!settings_.wants(structure.name) || !worth_running(structure, stored_.size()))
            continue;
          add_structure(contestants, device, structure, k, radius);
        }
      }
      disagreements_ += take_turns(contestants, repeats_);
      for (Contestant& one : contestants) record_.add(std::move(one.row));
    }
    record_.write();
    return disagreements_ == 0;
  }

 private:
  static const char* normals_of(const PointFile& file) {
    return file.normal.empty() ? "no normals" : "normals";
  }

  /// The normals of photons, then of queries; without any all agree.
  std::vector<glm::vec3> normals() const {
    std::vector<glm::vec3> all = photons_.normal;
    all.insert(all.end(), queries_.normal.begin(), queries_.normal.end());
    all.resize(photons_.position.size() + queries_.position.size(), glm::vec3(0, 0, 1));
    return all;
  }

  /// The photons of the file: each of flux 1, on a face of its own.
  Photons stored() const {
    Photons photons;
    photons.position = photons_.position;
    photons.flux.assign(photons_.position.size(), glm::vec3(1.0f));
    photons.oriented_face.resize(photons_.position.size());
    std::iota(photons.oriented_face.begin(), photons.oriented_face.end(), 0u);
    return photons;
  }

  PrimaryHits hits() const {
    PrimaryHits hits;
    hits.position = queries_.position;
    hits.oriented_face.resize(queries_.position.size());
    std::iota(hits.oriented_face.begin(), hits.oriented_face.end(),
              static_cast<std::uint32_t>(stored_.size()));
    return hits;
  }

  /// Each library at its best, with queries in Morton order; the sort is not timed.
  void add_rivals(std::vector<Contestant>& contestants, int k, double radius) {
    const SearchParameters parameters{static_cast<std::size_t>(k), static_cast<float>(radius)};
    const auto order =
        std::make_shared<const std::vector<std::uint32_t>>(morton_order(hits_.position));
    for (const Rivals::Library& library : rivals_.at_their_best(hits_, parameters)) {
      const auto answers = std::make_shared<DensityAnswers>();
      contestants.push_back({row_of(library.name, "host", "", k, radius),
                             [this, answers, order, parameters, search = library.best().search] {
                               search->estimate(hits_, *order, parameters, *answers);
                             },
                             [this, answers](nlohmann::json& row) {
                               return differences(row, answers->irradiance,
                                                  answers->squared_radius);
                             }});
      library.add_to(contestants.back().row);
    }
  }

  /// Photons in a structure: maps that place points themselves, or that are asked at hits.
  struct Subject {
    std::optional<PhotonCloud> cloud;
    std::optional<PhotonMaps> maps;

    const PhotonMapStatistics& statistics() const {
      return cloud ? cloud->statistics() : maps->statistics();
    }
  };

  Subject built(Device& device, const Structure& structure, double radius) const {
    Subject subject;
    if (structure.is_grid()) {
      subject.cloud.emplace(device,
                            CloudPhotons{.position = photons_.position, .normal = photons_.normal},
                            CloudParameters{.radius = radius,
                                            .photons_per_cell = structure.photons_per_cell > 0
                                                                    ? structure.photons_per_cell
                                                                    : settings_.photons_per_cell});
    } else {
      const double angle = photons_.normal.empty() ? 180.0 : defaults::group_angle_degrees;
      subject.maps.emplace(
          structures::build_over(structure, device, {stored_, filter_.normals(), angle}, radius));
    }
    return subject;
  }

  LightTable estimate(Subject& subject, int k) const {
    if (subject.cloud) {
      return subject.cloud->irradiance(queries_.position, queries_.normal, {.neighbours = k});
    }
    return Estimator(*subject.maps, Scene(), {.neighbours = k, .area = AreaMode::disc})
        .estimate(hits_);
  }

  /// The squared radius of the k-th photon of each query, or of the search.
  std::vector<float> squared_radii(Subject& subject, int k, double radius) const {
    if (subject.maps) {
      return Estimator(*subject.maps, Scene(), {.neighbours = k, .area = AreaMode::disc})
          .nearest(hits_)
          .squared_radius;
    }
    const CloudNeighbours found = subject.cloud->nearest(queries_.position, queries_.normal, k);
    std::vector<float> squared_radius;
    const auto width = static_cast<std::size_t>(k);
    for (std::size_t i = 0; i < hits_.size(); ++i) {
      const float farthest = found.squared_distance[(i + 1) * width - 1];
      squared_radius.push_back(std::isinf(farthest)
                                   ? static_cast<float>(radius) * static_cast<float>(radius)
                                   : farthest);
    }
    return squared_radius;
  }

  void add_structure(std::vector<Contestant>& contestants, Device& device,
                     const Structure& structure, int k, double radius) {
    nlohmann::json row =
        row_of(structure.name, device.info().name, device.info().driver_version, k, radius);
    try {
      const Stopwatch build_watch;
      const auto subject = std::make_shared<Subject>(built(device, structure, radius));
      row["build"] = build_watch.seconds();
      row["map bytes"] = subject->statistics().device_bytes;
      row["references"] = subject->statistics().references;
      const auto estimates = std::make_shared<LightTable>();
      *estimates = estimate(*subject, k);  // a device that has no memory for it says so now
      contestants.push_back(
          {std::move(row), [this, subject, estimates, k] { *estimates = estimate(*subject, k); },
           [this, subject, estimates, k, radius](nlohmann::json& done) {
             return differences(done, estimates->irradiance, squared_radii(*subject, k, radius));
           },
           &device});
    } catch (const DeviceError& error) {
      row["failure"] = error.what();
      record_.add(std::move(row));
    }
  }

  nlohmann::json row_of(const std::string& structure, const std::string& device,
                        const std::string& driver, int k, double radius) const {
    return {{"structure", structure},    {"device", device},        {"driver", driver},
            {"photons", stored_.size()}, {"queries", hits_.size()}, {"k", k},
            {"radius", radius}};
  }

  std::uint64_t differences(nlohmann::json& row, const std::vector<glm::vec3>& irradiance,
                            const std::vector<float>& squared_radius) const {
    const std::uint64_t radii = check_->radii_that_differ(squared_radius);
    const std::uint64_t irradiances = check_->irradiances_that_differ(irradiance);
    row["radii that differ"] = radii;
    row["irradiances that differ"] = irradiances;
    return radii + irradiances;
  }

  Repeats repeats_;
  const PointBenchSettings& settings_;
  BenchRecord record_;
  PointFile photons_, queries_;
  NormalFilter filter_;
  Photons stored_;
  PrimaryHits hits_;
  Rivals rivals_;
  reference::DensityOracle oracle_;
  std::optional<EstimateCheck> check_;  ///< of the k at hand
  std::uint64_t disagreements_ = 0;
};

}  // namespace

bool run_point_bench(const BenchOptions& options, const PointBenchSettings& settings) {
  PointBench bench(options, settings);  // reads the files before devices are opened
  std::vector<Device> devices =
      open_devices({.selector = options.device.empty() ? "all" : options.device, .profile = true});
  return bench.run(devices);
}

}  // namespace photile::bench
