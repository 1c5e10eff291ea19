// Pictures: the whole method in one call, many from the same photons, by paths, and without noise.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "photile/camera.hpp"
#include "photile/communicator.hpp"
#include "photile/device.hpp"
#include "photile/estimator.hpp"
#include "photile/light_layers.hpp"
#include "photile/light_table.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_maps.hpp"
#include "photile/photons.hpp"
#include "photile/progress.hpp"
#include "photile/ray_scene.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"

namespace photile {

/// Whether the light of matt surfaces is read from light maps.
enum class LightMapMode {
  off,       ///< an estimate at each hit: the method of the paper
  on,        ///< nodes, whose light rays or the photon estimate find (light_map_rays)
  automatic  ///< on for pictures, except with naive maps or several passes
};

/// "off", "on", "auto".
std::string_view name_of(LightMapMode mode);
inline constexpr std::array all_light_map_modes = {LightMapMode::off, LightMapMode::on,
                                                   LightMapMode::automatic};

/// The contents of light maps, without what follows from the scene and the parameters.
struct LightMapContents {
  struct Coordinates {
    std::uint32_t chart, x, y;  ///< in cells of the finest level
  };
  struct Tile {
    std::uint64_t known, split;  ///< bit y * 8 + x: cells whose corners have light; refined cells
    std::uint32_t chart, level, x, y;
  };
  std::string settings;  ///< in words: what the light depends on besides the scene and the photons
  std::vector<Coordinates> nodes;
  LightTable values;  ///< of the nodes
  std::vector<float> error,
      distance;             ///< of the nodes: standard error, and metres to what lights them
  std::vector<Tile> tiles;  ///< each after the one that it refines
};

/// The raster that a picture, or a row of sensors, is gathered in.
struct Film {
  int width = defaults::image_width;    ///< pixels
  int height = defaults::image_height;  ///< pixels
  int samples_per_pixel = defaults::samples_per_pixel;
};

/// The paths that leave the lights.
struct PhotonPaths {
  std::uint64_t emitted_photons = defaults::emitted_photons;  ///< over all lights
  PhotonQuota quota = PhotonQuota::balanced;
  int max_path_length = defaults::max_path_length;  ///< surface interactions
  int roulette_start = defaults::roulette_start;    ///< bounces before roulette may end a path
};

/// What finds the light that a specular lobe reflects (docs/method/gloss.md).
enum class GlossMode {
  photons,   ///< the photons around a hit, weighed by the lobe: the method of the paper
  rays,      ///< a ray from each hit for lobes that are narrow or faint; photons for others
  filtered,  ///< those rays, with their noise averaged over pixels of a picture that are alike
  automatic  ///< filtered where light maps are read, else photons
};

/// "photons", "rays", "filtered", "auto".
std::string_view name_of(GlossMode mode);
inline constexpr std::array all_gloss_modes = {GlossMode::photons, GlossMode::rays,
                                               GlossMode::filtered, GlossMode::automatic};

/// The settings of a rendering, each once. docs/reference/settings.md states what follows from
/// them, which stage reads which, and their ranges.
struct RenderParameters {
  std::uint64_t seed = defaults::seed;  ///< of all random numbers
  Film film = {};
  int max_specular_depth = defaults::max_specular_depth;  ///< mirrors and glass that a ray follows
  PhotonPaths photons = {};
  /// Photon passes, see docs/reference/memory.md: each traces its part of the photons, and the
  /// picture is their mean. 0 = as many as the memory of the host requires. With light maps `on`
  /// whose nodes gather: the number of parts into which all rays, photons and samples are divided,
  /// which are done in rounds (docs/method/rounds.md).
  int passes = 0;
  MapMode maps = MapMode::automatic;
  double radius = 0;  ///< metres; 0 = automatic_radius
  double angle_degrees = defaults::group_angle_degrees;
  int neighbours = defaults::neighbours;
  float photons_per_cell = defaults::photons_per_cell;
  AreaMode area = AreaMode::clipped;  ///< what the density divides by; naive maps take the disc
  DensityKernel kernel = DensityKernel::constant;  ///< the weight of each photon
  /// > 0: direct light is found by this many light samples at each hit. 0 = photons carry it.
  int direct_rays = 0;
  GlossMode gloss = GlossMode::automatic;
  LightMapMode light_maps = LightMapMode::automatic;  ///< see docs/method/light-maps.md
  /// > 0: each node of light maps gathers light by this many rays and as many light samples, fewer
  /// at finer levels (docs/method/gathering.md). 0 = the photon estimate finds their light.
  int light_map_rays = 0;
  /// Quicker, for first pictures: see docs/method/hidden-photons.md.
  bool counts_hidden_photons = false;
  double light_map_spacing = 0;  ///< metres between the coarsest nodes; 0 = chosen from the photons
  double light_map_detail = 0;   ///< metres between the finest nodes, at most; 0 = chosen as well
  /// Processes that share the rendering (docs/method/clusters.md), all with the same arguments:
  /// paths, photon maps and rows of the film are split between them, and rank 0 has the result.
  /// Null: this process renders alone. Kept as a reference.
  Communicator* processes = nullptr;
};

/// The rays of a whole picture by these parameters, as trace_paths takes them.
PrimaryHitParameters eye_rays(const RenderParameters& parameters);

struct RenderResult {
  LightLayers layers;
  RunStatistics statistics;
  /// The settings that the picture was made with: those that were given, and where these leave a
  /// choice or are not possible, those that were used (the radius is that of the first pass). With
  /// these, `render` gives the same picture.
  RenderParameters used;
  /// Relative standard error of what was read from nodes that gather, all lights together; 0 where
  /// none is known.
  double standard_error = 0;
  std::uint64_t stored_photons = 0;      ///< over all passes
  std::vector<double> device_fractions;  ///< each device's part of the hits, in [0, 1]
};

/// Renders the picture of `camera`, one layer per light, on one device or several at once. Each
/// device holds all maps, and estimates as many hits as its throughput so far allows. On devices of
/// one kind the picture is that of one of them, bit for bit.
/// Errors: those of the stages; the first device that fails ends the work of all.
RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress = Progress::none());
RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress = Progress::none());

