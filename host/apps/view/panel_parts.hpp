// The parts of the panel: lamps, and what the window shows.
#pragma once

#include "view/panels.hpp"

namespace photile::view {

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

/// Of the picture: "cd/m2", or "W/(m2 sr)" where lamps are in watts.
const char* luminance_unit(const LightMix& mix);

}  // namespace photile::view
