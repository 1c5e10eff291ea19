#include "view/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // BeginViewportSideBar

#include <algorithm>
#include <array>
#include <cfloat>

#include "image/glare.hpp"
#include "photile/limits.hpp"
#include "report/tables.hpp"

namespace photile::view {

namespace {

// Sizes in pixels.
constexpr float label_width = 75;  ///< right of inputs

template <class Value, std::size_t count>
bool draw_choice(const char* label, Value& value, const std::array<Value, count>& all) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, std::string(name_of(value)).c_str())) return false;
  for (const Value each : all) {
    if (ImGui::Selectable(std::string(name_of(each)).c_str(), each == value) && each != value) {
      value = each;
      changed = true;
    }
  }
  ImGui::EndCombo();
  return changed;
}

bool draw_maps(RenderParameters& parameters) {
  if (!ImGui::CollapsingHeader("Photon maps")) return false;
  bool changed = draw_choice("maps", parameters.maps, all_map_modes);
  changed |= draw_choice("area", parameters.area, all_area_modes);
  int neighbours = parameters.neighbours;
  if (ImGui::InputInt("k", &neighbours, 10, 50, ImGuiInputTextFlags_EnterReturnsTrue)) {
    parameters.neighbours = std::clamp(neighbours, 1, limits::max_neighbours);
    changed = true;
  }
  return changed;
}

std::string time_text(float milliseconds) {
  return milliseconds < 1000
             ? fmt::format("{:.1f} ms, {:.1f} frames a second", milliseconds, 1000 / milliseconds)
             : fmt::format("{:.1f} s", milliseconds / 1000);
}

/// Fills the space of a bar, so that the panel below does not move.
void leave_line() { ImGui::Dummy(ImVec2(0, ImGui::GetFrameHeight())); }

void draw_frame_times(const PanelReadings& readings) {
  const Frame* frame = readings.frame;
  if (frame) {
    ImGui::Text("%d x %d, %d samples, %.3gM paths", frame->layers.width, frame->layers.height,
                frame->samples_per_pixel, static_cast<double>(frame->emitted_photons) / 1e6);
  } else {
    ImGui::TextUnformatted("");
  }
  const std::vector<float> times(readings.frame_milliseconds.begin(),
                                 readings.frame_milliseconds.end());
  const std::string newest = times.empty() ? "" : time_text(times.back());
  ImGui::PlotLines("##times", times.data(), static_cast<int>(times.size()), 0, newest.c_str(), 0,
                   FLT_MAX, ImVec2(ImGui::GetContentRegionAvail().x, 50));
  if (frame && frame->samples_per_pixel < readings.most_samples) {
    const bool fills = !frame->mixed.empty();
    const double share = fills ? 1 - frame->lacking
                               : static_cast<double>(frame->samples_per_pixel) /
                                     static_cast<double>(readings.most_samples);
    ImGui::ProgressBar(static_cast<float>(share), ImVec2(-1, 0), fills ? "light" : "samples");
  } else {
    leave_line();
  }
  if (!readings.work.stage.empty()) {
    ImGui::ProgressBar(static_cast<float>(readings.work.share), ImVec2(-1, 0),
                       readings.work.stage.c_str());
  } else {
    leave_line();
  }
}

/// The light at the clicked point, and the list of all points.
void draw_probe(PanelState& state, const Frame* frame, PanelEvents& events) {
  draw_point_markers(state, frame);
  if (!state.probe || !frame) return;
  bool open = true;
  constexpr float width = 320;
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - width - border, border),
                          ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(width, 0), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Reading", &open)) {
    const LightMix mix = state.lights.shown_mix();
    const int x = static_cast<int>(state.probe->x * frame->layers.width);
    const int y = static_cast<int>(state.probe->y * frame->layers.height);
    const LightReading sum = sum_of(readings_at(*frame, mix, x, y));
    ImGui::Text("luminance   %s %s", text_of(sum.luminance).c_str(), luminance_unit(mix));
    if (ImGui::IsItemHovered()) {
      ImGui::SetTooltip("+- standard error of an estimate from the nearest photons");
    }
    draw_newest_point(state);
    draw_points(state, events);
  }
  ImGui::End();
  if (!open) state.probe.reset();
}

}  // namespace

