#include "support/point_bench.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>
#include <optional>

#include "photile/errors.hpp"
#include "photile/estimator.hpp"
#include "photile/photon_cloud.hpp"
#include "photile/statistics.hpp"
#include "structures/structure.hpp"
#include "support/estimate_check.hpp"
#include "support/host_search.hpp"
#include "support/kernel_seconds.hpp"
#include "support/least_work.hpp"
#include "support/point_file.hpp"

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
    record_.set_version("nanoflann", nanoflann_version());
    record_.set_version("embree", embree_version());
    stored_.position = photons_.position;
    stored_.flux.assign(photons_.position.size(), glm::vec3(1.0f));
    stored_.oriented_face.resize(photons_.position.size());
    std::iota(stored_.oriented_face.begin(), stored_.oriented_face.end(), 0u);
    hits_.position = queries_.position;
    hits_.oriented_face.resize(queries_.position.size());
    std::iota(hits_.oriented_face.begin(), hits_.oriented_face.end(),
              static_cast<std::uint32_t>(stored_.size()));
  }

  bool run(std::vector<Device>& devices) {
    for (const int k : settings_.neighbours) {
      const double radius = settings_.radius > 0 ? settings_.radius : automatic_radius(stored_, k);
      check_.emplace(oracle_, stored_.size(), TimedEstimate{k, radius}, hits_);
      run_host(k, radius);
      for (Device& device : devices) {
        for (const Structure& structure : structures::all()) {
          if (!settings_.wants(structure.name) || !worth_running(structure, stored_.size()))
            continue;
          run_device(device, structure, k, radius);
        }
      }
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

  void run_host(int k, double radius) {
    const SearchInput input{stored_, filter_, 1};
    const SearchParameters parameters{static_cast<std::size_t>(k), static_cast<float>(radius)};
    std::vector<std::uint32_t> order(hits_.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto time = [&](const char* name, const HostSearch& search, double build_seconds) {
      DensityAnswers answers;
      const Timing timing =
          measure(repeats_, [&] { search.estimate(hits_, order, parameters, answers); });
      nlohmann::json row = row_of(name, "host", "", k, radius, timing);
      row["build"] = build_seconds;
      add(std::move(row), answers.irradiance, answers.squared_radius);
    };
    const Stopwatch nanoflann_watch;
    const auto index = make_nanoflann_index(stored_);
    const double nanoflann_seconds = nanoflann_watch.seconds();
    time("nanoflann-heap", *make_nanoflann_search(input, index, Candidates::heap),
         nanoflann_seconds);
    time("nanoflann", *make_nanoflann_search(input, index, Candidates::sorted_list),
         nanoflann_seconds);
    const Stopwatch embree_watch;
    const auto embree = make_embree_search(input);
    const double embree_seconds = embree_watch.seconds();
    time("embree", *embree, embree_seconds);
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

  Estimates estimate(Subject& subject, int k) const {
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

  void run_device(Device& device, const Structure& structure, int k, double radius) {
    const DeviceInfo& info = device.info();
    try {
      const Stopwatch build_watch;
      Subject subject = built(device, structure, radius);
      const double build_seconds = build_watch.seconds();
      Estimates estimates;
      std::vector<double> kernel_seconds;
      const Timing timing = measure_returned(repeats_, [&] {
        const Stopwatch watch;
        kernel_seconds.push_back(
            kernel_seconds_of(device, [&] { estimates = estimate(subject, k); }));
        return watch.seconds();
      });
      kernel_seconds.erase(kernel_seconds.begin());  // of the call that is not timed
      nlohmann::json row =
          row_of(structure.name, info.name, info.driver_version, k, radius, timing);
      row["kernel seconds"] = Timing{kernel_seconds}.median();
      row["build"] = build_seconds;
      row["map bytes"] = subject.statistics().device_bytes;
      row["references"] = subject.statistics().references;
      add(std::move(row), estimates.irradiance, squared_radii(subject, k, radius));
    } catch (const DeviceError& error) {
      record_.add({{"structure", structure.name},
                   {"device", info.name},
                   {"driver", info.driver_version},
                   {"k", k},
                   {"failure", error.what()}});
    }
  }

  nlohmann::json row_of(const std::string& structure, const std::string& device,
                        const std::string& driver, int k, double radius,
                        const Timing& timing) const {
    nlohmann::json row{{"structure", structure},    {"device", device},          {"driver", driver},
                       {"photons", stored_.size()}, {"queries", hits_.size()},   {"k", k},
                       {"radius", radius},          {"seconds", to_json(timing)}};
    LeastWork(hits_.size(), k).add_to(row, timing.median());
    return row;
  }

  void add(nlohmann::json row, const std::vector<glm::vec3>& irradiance,
           const std::vector<float>& squared_radius) {
    const std::uint64_t radii = check_->radii_that_differ(squared_radius);
    const std::uint64_t irradiances = check_->irradiances_that_differ(irradiance);
    row["radii that differ"] = radii;
    row["irradiances that differ"] = irradiances;
    if (radii + irradiances > 0) {
      print_fault(
          fmt::format("k = {}, {}", row["k"].get<int>(), row["structure"].get<std::string>()),
          radii + irradiances);
    }
    disagreements_ += radii + irradiances;
    record_.add(std::move(row));
  }

  Repeats repeats_;
  const PointBenchSettings& settings_;
  BenchRecord record_;
  PointFile photons_, queries_;
  NormalFilter filter_;
  Photons stored_;
  PrimaryHits hits_;
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
