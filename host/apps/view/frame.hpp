// A finished picture of the walkthrough, and how the screen shows it at the settings of the lights.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "measuring/measurement.hpp"
#include "photile/camera.hpp"
#include "photile/defaults.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "photile/renderer.hpp"
#include "photile/statistics.hpp"
#include "report/false_colour.hpp"

namespace photile::view {

struct InspectablePhotons;  // photon_map.hpp

/// The numbers that the noise of an estimate depends on.
struct EstimateNoise {
  /// Photons of one estimate, as many as equal weights would need for its noise; 0 = not known.
  double photons = 0;
  /// Paths of each layer's lights; of a mixed layer, those of its lights over their powers
  /// together.
  std::vector<double> paths;

  static EstimateNoise of(const Scene& scene, const RenderParameters& parameters);
  EstimateNoise pooled(const LayerMixdown& mixdown) const;
};

struct Frame {
  LightLayers layers;  ///< of a quick frame only width and height
  /// A quick frame of a moving viewer: the light of all lamps together, linear RGB; else empty.
  std::vector<glm::vec3> mixed;
  /// The part of it that came by reflection, where it was asked for.
  std::optional<LightLayers> reflections;
  std::shared_ptr<const InspectablePhotons> photons;  ///< of the maps it was estimated from
  std::shared_ptr<const Scene> scene;                 ///< that it shows, as the maps hold it
  Camera camera;                                      ///< in the scene's coordinates
  int samples_per_pixel = 1;
  double lacking = 0;                 ///< share of the surface whose light is not yet final
  std::uint64_t emitted_photons = 0;  ///< paths of the maps it was estimated from
  EstimateNoise noise;
  double seconds = 0;        ///< that it took
  RunStatistics statistics;  ///< of its stages
};

enum class DisplayMode {
  picture,      ///< tone mapped
  illuminance,  ///< of the surface seen, in false colour
  glare         ///< the picture, its unwanted reflections marked
};

struct DisplaySettings {
  DisplayMode mode = DisplayMode::picture;
  double exposure = 0;                  ///< stops on top of
  double automatic_stops = 0;           ///< of the automatic exposure of a frame
  std::array<float, 3> white{1, 1, 1};  ///< as ToneMapping has it
  /// The exposure follows a sky that is moved: from noon to dusk its light falls by a factor of a
  /// thousand.
  bool adapts = true;
  DisplayView view = ToneMapping{}.view;  ///< of the picture
  report::FalseColour false_colour;
  double glare_limit = defaults::glare_limit;  ///< as image::find_glare takes it
  bool photon_map = false;                     ///< of the clicked triangle, over any of the modes
};

/// sRGB texels of a frame.
struct DisplayedFrame {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< row 0 at the top
};

/// Mixes and colours a frame: the picture is what `photile render -o FILE.png` gives at that
/// exposure and view. Errors: UsageError for an unknown palette.
DisplayedFrame display(const Frame& frame, const LightMix& mix, const DisplaySettings& settings);

/// Stops of the automatic exposure by which `render -o FILE.png` scales this picture.
double automatic_stops(const Frame& frame, const LightMix& mix);

/// The white that `render` keeps with this picture, whose lamps the scene has as `mix`. A quick
/// frame does not know what each light gives: it has the mean colour of their powers.
std::array<float, 3> white_of(const Frame& frame, const LightMix& mix);

/// Illuminance of the surface that each pixel sees, lux.
std::vector<float> mixed_illuminance(const LightLayers& layers, const LightMix& mix);

/// Power x tint of each layer: what quick frames are mixed by.
std::vector<glm::vec3> scales_of(const LightMix& mix);

/// The light of one lamp at a pixel.
struct LightReading {
  Measured luminance;    ///< cd/m2 or W/(m2 sr)
  Measured illuminance;  ///< lux
};

/// Per light of the mix, at a pixel of the frame. Standard errors are those of photons that fall
/// independently of each other: 1 / sqrt(n) of a reading by n photons, where the photons of an
/// estimate are shared out as the lights' readings and paths have them. What an estimate blurs is
/// not in them. Errors: none; pixels outside, and all of a quick frame, read 0.
std::vector<LightReading> readings_at(const Frame& frame, const LightMix& mix, int x, int y);

/// The readings of all lights together.
LightReading sum_of(std::span<const LightReading> readings);

}  // namespace photile::view
