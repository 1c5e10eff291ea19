#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/renderer.hpp"
#include "photile/scene_renderer.hpp"
#include "render/device_estimators.hpp"
#include "render/film.hpp"
#include "render/hit_source.hpp"
#include "render/neighbour_choice.hpp"
#include "render/pass_count.hpp"
#include "render/pass_schedule.hpp"
#include "render/render_costs.hpp"

namespace photile {
namespace {

/// Primary hits estimated at a time: enough to fill a device, little enough to stay in memory, and
/// fewer where each takes longer, so that progress is seen and a wish to stop is heard.
std::int64_t hits_per_batch(int neighbours) {
  return (std::int64_t{1} << 20) * defaults::neighbours /
         std::max(defaults::neighbours, neighbours);
}

/// Least number of batches of a picture that somebody watches.
constexpr int watched_batches = 16;

NeighbourGroups groups_of(const Scene& scene, const Photons& photons,
                          const RenderParameters& parameters, double radius, Progress& progress) {
  const bool global = parameters.structure == MapStructure::kdtree_global;  // no use for patches
  const MapMode mode =
      global && parameters.maps != MapMode::naive ? MapMode::triangle : parameters.maps;
  return find_map_groups(scene, photons, mode, {radius, parameters.angle_degrees}, progress);
}

/// One rendering: what its photon passes share.
class Rendering {
 public:
  Rendering(const Scene& scene, std::span<Device> devices, const RenderParameters& parameters,
            Progress& progress)
      : scene_(scene),
        devices_(devices),
        parameters_(parameters),
        progress_(&progress),
        rays_(scene),
        layer_powers_(layer_powers(scene)) {
    costs_.structure.add(stopwatch_.seconds(), rays_.bytes());
    passes_ = parameters.passes > 0 ? parameters.passes
                                    : automatic_passes(rays_, parameters.photons_used(), progress);
    paths_before_.assign(scene.lights.size(), 0);
  }

  int passes() const { return passes_; }

  /// From now on.
  void report_to(Progress& progress) { progress_ = &progress; }

  /// Begins a picture.
  void start(const PrimaryHitParameters& film) {
    // Passes share the samples of a pixel: photons of one pass make the errors of neighbouring
    // samples alike, those of another do not.
    film_ = film;
    film_.direct_rays = parameters_.film.direct_rays;  // as the photons were traced
    film_.passes = passes_;
    film_.samples_per_pixel = passes_ * ((film.samples_per_pixel - 1) / passes_ + 1);
    layers_ = LightLayers(film_.width, film_.height, scene_);
    shares_.assign(devices_.size(), 0.0);
    costs_.start_picture();
  }

  /// Traces the photons of a pass and builds their maps. Those of the pass before are gone.
  ///   prepared   photons and groups in place of traced ones, or null; taken
  ///   keep       is given those of the first pass, or null
  void prepare(int pass, PreparedPhotons* prepared, const KeepPhotons* keep) {
    estimators_.clear();
    maps_.clear();
    maps_ = trace_and_build(pass, prepared, keep);
    const PassEstimate estimate = estimate_of_pass(pass, first_);
    levels_ = levels_of(estimate.neighbours);
    for (const int neighbours : levels_) {
      estimators_.emplace_back(
          devices_, maps_, scene_,
          EstimateParameters{neighbours, 0, parameters_.tuning, parameters_.neighbours,
                             parameters_.area, parameters_.kernel, surface_});
    }
    pass_ = pass;
  }

  /// Adds what is seen by the photons of the prepared pass.
  void add_pass(const HitSource& source) {
    film_.pass = pass_;
    add_pass_rows(source);
    const std::vector<double> shares = estimators_.back().shares();
    for (std::size_t i = 0; i < shares_.size(); ++i) shares_[i] += shares[i] / passes_;
  }

  /// The picture since `start`.
  RenderResult finish() {
    costs_.film.host_bytes = layers_.bytes();
    costs_.shares.clear();
    for (const Device& device : devices_) {  // devices compile at the same time
      costs_.compile_seconds = std::max(costs_.compile_seconds, device.compile_seconds());
    }
    for (std::size_t i = 0; i < devices_.size() && devices_.size() > 1; ++i) {
      const DeviceInfo& device = devices_[i].info();
      costs_.shares.emplace_back("share of " + device.id + " " + device.name, shares_[i]);
    }
    return {.layers = std::move(layers_),
            .statistics = costs_.statistics(),
            .radius = first_.radius,
            .stored_photons = costs_.stored_photons,
            .passes = passes_,
            .samples_per_pixel = film_.samples_per_pixel,
            .device_shares = shares_};
  }

 private:
  /// The k that hits of a pass choose from; just one unless they are to have their own.
  std::vector<int> levels_of(int neighbours) const {
    const int least = parameters_.least_neighbours;
    return least > 0 ? neighbour_levels(std::min(least, neighbours), neighbours)
                     : std::vector{neighbours};
  }

