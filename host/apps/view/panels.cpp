#include "view/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cfloat>

#include "photile/limits.hpp"
#include "report/tables.hpp"
#include "view/panel_parts.hpp"

namespace photile::view {
namespace {

// Sizes in pixels.
constexpr float panel_width = 300;
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
  return milliseconds < 1000 ? fmt::format("{:.1f} ms", milliseconds)
                             : fmt::format("{:.1f} s", milliseconds / 1000);
}

void draw_frame_times(const PanelReadings& readings) {
  const Frame* frame = readings.frame;
  if (frame) {
    ImGui::Text("%d x %d, %d samples, %.3gM paths", frame->layers.width, frame->layers.height,
                frame->samples_per_pixel, static_cast<double>(frame->emitted_photons) / 1e6);
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
  }
  if (!readings.work.stage.empty()) {
    ImGui::ProgressBar(static_cast<float>(readings.work.share), ImVec2(-1, 0),
                       readings.work.stage.c_str());
  }
}

/// What reaches the clicked place, and the list of all.
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
  ImGui::SetNextWindowPos(ImVec2(border, border), ImGuiCond_FirstUseEver);
  // As high as what it shows, and scrolled where the window is not.
  const float most = std::max(panel_width, ImGui::GetIO().DisplaySize.y - 2 * border);
  ImGui::SetNextWindowSizeConstraints(ImVec2(panel_width, 0), ImVec2(panel_width, most));
  if (ImGui::Begin("photile", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::PushItemWidth(-label_width);
    draw_frame_times(readings);
    if (!state.message.empty()) ImGui::TextWrapped("%s", state.message.c_str());
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

}  // namespace photile::view