std::string text_of(const Measured& measured) {
  return report::text_with_error(measured.value, measured.standard_error);
}

PanelEvents draw_panels(PanelState& state, const PanelReadings& readings) {
  PanelEvents events;
  if (ImGui::BeginViewportSideBar("photile", ImGui::GetMainViewport(), ImGuiDir_Left, panel_width,
                                  ImGuiWindowFlags_None)) {
    ImGui::PushItemWidth(-label_width);
    draw_frame_times(readings);
    ImGui::TextWrapped("%s", state.message.c_str());  // a line where there is none
    events.lights_changed |= draw_daylight(state);
    draw_luminaires(state, readings, events);
    events.lights_changed |= draw_lights(state);
    events.lights_changed |= draw_moods(state, events);
    draw_display(state, readings, events);
    events.maps_changed = draw_maps(state.parameters);
    if (ImGui::CollapsingHeader("Walking")) {
      auto speed = static_cast<float>(state.speed);
      if (ImGui::SliderFloat("m/s", &speed, 0.05f, 20, "%.2f", ImGuiSliderFlags_Logarithmic)) {
        state.speed = static_cast<double>(speed);
      }
      ImGui::TextWrapped(
          "W A S D walk, E and Q rise and sink, Shift hurries. Left button looks, right button "
          "orbits, wheel goes ahead. A click measures the light there. F2 hides the panels, F12 "
          "keeps a screenshot, Ctrl+S the picture with its layers. Ctrl+Z takes back what was set, "
          "Ctrl+Y sets it again. Left and Right move the hour, Page Up and Page Down the day. "
          "Luminaires: P places, R turns, Ctrl+D duplicates, Delete removes.");
    }
    ImGui::PopItemWidth();
  }
  ImGui::End();
  draw_probe(state, readings.frame, events);
  draw_legend(state, readings.frame);
  if (state.closing) draw_closing(state, events);
  return events;
}

namespace {

/// Pixels right of the slider, for its label and a button.
constexpr float room_for_stops = 95;

/// A patch of a legend, as high as a line.
void draw_colour(const std::array<std::uint8_t, 3>& rgb) {
  ImGui::ColorButton("##colour", ImVec4(rgb[0] / 255.0f, rgb[1] / 255.0f, rgb[2] / 255.0f, 1),
                     ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                     ImVec2(ImGui::GetFrameHeight(), ImGui::GetTextLineHeight()));
}

/// Contours and palette of false colour.
bool draw_false_colour(report::FalseColour& colours) {
  bool changed = false;
  constexpr std::array names{"filled", "lines", "bands", "steps"};
  int contours = static_cast<int>(colours.contours);
  if (ImGui::Combo("contours", &contours, names.data(), static_cast<int>(names.size()))) {
    colours.contours = static_cast<report::Contours>(contours);
    changed = true;
  }
  if (ImGui::BeginCombo("palette", colours.palette.c_str())) {
    for (const std::string& name : report::Palette::names()) {
      if (!ImGui::Selectable(name.c_str(), name == colours.palette)) continue;
      colours.palette = name;
      changed = true;
    }
    ImGui::EndCombo();
  }
  return changed;
}

/// The limit of glare, and the colour and the share of each light that exceeds it.
bool draw_glare(PanelState& state, const Frame* frame) {
  auto limit = static_cast<float>(state.display.glare_limit);
  bool changed = false;
  if (ImGui::InputFloat("limit", &limit, 0, 0, "%.4g", ImGuiInputTextFlags_EnterReturnsTrue) &&
      limit > 0) {
    state.display.glare_limit = static_cast<double>(limit);
    changed = true;
  }
  const char* unit = luminance_unit(state.lights.shown_mix());
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip("up to 100: times the mean luminance of the picture; above: %s", unit);
  }
  if (!frame || !frame->reflections) return changed;
  const image::Glare glare = image::find_glare(frame->layers, *frame->reflections,
                                               state.lights.shown_mix(), state.display.glare_limit);
  ImGui::Text("above %s %s", report::number_text(glare.limit, 4).c_str(), unit);
  for (std::size_t light = 0; light < glare.lights.size(); ++light) {
    const image::LightGlare& its = glare.lights[light];
    if (!(its.fraction > 0)) continue;
    draw_colour(image::mark_colour(static_cast<int>(light)));
    ImGui::SameLine();
    ImGui::TextWrapped("%s: %.2g%%, up to %s", its.light.c_str(), 100 * its.fraction,
                       report::number_text(its.peak, 4).c_str());
  }
  return changed;
}