  /// The maps of a pass. Its photons are gone when this returns: the maps hold copies.
  std::vector<PhotonMaps> trace_and_build(int pass, PreparedPhotons* prepared,
                                          const KeepPhotons* keep) {
    PreparedPhotons own;
    own.photons = prepared ? take(*prepared) : trace(pass);
    const Photons& photons = own.photons;
    if (pass == 0) {
      first_ = {prepared ? prepared->radius : radius_for(photons), parameters_.neighbours};
      find_groups(photons, prepared);  // once: no later radius is larger
      find_surface(photons);
    }
    if (keep) {
      own.radius = first_.radius;
      std::swap(own.groups, groups_);
      (*keep)(own);
      std::swap(own.groups, groups_);
    }
    const Stopwatch stopwatch;
    std::vector<PhotonMaps> maps =
        build_maps_on_each(devices_, scene_, photons, groups_,
                           {estimate_of_pass(pass, first_).radius, parameters_.photons_per_cell,
                            parameters_.structure},
                           *progress_);
    std::uint64_t device_bytes = 0, spilled_bytes = 0;
    for (const PhotonMaps& one : maps) {
      device_bytes += one.statistics().device_bytes - one.statistics().spilled_bytes;
      spilled_bytes += one.statistics().spilled_bytes;
    }
    costs_.build.add(stopwatch.seconds(), spilled_bytes, device_bytes);
    const PhotonMapStatistics& built = maps.front().statistics();
    costs_.maps = built.maps;
    costs_.mixed_maps = built.mixed_maps;
    costs_.references += built.references;
    costs_.largest_map = std::max(costs_.largest_map, built.largest_map);
    return maps;
  }

  Photons trace(int pass) {
    PhotonTracerParameters parameters = parameters_.photons_used();
    const auto until = [&](int p) {  // paths of the passes before p
      return parameters_.photons.emitted_photons / passes_ * p +
             parameters_.photons.emitted_photons % passes_ * p / passes_;
    };
    if (passes_ > 1) {
      parameters.emitted_photons = std::max<std::uint64_t>(1, until(pass + 1) - until(pass));
      parameters.paths_before = paths_before_;
    }
    PhotonTracerResult traced = trace_photons(rays_, parameters, *progress_);
    count(traced.photons, traced.seconds);
    return std::move(traced.photons);
  }

  Photons take(PreparedPhotons& prepared) {
    count(prepared.photons, 0);
    return std::move(prepared.photons);
  }

  double radius_for(const Photons& photons) const {
    if (parameters_.radius > 0) return parameters_.radius;
    // Where rays bring all the light there is, no photon is stored, and any radius serves.
    if (parameters_.film.direct_rays > 0 && photons.size() < 2) return 1;
    return automatic_radius(photons, parameters_.neighbours);
  }

  void count(const Photons& photons, double seconds) {
    for (std::size_t light = 0; light < paths_before_.size(); ++light) {
      const std::uint64_t paths = photons.emitted_per_light[light];
      paths_before_[light] += paths;
      costs_.emitted_photons += paths;
    }
    costs_.stored_photons += photons.size();
    costs_.trace.add(seconds, photons.bytes());
  }

  void find_groups(const Photons& photons, PreparedPhotons* prepared) {
    const Stopwatch stopwatch;
    groups_ = prepared ? std::move(prepared->groups)
                       : groups_of(scene_, photons, parameters_, first_.radius, *progress_);
    costs_.group.add(stopwatch.seconds(), groups_.bytes());
    costs_.group_members = groups_.members.size();
    costs_.groups = groups_.offsets.size() - 1;
    costs_.patches = groups_.patches.count();
  }

  void find_surface(const Photons& photons) {
    if (parameters_.area_used() != AreaMode::clipped) return;
    const Stopwatch stopwatch;
    surface_ = std::make_shared<const SurfaceIndex>(index_surface(
        scene_, landed_on(scene_, photons), first_.radius, parameters_.angle_degrees));
    costs_.surface.add(stopwatch.seconds(), surface_->bytes());
    costs_.sheets = surface_->sheets;
    costs_.surface_leaves = surface_->leaves.size();
  }

  void add_pass_rows(const HitSource& source) {
    const std::int64_t samples_per_row =
        std::int64_t{film_.width} * (film_.samples_per_pixel / film_.passes);
    const int most = source.watched() ? (film_.height - 1) / watched_batches + 1 : film_.height;
    const int rows = static_cast<int>(std::clamp<std::int64_t>(
        hits_per_batch(parameters_.neighbours) / samples_per_row, 1, most));
    progress_->begin("estimate radiance", static_cast<std::uint64_t>(film_.height), "rows");
    for (int first = 0; first < film_.height; first += rows) {
      progress_->throw_if_cancelled();
      const int last = std::min(first + rows, film_.height);
      add_rows(source, first, last);
      source.show(layers_, first, last, (film_.pass + 1.0) / film_.passes);
      progress_->advance(static_cast<std::uint64_t>(last - first));
    }
    progress_->end();
  }

