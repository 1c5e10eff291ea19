// The whole method in one call: trace, group, build, estimate.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "photile/camera.hpp"
#include "photile/communicator.hpp"
#include "photile/device.hpp"
#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/light_maps.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/photon_tracer.hpp"
#include "photile/primary_hits.hpp"
#include "photile/progress.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"

namespace photile {

/// The raster that a picture, or a row of sensors, is gathered in.
struct Film {
  int width = defaults::image_width;    ///< pixels
  int height = defaults::image_height;  ///< pixels
  int samples_per_pixel = defaults::samples_per_pixel;
};

/// The paths that leave the lamps.
struct PhotonPaths {
  std::uint64_t emitted_photons = defaults::emitted_photons;  ///< over all lights
  PhotonQuota quota = PhotonQuota::balanced;
  int max_path_length = defaults::max_path_length;  ///< surface interactions
  int roulette_start = defaults::roulette_start;    ///< bounces before roulette may end a path
};

/// What finds the light that a specular lobe reflects (docs/gloss.md).
enum class GlossMode {
  photons,   ///< the photons around a hit, weighed by the lobe: the method of the paper
  rays,      ///< a ray of each hit, along lobes that are narrow or faint; photons for others
  automatic  ///< rays where light maps are read, else photons
};

/// "photons", "rays", "auto".
std::string_view name_of(GlossMode mode);
inline constexpr std::array all_gloss_modes = {GlossMode::photons, GlossMode::rays,
                                               GlossMode::automatic};

/// What is asked of a rendering, each setting once. What follows from them, and which stage reads
/// which, is said in docs/settings.md; their ranges are those of the table there.
struct RenderParameters {
  std::uint64_t seed = defaults::seed;  ///< of all random numbers
  Film film = {};
  int max_specular_depth = defaults::max_specular_depth;  ///< mirrors and glass that a ray follows
  PhotonPaths photons = {};
  /// Photon passes, see docs/memory.md: each traces its share of the photons, and the picture is
  /// their mean. 0 = as many as the host's memory asks for.
  int passes = 0;
  MapMode maps = MapMode::automatic;
  double radius = 0;  ///< metres; 0 = automatic_radius
  double angle_degrees = defaults::group_angle_degrees;
  int neighbours = defaults::neighbours;
  /// > 0: each hit has a number of neighbours of its own, from about this to `neighbours`: as many
  /// as its estimate can have before bias shows above the noise. 0 = all have `neighbours`.
  int least_neighbours = 0;
  float photons_per_cell = defaults::photons_per_cell;
  MapStructure structure = MapStructure::uniform_grid;
  AreaMode area = AreaMode::clipped;  ///< what the density divides by; naive maps take the disc
  DensityKernel kernel = DensityKernel::constant;  ///< what each photon counts
  /// > 0: light straight from lamps is found by so many looks at them from each hit. 0 = photons
  /// bring it.
  int direct_rays = 0;
  GlossMode gloss = GlossMode::automatic;
  LightMapMode light_maps = LightMapMode::automatic;  ///< see docs/light-maps.md
  /// > 0: nodes of light maps gather light by so many rays each, and as many looks at lamps, fewer
  /// at finer levels (docs/light-maps.md). 0 = the photon estimate values them.
  int light_map_rays = 0;
  double light_map_spacing = 0;  ///< metres between the coarsest nodes; 0 = by the photons
  double light_map_detail = 0;   ///< metres between the finest nodes, at most; 0 = by the photons
  /// Processes that share the rendering (docs/clusters.md), all with the same arguments: paths,
  /// photon maps and rows of the film are split between them, and rank 0 has the result. Null: this
  /// process has all. Kept as a reference.
  Communicator* processes = nullptr;
};

/// The rays of a whole picture by these parameters, as trace_paths takes them.
PrimaryHitParameters eye_rays(const RenderParameters& parameters);

struct RenderResult {
  LightLayers layers;
  RunStatistics statistics;
  /// What the picture was made with: as asked, and where that leaves a choice or cannot be had,
  /// what was found (the radius, of the first pass). Asked for these, `render` gives it again.
  RenderParameters used;
  std::uint64_t stored_photons = 0;   ///< over all passes
  std::vector<double> device_shares;  ///< each device's part of the hits, in [0, 1]
};

/// Renders the picture of `camera`, one layer per light, on one device or several at once. Each
/// device holds all maps, and estimates as many hits as its throughput so far allows. On devices of
/// one kind the picture is that of one of them, bit for bit.
/// Errors: those of the stages; the first device that fails ends the work of all.
RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress = Progress::none());
RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress = Progress::none());

}  // namespace photile
