// The panels over the picture and their parts.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "view/frame.hpp"
#include "view/light_board.hpp"
#include "view/luminaire_session.hpp"
#include "view/moods.hpp"
#include "view/photon_map.hpp"
#include "view/photon_worker.hpp"
#include "view/point_worker.hpp"
#include "view/year_worker.hpp"

namespace photile::view {

/// Of the panel that is docked beside the picture, in the units of the screen.
inline constexpr int panel_width = 300;

/// The request of a click on the picture.
struct Probe {
  double x = 0, y = 0;  ///< in the picture, as shares of its width and height
};

/// The factor on values at clicked points, and the value that they are compared with.
struct PointSettings {
  double maintenance = defaults::maintenance_factor;
  std::string target_name = "none";
  double target = 0;  ///< lux; 0 = none
};

/// What the panels show and set.
struct PanelState {
  LightBoard& lights;
  Moods& moods;
  DisplaySettings& display;
  RenderParameters& parameters;
  double& speed;  ///< of walking, metres per second
  std::optional<Probe>& probe;
  std::string& message;                     ///< the last error or news; "" = none
  std::string& new_mood;                    ///< the name being typed
  const std::vector<ClickedPoint>& points;  ///< the newest last
  PointSettings& point_settings;
  const Scene& scene;
  YearWorker& year;
  LuminaireTool* luminaires = nullptr;  ///< null where no file of them is edited
  bool closing = false;  ///< the window is asked to close, and there are unsaved changes
};

/// What they only show.
struct PanelReadings {
  const Frame* frame = nullptr;
  WorkProgress work;
  int most_samples = 1;                         ///< of a finished frame, per pixel
  const std::deque<float>& frame_milliseconds;  ///< newest last
  const PhotonMapView* photon_map = nullptr;    ///< that is shown
  bool loading = false;                         ///< the scene, with other luminaires
};

/// What was requested by them in this frame.
struct PanelEvents {
  bool lights_changed = false;   ///< mix again
  bool display_changed = false;  ///< colour again
  bool maps_changed = false;     ///< trace and build again, with other parameters
  bool expose = false;           ///< set the exposure by the picture
  int removed_point = 0;         ///< its number; 0 = none
  bool keep_points = false;      ///< write the list of points
  bool save_luminaires = false;  ///< write their file
  Closing closing = Closing::undecided;
  std::string mood_to_scene;  ///< write this one into a copy of the scene; "" = none
};

PanelEvents draw_panels(PanelState& state, const PanelReadings& readings);

/// A control for each light, or group of lights. Returns whether one has changed.
bool draw_lights(PanelState& state);

/// Day and hour of a sky that they move. Returns whether it is another sky now.
bool draw_daylight(PanelState& state);

/// Moves it by Left and Right, a quarter of an hour, and by Page Up and Page Down, a day; with
/// Shift by an hour and by thirty days. Returns whether it moved.
bool take_sky_keys(SkyMoment& moment);

/// The moods that are kept. Returns whether one has been applied.
bool draw_moods(PanelState& state, PanelEvents& events);

/// Pixels between panels and the window's border.
constexpr float border = 10;

/// "250 +-3".
std::string text_of(const Measured& measured);

/// What the newest clicked point reads, in all and by each light.
void draw_newest_point(PanelState& state);

/// The list of clicked points with their settings.
void draw_points(PanelState& state, PanelEvents& events);

/// The list of luminaires and the selected one, where a file of them is edited.
void draw_luminaires(PanelState& state, const PanelReadings& readings, PanelEvents& events);

/// Asks what becomes of changes that are not saved, over all else.
void draw_closing(PanelState& state, PanelEvents& events);

/// Rings with their numbers where the points are, over the picture.
void draw_point_markers(const PanelState& state, const Frame* frame);

void draw_display(PanelState& state, const PanelReadings& readings, PanelEvents& events);

/// The legend of illuminances, in the corner of the window, where they are shown.
void draw_legend(const PanelState& state, const Frame* frame);

/// The unit of the picture: "cd/m2", or "W/(m2 sr)" where lamps are in watts.
const char* luminance_unit(const LightMix& mix);

}  // namespace photile::view