/// A picture by path tracing: unbiased, without photons and without an OpenCL device. It is the
/// reference for photon maps.
struct PathTracerResult {
  LightLayers layers;
  RunStatistics statistics;
};

/// Renders the picture of `camera`, one layer per light, from film.samples_per_pixel paths a pixel.
/// Next event estimation and multiple importance sampling; paths end by Russian roulette, so that
/// no bounce is left out. What point, spot and directional lights throw through mirrors and
/// refracting glass onto other surfaces cannot be found and is missing. The picture depends on the
/// scene, the camera and the film (its seed; `pass` and `passes` are ignored) only, bit for bit,
/// whatever the number of threads. Errors: UsageError for values out of limits.hpp; InputError for
/// an area light without area; Interrupted.
PathTracerResult trace_paths(const Scene& scene, const Camera& camera,
                             const PrimaryHitParameters& film,
                             Progress& progress = Progress::none());

/// Whether lights of the scene have such caustics, which path tracing leaves out.
bool has_hidden_caustics(const Scene& scene);

/// The quality that sets all settings of a rendering unless they are given.
enum class Quality {
  draft,  ///< light maps whose nodes lie far apart: quick, soft
  good,   ///< nodes close enough for shadows: clean to the eye
  best    ///< the same with four times the rays, photons and samples
};

/// "draft", "good", "final".
std::string_view name_of(Quality quality);
inline constexpr std::array all_qualities = {Quality::draft, Quality::good, Quality::best};

/// The position of a quality in all_qualities.
constexpr std::size_t index_of(Quality quality) { return static_cast<std::size_t>(quality); }

/// A description of the pictures of a quality.
std::string_view description_of(Quality quality);

/// Sets the settings to which the table (docs/reference/settings.md) gives a value for the quality,
/// and leaves all others.
void set_quality(RenderParameters& parameters, Quality quality);

/// Names of all settings, such as "photons_emitted", in the order of the table.
std::vector<std::string_view> setting_names();

/// Sets one setting by its name: for programs whose users name settings. A whole number is accepted
/// wherever any number is. Errors: UsageError, one line that begins with the name, for an unknown
/// name or a value out of the range of the table.
void set_by_name(RenderParameters& parameters, std::string_view name,
                 const std::variant<std::uint64_t, double, std::string_view>& value);

/// The input of photon maps: all that depends on random numbers or takes long on the host.
struct TracedPhotons {
  Photons photons;
  NeighbourGroups groups;  ///< empty: found when maps are built
  double radius = 0;       ///< metres: of the maps; 0 where there are no groups
  /// The photons that came by mirrors and glass alone; present where rays gather.
  std::optional<Photons> caustics = std::nullopt;
  /// The contents of light maps of these photons, if they are kept. Where its settings are those of
  /// the rendering, maps are built from the photons when an estimate is first needed.
  std::optional<LightMapContents> light_maps = std::nullopt;

  bool has_groups() const { return radius > 0; }
};
using KeepPhotons = std::function<void(const TracedPhotons&)>;

/// The state of a quick frame.
struct DrawnFrame {
  /// The number of cells of light maps that it shows coarser than they should be.
  std::size_t lacking = 0;
  std::size_t empty = 0;        ///< of these, those without any light, which show that around them
  double lacking_fraction = 0;  ///< of the surface that is seen, in [0, 1]
  double unlit_fraction = 0;    ///< likewise, what shows the light around it
  double fill_seconds = 0;      ///< spent on missing nodes
  double draw_seconds = 0;      ///< spent on drawing the latest picture
};

/// How long a quick frame may spend on nodes that it lacks.
struct FrameFilling {
  /// The seconds that it may take; infinite: until no node is lacking. Implicit, because a frame
  /// has no other number.
  ///   ends     asked from time to time: true ends it at once, in the middle of a picture. Empty:
  ///            never
  ///   better   takes each picture that is better than the one before, and returns the seconds
  ///            until the next; the frame goes on until nothing is lacking. Empty: there is one
  FrameFilling(double limit, std::function<bool()> ends = {},
               std::function<double(const DrawnFrame&)> better = {})
      : seconds(limit), ended(std::move(ends)), show(std::move(better)) {}