  void add_rows(const HitSource& source, int first, int last) {
    const Stopwatch hit_watch;
    const PrimaryHitBatch batch = source.trace(rays_, film_, first, last, maps_.front().map_of());
    costs_.hits.add(hit_watch.seconds());
    const Stopwatch estimate_watch;
    std::vector<Estimates> by_level;
    for (DeviceEstimators& one : estimators_) by_level.push_back(one.estimate(batch.hits));
    const Estimates estimates =
        by_level.size() == 1
            ? std::move(by_level.front())
            : estimates_of_least_error(std::move(by_level), levels_, layer_powers_);
    costs_.estimate.add(estimate_watch.seconds());
    const Stopwatch film_watch;
    add_to_film(layers_, batch, estimates, 1.0f / static_cast<float>(film_.samples_per_pixel));
    costs_.film.add(film_watch.seconds());
    costs_.rays += batch.rays;
    costs_.hit_count += batch.hits.size();
  }

  const Stopwatch stopwatch_;  // before rays_, whose construction it times
  const Scene& scene_;
  std::span<Device> devices_;
  const RenderParameters parameters_;
  Progress* progress_;
  const RayScene rays_;
  int passes_ = 1;
  PrimaryHitParameters film_;
  LightLayers layers_;
  std::vector<std::uint64_t> paths_before_;  ///< per light
  PassEstimate first_;
  NeighbourGroups groups_;
  std::shared_ptr<const SurfaceIndex> surface_;  ///< where areas are clipped
  std::vector<PhotonMaps> maps_;                 ///< of the pass, on each device
  std::vector<int> levels_;                      ///< of k
  std::vector<DeviceEstimators> estimators_;  ///< of each level; they keep references to the maps
  int pass_ = 0;
  std::vector<double> shares_;
  RenderCosts costs_;
  const std::vector<double> layer_powers_;
};

void check(std::span<const Device> devices, const RenderParameters& parameters) {
  if (devices.empty()) throw UsageError("rendering needs a device; give at least one");
  if (parameters.least_neighbours < 0 || parameters.least_neighbours > parameters.neighbours) {
    throw UsageError("least neighbours: " + std::to_string(parameters.least_neighbours) +
                     " is not between 0 and the " + std::to_string(parameters.neighbours) +
                     " neighbours");
  }
  if (parameters.passes < 0 || parameters.passes > limits::max_passes) {
    throw UsageError("passes: " + std::to_string(parameters.passes) + " is not between 0 and " +
                     std::to_string(limits::max_passes));
  }
}

}  // namespace

RenderResult render_hits(const Scene& scene, const HitSource& hits, std::span<Device> devices,
                         const RenderParameters& parameters, Progress& progress) {
  check(devices, parameters);
  Rendering rendering(scene, devices, parameters, progress);
  rendering.start(parameters.film);
  for (int pass = 0; pass < rendering.passes(); ++pass) {
    rendering.prepare(pass, nullptr, nullptr);
    rendering.add_pass(hits);
  }
  return rendering.finish();
}

RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  return render_hits(scene, CameraHits(camera), devices, parameters, progress);
}

struct SceneRenderer::Impl : Rendering {
  using Rendering::Rendering;

  RenderResult render(const HitSource& hits, const PrimaryHitParameters& film, Progress& progress) {
    report_to(progress);
    start(film);
    add_pass(hits);
    return finish();
  }
};

SceneRenderer::SceneRenderer(const Scene& scene, std::span<Device> devices,
                             const RenderParameters& parameters, PreparedPhotons* prepared,
                             const KeepPhotons& keep, Progress& progress) {
  check(devices, parameters);
  impl_ = std::make_unique<Impl>(scene, devices, parameters, progress);
  if (impl_->passes() > 1) {
    throw UsageError(
        "photon maps that are kept have to fit in memory at once: use fewer photons, or --passes 1 "
        "where more memory may be taken");
  }
  impl_->prepare(0, prepared, keep ? &keep : nullptr);
}

SceneRenderer::~SceneRenderer() = default;

RenderResult SceneRenderer::render(const Camera& camera, const PrimaryHitParameters& film,
                                   Progress& progress) {
  return impl_->render(CameraHits(camera), film, progress);
}

RenderResult SceneRenderer::render(const HitSource& hits, const PrimaryHitParameters& film,
                                   Progress& progress) {
  return impl_->render(hits, film, progress);
}

RenderResult SceneRenderer::render_reflections(const Camera& camera,
                                               const PrimaryHitParameters& film,
                                               Progress& progress) {
  return impl_->render(ReflectedHits(camera), film, progress);
}

RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress) {
  return render(scene, camera, std::span(&device, 1), parameters, progress);
}

}  // namespace photile
