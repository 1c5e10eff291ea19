#include "render/render_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cache/surface_cache.hpp"
#include "common/ascii_text.hpp"
#include "geometry/radius_range.hpp"
#include "photile/errors.hpp"
#include "photile/neighbour_groups.hpp"
#include "render/exchange.hpp"
#include "render/pass_count.hpp"
#include "render/setting.hpp"
#include "scene/scene_queries.hpp"
#include "trace/random_stream.hpp"

namespace photile {
namespace {

/// The photons that are traced: those whose light rays find are not stored.
PhotonTracerParameters all_photons(const RenderParameters& used) {
  return {.emitted_photons = used.photons.emitted_photons,
          .quota = used.photons.quota,
          .seed = used.seed,
          .max_path_length = used.photons.max_path_length,
          .roulette_start = used.photons.roulette_start,
          .store_direct = used.direct_rays == 0,
          .keep_caustics = used.light_map_rays > 0};
}

/// Says so where most photons have no other within the radius: most points then read nothing.
void note_lonely_photons(const Photons& photons, double radius, Progress& progress) {
  try {
    const double nearest = automatic_radius(photons, 1) / defaults::radius_over_median_kth_distance;
    if (radius >= nearest) return;
    progress.note(
        fmt::format("radius {:.3g} m: half of the photons have no neighbour within {:.3g} m; most "
                    "points receive no light; give a larger radius, or none",
                    radius, nearest));
  } catch (const UsageError&) {
    // Most photons coincide.
  }
}

}  // namespace

std::string_view name_of(GlossMode mode) {
  return name_in({"photons", "rays", "filtered", "auto"}, mode);
}

namespace {

/// Whether the light of matt surfaces is read from nodes.
///   passes   of photons; 0 = not known yet
bool reads_nodes(const RenderParameters& asked, int passes) {
  return asked.light_maps == LightMapMode::on || (asked.light_maps == LightMapMode::automatic &&
                                                  asked.maps != MapMode::naive && passes <= 1);
}

}  // namespace

bool nodes_gather(const RenderParameters& asked) {
  return asked.light_map_rays > 0 && asked.direct_rays == 0 && reads_nodes(asked, asked.passes);
}

PrimaryHitParameters eye_rays(const RenderParameters& parameters) {
  return {.width = parameters.film.width,
          .height = parameters.film.height,
          .samples_per_pixel = parameters.film.samples_per_pixel,
          .seed = parameters.seed,
          .max_specular_depth = parameters.max_specular_depth};
}

namespace {

/// Before anything else is exchanged. Errors: UsageError.
void require_same_work(const RenderParameters& asked, const Scene& scene) {
  ContentHash hash_of_scene, hash_of_settings;
  scene::add_scene(scene, hash_of_scene);
  require_same(*asked.processes, hash_of_scene, "scene");
  for (const Setting& setting : settings()) hash_of_settings.add(text_of(setting.value(asked)));
  require_same(*asked.processes, hash_of_settings, "settings");
}

}  // namespace

RenderPlan::RenderPlan(const RenderParameters& asked, const RayScene& rays, HitsAsk hits,
                       Progress& progress)
    : used_(asked),
      asked_passes_(asked.passes),
      for_points_(hits == HitsAsk::points),
      least_radius_(photile::least_radius(rays.scene())),
      scene_(rays.scene().source.filename().string()) {
  check(asked);
  if (asked.processes) require_same_work(asked, rays.scene());
  check_picture_memory(asked.film.width, asked.film.height, rays.scene(), progress);
  if (!nodes_gather(asked)) used_.light_map_rays = 0;
  if (asked.maps == MapMode::naive) used_.area = AreaMode::disc;
  if (asked.passes == 0) {
    used_.passes =
        automatic_passes(rays, all_photons(used_), progress, host_bytes_of_all(asked.processes));
  }
  if (asked.light_maps == LightMapMode::on && passes() > 1) {
    throw SettingError(
        setting_named("light_maps"),
        fmt::format(
            "light maps need one photon pass, except for single pictures whose nodes gather light "
            "(light_map_rays), and there are {}; use fewer photons, or one pass",
            passes()));
  }
  const bool read = reads_nodes(asked, passes());
  if (!read) used_.light_map_rays = 0;
  if (asked.gloss == GlossMode::automatic) {
    used_.gloss = read ? GlossMode::filtered : GlossMode::photons;
  }
  const bool at_points = hits == HitsAsk::points && asked.light_maps == LightMapMode::automatic &&
                         used_.light_map_rays == 0;
  used_.light_maps = read && !at_points ? LightMapMode::on : LightMapMode::off;
  leaves_out_hidden_ = read && !asked.counts_hidden_photons;
  // Beyond the scene there is nothing to find.
  if (asked.radius > 0) used_.radius = std::min(asked.radius, scene_diagonal(rays.scene()));
}

PhotonTracerParameters RenderPlan::tracing(int pass, const std::vector<std::uint64_t>& paths_before,
                                           int parts) const {
  PhotonTracerParameters parameters = all_photons(used_);
  if (used_.processes) parameters.shard = {used_.processes->rank(), used_.processes->size()};
  parameters.paths_before = paths_before;
  if (passes() == 1) {
    parameters.emitted_photons *= static_cast<std::uint64_t>(parts);
    return parameters;
  }
  const std::uint64_t all = used_.photons.emitted_photons;
  const auto until = [&](int p) { return all / passes() * p + all % passes() * p / passes(); };
  parameters.emitted_photons = std::max<std::uint64_t>(1, until(pass + 1) - until(pass));
  return parameters;
}

double RenderPlan::radius(const Photons& photons, Progress& progress) const {
  if (used_.radius > 0) {
    if (photons.total() >= 2) note_lonely_photons(photons, used_.radius, progress);
    return used_.radius;
  }
  if (photons.total() < 2) {
    // Nothing but lights, mirrors and glass is seen, or rays find all the light there is.
    if (all_photons(used_).store_direct) {
      progress.note(fmt::format("{}: only mirrors and glass are lit", scene_));
    }
    return std::max(1.0, least_radius_);  // any serves
  }
  try {
    const double radius = automatic_radius(photons, used_.neighbours);
    if (radius >= least_radius_) return radius;
    throw UsageError(
        fmt::format("automatic radius: {:.3g} m is less than {:.3g} m, the minimum in a scene of "
                    "this extent; remove distant objects, or give a radius",
                    radius, least_radius_));
  } catch (const UsageError& error) {
    throw SettingError(setting_named("radius"), fmt::format("{}: {}", scene_, error.what()));
  }
}

PhotonMapParameters RenderPlan::maps(int pass, double first_radius) const {
  return {.radius = estimate_of_pass(pass, {first_radius, used_.neighbours}).radius,
          .photons_per_cell = used_.photons_per_cell,
          .large_pages = !reads_light_maps()};  // whose nodes are few
}

EstimateParameters RenderPlan::estimate(int pass, DensityKernel kernel,
                                        const std::shared_ptr<const SurfaceIndex>& surface) const {
  return {.neighbours = estimate_of_pass(pass, {0, used_.neighbours}).neighbours,
          .compiled_neighbours = used_.neighbours,
          .area = used_.area,
          .kernel = kernel,
          .surface = surface};
}

int RenderPlan::neighbours_at_ends() const {
  return std::min(used_.neighbours, std::max(defaults::least_neighbours_at_ends,
                                             used_.neighbours / defaults::neighbours_over_ends));
}

double RenderPlan::reach_at_ends(double radius) const {
  return radius * std::sqrt(static_cast<double>(neighbours_at_ends()) / used_.neighbours);
}

cache::LightMapParameters RenderPlan::light_maps(double radius, const Scene& scene,
                                                 const Photons& photons,
                                                 std::span<const double> powers) const {
  const int times = gathers_at_nodes() ? defaults::photons_between_nodes : 1;
  cache::LightMapParameters parameters = cache::light_map_parameters(
      scene, photons, times * used_.neighbours, std::sqrt(times) * radius, used_.angle_degrees,
      used_.light_map_spacing, used_.light_map_detail, powers);
  parameters.neighbours = used_.neighbours;
  parameters.processes = used_.processes;
  return parameters;
}

cache::LightMapParameters RenderPlan::ends(double radius, const Scene& scene,
                                           const Photons& photons,
                                           std::span<const double> powers) const {
  cache::LightMapParameters parameters =
      cache::light_map_parameters(scene, photons, neighbours_at_ends(), reach_at_ends(radius),
                                  used_.angle_degrees, 0, 0, powers);
  parameters.levels = 1;
  parameters.processes = used_.processes;
  return parameters;
}

cache::IrradianceGatherParameters RenderPlan::node_gathering(
    double radius, const cache::LightMapParameters& maps) const {
  return {.rays = used_.light_map_rays,
          .light_samples = used_.light_map_rays,
          .near = defaults::near_radii * reach_at_ends(radius),
          .resolution = for_points_ ? std::numeric_limits<double>::infinity()
                                    : maps.spacing / std::exp2(maps.levels - 1),
          .caustic_neighbours = used_.neighbours,
          .seed = trace::seed_of_repeat(used_.seed, 0),
          .max_specular_depth = used_.max_specular_depth};
}

PrimaryHitParameters RenderPlan::hits(const Film& film, int passes) const {
  RenderParameters parameters = used_;
  parameters.film = film;
  PrimaryHitParameters hits = eye_rays(parameters);
  hits.samples_per_pixel = passes * ((film.samples_per_pixel - 1) / passes + 1);
  hits.passes = passes;
  // Where light is read between nodes, a sample takes little time.
  if (reads_light_maps() && hits.samples_per_pixel >= defaults::edge_probes) {
    hits.times_at_edges = std::clamp(defaults::edge_samples / hits.samples_per_pixel, 1,
                                     defaults::most_times_at_edges);
  }
  hits.direct_rays = used_.direct_rays;  // as the photons are traced
  hits.lobe_rays = used_.gloss != GlossMode::photons;
  hits.split_at_glass = true;
  return hits;
}

}  // namespace photile