  double seconds;
  std::function<bool()> ended;
  std::function<double(const DrawnFrame&)> show;
  /// Whether light stays softened where nothing is lacking, since better light maps follow: their
  /// cells are too large for what stands close to surface.
  bool soft = false;

  bool has_ended() const { return ended && ended(); }
};

/// The photon maps of a scene, kept on the devices while pictures are rendered from them.
class SceneRenderer {
 public:
  /// Traces the photons and builds the maps. The scene and the devices must outlive it.
  ///   prepared   used instead of tracing; of the same scene and parameters; left empty. Null: none
  ///   keep       called with what the maps are built from, before they are built. Empty: nothing
  /// Of several photon passes pictures are the mean of all; `prepared` and `keep` are of the first.
  /// Errors: those of `render`, and of `keep`; UsageError where the photons do not fit in memory at
  /// once, or where rays gather and `prepared` has no separate caustics.
  SceneRenderer(const Scene& scene, std::span<Device> devices, const RenderParameters& parameters,
                TracedPhotons* prepared = nullptr, const KeepPhotons& keep = {},
                Progress& progress = Progress::none());
  ~SceneRenderer();

  /// The picture that `render` gives with this film, bit for bit. Statistics contain the costs of
  /// the maps each time.
  ///   mixdown   of its layers, before they take memory; null = all layers stay separate
  RenderResult render(const Camera& camera, const Film& film, Progress& progress = Progress::none(),
                      const LayerMixdown* mixdown = nullptr);

  /// Draws the light on surfaces alone, from light maps: quick enough to walk in, one ray a sample,
  /// glossy surfaces as if they were matt (host/renderer/render/frame_renderer.hpp). For
  /// parameters that ask for light maps.
  ///   powers    per layer: power x tint
  ///   filling   of nodes which pixels lack: surface that takes most of the picture comes first;
  ///             other pixels show a coarser level, or light from around
  ///   picture   of the film's size, linear RGB radiance
  ///   coarser   of the same scene: shown where these light maps have no node yet, and filled
  ///             before these; null = none
  /// Once nothing is lacking, a frame that is not soft does not depend on what was drawn before.
  /// Errors: those of `render`.
  DrawnFrame draw(const Camera& camera, const Film& film, std::span<const glm::vec3> powers,
                  const FrameFilling& filling, std::span<glm::vec3> picture,
                  Progress& progress = Progress::none(), SceneRenderer* coarser = nullptr);

  /// From now on light maps take about this many bytes: `draw` discards what was visible least
  /// recently, but nothing of the latest picture. What was discarded is computed again, to the same
  /// bits, when it becomes visible.
  void bound_light_maps(std::uint64_t bytes);

  /// Whether `draw` has light maps to draw from.
  bool draws() const;

  /// The contents of the light maps so far; none where light maps are not read, or cannot be kept.
  std::optional<LightMapContents> light_maps() const;

  /// The part of the picture of `render` that comes by a mirror, by glass that bends or reflects
  /// light, or by a glossy lobe.
  RenderResult render_reflections(const Camera& camera, const Film& film,
                                  Progress& progress = Progress::none(),
                                  const LayerMixdown* mixdown = nullptr);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What lets a denoiser preserve edges: means of each pixel, row by row from the top. Mirrors and
/// glass show what is seen through them, in their tint.
struct DenoisingGuides {
  std::vector<glm::vec3> albedo;  ///< in [0, 1]; 1 where a light or the surroundings are seen
  std::vector<glm::vec3> normal;  ///< in world space, of the mean of the samples, not longer than 1
};

/// The guides of a picture.
///   film   its size; at most defaults::denoising_samples of its samples are traced
DenoisingGuides denoising_guides(const RayScene& rays, const Camera& camera, const Film& film,
                                 std::uint64_t seed);

/// A loaded library of Open Image Denoise 2, and its device on the processor
/// (https://www.openimagedenoise.org/documentation.html).
class Denoiser {
 public:
  /// Loads the library.
  ///   library   name or path of the shared library, as for the dynamic linker
  ///   threads   0 = all cores
  /// Errors: UsageError where there is no such library, or it lacks a function or a device.
  explicit Denoiser(const std::filesystem::path& library, int threads = 0);
  ~Denoiser();

  /// "Open Image Denoise 2.3.0".
  const std::string& version() const { return version_; }

  /// The layers, with the radiance of each denoised separately, guided by the guides, and the
  /// illuminance unchanged. A layer does not depend on the powers of lights, so that mixing stays
  /// linear; but the sum of denoised layers is not the denoised sum. A plane for each light: 16
  /// bytes per pixel and light.
  ///   errors   standard errors of the layers, where they are known: a value moves by at most
  ///            defaults::denoising_errors of them. Null: by any amount
  /// Errors: DeviceError of the library.
  LightLayers denoised(const LightLayers& layers, const DenoisingGuides& guides,
                       const LightLayers* errors) const;

 private:
  struct Library;
  std::unique_ptr<Library> library_;
  std::string version_;
};

}  // namespace photile