void draw_photon_map(const PhotonMapView* map) {
  if (!map) {
    ImGui::TextWrapped("Click on a triangle to see its photons.");
    return;
  }
  ImGui::TextWrapped(
      "triangle %u, side %u: %zu photons (yellow); %zu triangles near (blue) with "
      "%zu photons in reach (cyan); %zu more share its map (green)",
      triangle_of(map->oriented_face), side_of(map->oriented_face), map->own_photons.size(),
      map->group.size(), map->group_photons.size(), map->patch.size());
}

}  // namespace

const char* luminance_unit(const LightMix& mix) {
  return mix.unit() == PowerUnit::lumen ? "cd/m2" : "W/(m2 sr)";
}

void draw_display(PanelState& state, const PanelReadings& readings, PanelEvents& events) {
  if (!ImGui::CollapsingHeader("Display", ImGuiTreeNodeFlags_DefaultOpen)) return;
  DisplaySettings& display = state.display;
  int mode = static_cast<int>(display.mode);
  events.display_changed |= ImGui::RadioButton("picture", &mode, 0);
  ImGui::SameLine();
  events.display_changed |= ImGui::RadioButton("illuminance", &mode, 1);
  ImGui::SameLine();
  events.display_changed |= ImGui::RadioButton("glare", &mode, 2);
  display.mode = static_cast<DisplayMode>(mode);
  events.display_changed |= ImGui::Checkbox("photon map of a triangle", &display.photon_map);
  if (display.photon_map) draw_photon_map(readings.photon_map);
  if (display.mode != DisplayMode::illuminance) {
    auto exposure = static_cast<float>(display.exposure);
    ImGui::SetNextItemWidth(-room_for_stops);
    if (ImGui::SliderFloat("stops", &exposure, -8, 8, "%+.1f")) {
      display.exposure = static_cast<double>(exposure);
      events.display_changed = true;
    }
    ImGui::SameLine();
    events.expose = ImGui::SmallButton("auto");
    if (display.mode == DisplayMode::glare) {
      events.display_changed |= draw_glare(state, readings.frame);
    }
    return;
  }
  auto top = static_cast<float>(display.false_colour.scale);
  if (ImGui::InputFloat("top, lux", &top, 0, 0, "%.4g") && top >= 0) {
    display.false_colour.scale = static_cast<double>(top);
    events.display_changed = true;
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("0: 98%% of the values lie below");
  events.display_changed |= draw_false_colour(display.false_colour);
}

void draw_legend(const PanelState& state, const Frame* frame) {
  const DisplaySettings& display = state.display;
  if (!frame || display.mode != DisplayMode::illuminance) return;
  double automatic = 0;
  if (!(display.false_colour.scale > 0)) {
    automatic = report::automatic_top(mixed_illuminance(frame->layers, state.lights.shown_mix()));
  }
  const report::ColourScale scale(display.false_colour, automatic);
  std::vector<double> levels = scale.levels();
  std::reverse(levels.begin(), levels.end());
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x - border, size.y - border), ImGuiCond_Always, ImVec2(1, 1));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 0));
  ImGui::Begin("legend", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::TextUnformatted(display.false_colour.label.c_str());
  for (const double level : levels) {
    draw_colour(scale.rgb(level));
    ImGui::SameLine();
    ImGui::TextUnformatted(report::number_text(level, 4).c_str());
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace photile::view
