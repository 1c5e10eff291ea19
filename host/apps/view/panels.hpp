// The panels over the picture.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "view/display.hpp"
#include "view/light_board.hpp"
#include "view/luminaire_session.hpp"
#include "view/moods.hpp"
#include "view/photon_map_view.hpp"
#include "view/photon_worker.hpp"
#include "view/point_worker.hpp"

namespace photile::view {

/// What a click on the picture asked for.
struct Probe {
  double x = 0, y = 0;  ///< in the picture, as shares of its width and height
};

/// What values at clicked points are multiplied by and held against.
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
  LuminaireTool* luminaires = nullptr;  ///< null where no file of them is edited
  bool closing = false;  ///< the window is asked to close, and there are unsaved changes
};

/// What they show alone.
struct PanelReadings {
  const Frame* frame = nullptr;
  WorkProgress work;
  int most_samples = 1;                         ///< of a finished frame, per pixel
  const std::deque<float>& frame_milliseconds;  ///< newest last
  const PhotonMapView* photon_map = nullptr;    ///< that is shown
  bool loading = false;                         ///< the scene, with other luminaires
};

/// What was asked for by them in this frame.
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

}  // namespace photile::view
