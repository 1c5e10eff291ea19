// The walkthrough: a window in which a scene is walked through and its lamps are set.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "image/white.hpp"
#include "loading/luminaires.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/renderer.hpp"
#include "view/photon_worker.hpp"
#include "view/year_worker.hpp"

namespace photile::view {

/// What the window shows.
struct Redraw {
  const Frame* frame = nullptr;  ///< null before the first
  bool new_frame = false;        ///< seen for the first time
  bool moving = false;           ///< the viewer
};

struct ViewerParameters {
  RenderParameters render;  ///< film: size of the window and most samples, standing still
  double frames_per_second = defaults::view_frames_per_second;  ///< aimed at while moving
  std::filesystem::path outputs = ".";  ///< folder of screenshots and pictures
  std::filesystem::path moods = {};     ///< file of moods; "" = beside the scene
  std::uint64_t light_map_bytes = 0;    ///< that nodes may take; 0 = no bound
  /// Photons of an earlier run in place of all tracing, or none.
  std::optional<TracedPhotons> prepared;
  SceneLoadOptions load;   ///< with which the scene was loaded, for copies of its file
  SkySituation situation;  ///< of a sky of patches; without a place nothing moves it
  /// Makes the mix of a scene that was loaded again, as `mix` was made of the first.
  std::function<LightMix(const Scene&)> mix_of;
  std::filesystem::path luminaire_file;               ///< that is edited; "" = none
  std::vector<loading::PlacedLuminaires> luminaires;  ///< as the scene has its entries
  DisplayView view = ToneMapping{}.view;
  bool fills_screen = false;          ///< the window opens at most of it, whatever the film's size
  std::optional<image::White> white;  ///< none = that of the lamps in the first picture
  bool white_balance = true;          ///< whether it is shown as white
  Progress* notes = &Progress::none();  ///< gets the lines that the window does not show
  KeepPhotons keep;                     ///< is given all photons once they are there; may be empty
  /// Is given the light maps of all photons at the end, where there are any; may be empty.
  std::function<void(const LightMapContents&)> keep_light_maps;
  YearWorker::Measure measure_year;  ///< of daylight, when it is asked for; may be empty
  /// Told after each redraw; may be empty.
  std::function<void(const Redraw&)> redrawn;
  /// Asked before each redraw: true ends the walkthrough.
  std::function<bool()> interrupted = [] { return false; };
};

/// Opens the window and returns when it is closed.
///   camera         in the scene's coordinates
///   open_devices   called for each set of maps, so that one is built while another is in use
/// Errors: DeviceError without a display; those of SceneRenderer where there is nothing to show
/// yet (later ones are shown in the window); InputError for a damaged file of moods.
void run_viewer(const Scene& scene, const Camera& camera, const LightMix& mix,
                PhotonWorker::OpenDevices open_devices, ViewerParameters parameters);

}  // namespace photile::view
