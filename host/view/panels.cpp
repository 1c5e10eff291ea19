#include "view/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <functional>

#include "photile/errors.hpp"
#include "photile/limits.hpp"

namespace photile::view {
namespace {

const char* word_of(PowerUnit unit) { return unit == PowerUnit::lumen ? "lm" : "W"; }

void tell(std::string& message, const std::function<void()>& action) {
  try {
    action();
    message.clear();
  } catch (const Error& error) {
    message = error.what();
  }
}

/// One row per light: on, solo, power, colour.
bool draw_light(LightControl& control) {
  bool changed = false;
  ImGui::PushID(control.name.c_str());
  changed |= ImGui::Checkbox("##on", &control.on);
  ImGui::SameLine();
  changed |= ImGui::Checkbox("solo", &control.solo);
  ImGui::SameLine();
  glm::vec3 color = control.color.value_or(glm::vec3(1));
  if (ImGui::ColorEdit3("##color", &color.x, ImGuiColorEditFlags_NoInputs)) {
    control.color = color;
    changed = true;
  }
  if (control.color) {
    ImGui::SameLine();
    if (ImGui::SmallButton("own")) {
      control.color.reset();
      changed = true;
    }
  }
  ImGui::SameLine();
  ImGui::TextUnformatted(control.name.c_str());
  if (!control.members.empty() && ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%zu lights", control.members.size());
  }
  // Of a lamp that is off in the scene, the slider still has to reach somewhere.
  const double most = control.scene_power > 0 ? 4 * control.scene_power : 1000;
  const double least = 0;
  const std::string format = fmt::format("%.4g {}", word_of(control.unit));
  ImGui::SetNextItemWidth(-1);
  changed |= ImGui::SliderScalar("##power", ImGuiDataType_Double, &control.power, &least, &most,
                                 format.c_str(), ImGuiSliderFlags_AlwaysClamp);
  ImGui::PopID();
  return changed;
}

bool draw_lights(PanelState& state) {
  bool changed = false;
  if (!ImGui::CollapsingHeader("Lights", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  ImGui::BeginChild(
      "lights",
      ImVec2(0, std::min(300.0f, 50.0f * static_cast<float>(state.lights.controls().size()))));
  for (LightControl& control : state.lights.controls()) changed |= draw_light(control);
  ImGui::EndChild();
  if (ImGui::Button("As in the scene")) {
    state.lights.reset();
    changed = true;
  }
  for (const std::string& name : state.lights.refused()) {
    ImGui::TextWrapped("%s cannot have that colour: it emits none of one of its primaries",
                       name.c_str());
  }
  return changed;
}

bool draw_moods(PanelState& state) {
  bool changed = false;
  if (!ImGui::CollapsingHeader("Moods", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  for (const std::string& name : state.moods.names()) {
    ImGui::PushID(name.c_str());
    if (ImGui::Button(name.c_str())) {
      tell(state.message, [&] { state.moods.apply(name, state.lights); });
      changed = true;
    }
    ImGui::SameLine();
    const bool removed = ImGui::SmallButton("remove");
    ImGui::PopID();
    if (removed) tell(state.message, [&] { state.moods.remove(name); });
  }
  std::string& name = state.new_mood;
  ImGui::SetNextItemWidth(-60);
  const bool entered = ImGui::InputText("##mood", &name, ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  if ((ImGui::Button("keep") || entered) && !name.empty()) {
    tell(state.message, [&] { state.moods.keep(name, state.lights); });
    name.clear();
  }
  return changed;
}

void draw_legend(const Frame* frame, PanelState& state) {
  if (!frame) return;
  double largest = 0;
  if (!(state.display.false_colour.scale > 0)) {
    const std::vector<float> values = mixed_illuminance(frame->layers, state.lights.mix());
    for (const float value : values) largest = std::max(largest, static_cast<double>(value));
  }
  const measuring::ColourScale scale(state.display.false_colour, largest);
  std::vector<double> levels = scale.levels();
  std::reverse(levels.begin(), levels.end());
  for (const double level : levels) {
    const auto rgb = scale.rgb(level);
    const ImVec4 color(rgb[0] / 255.0f, rgb[1] / 255.0f, rgb[2] / 255.0f, 1);
    ImGui::ColorButton("##legend", color,
                       ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop);
    ImGui::SameLine();
    ImGui::Text("%.4g %s", level, state.display.false_colour.label.c_str());
  }
}

void draw_display(PanelState& state, const Frame* frame, PanelEvents& events) {
  if (!ImGui::CollapsingHeader("Display", ImGuiTreeNodeFlags_DefaultOpen)) return;
  DisplaySettings& display = state.display;
  int mode = static_cast<int>(display.mode);
  events.display_changed |= ImGui::RadioButton("picture", &mode, 0);
  ImGui::SameLine();
  events.display_changed |= ImGui::RadioButton("illuminance", &mode, 1);
  display.mode = static_cast<DisplayMode>(mode);
  if (display.mode == DisplayMode::picture) {
    auto exposure = static_cast<float>(display.exposure);
    if (ImGui::SliderFloat("stops", &exposure, -15, 15)) {
      display.exposure = static_cast<double>(exposure);
      events.display_changed = true;
    }
    ImGui::SameLine();
    events.expose = ImGui::SmallButton("auto");
    return;
  }
  auto top = static_cast<float>(display.false_colour.scale);
  if (ImGui::InputFloat("top, lux (0: largest)", &top, 0, 0, "%.0f") && top >= 0) {
    display.false_colour.scale = static_cast<double>(top);
    events.display_changed = true;
  }
  draw_legend(frame, state);
}

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
  changed |= draw_choice("structure", parameters.structure, all_map_structures);
  changed |= draw_choice("area", parameters.area, all_area_modes);
  int neighbours = parameters.neighbours;
  if (ImGui::InputInt("k", &neighbours, 10, 50, ImGuiInputTextFlags_EnterReturnsTrue)) {
    parameters.neighbours = std::clamp(neighbours, 1, limits::max_neighbours);
    changed = true;
  }
  return changed;
}

void draw_frame_times(const PanelReadings& readings) {
  const Frame* frame = readings.frame;
  if (frame) {
    ImGui::Text("%d x %d, %d samples, %.3gM paths", frame->layers.width, frame->layers.height,
                frame->samples_per_pixel, static_cast<double>(frame->emitted_photons) / 1e6);
  }
  const std::vector<float> times(readings.frame_milliseconds.begin(),
                                 readings.frame_milliseconds.end());
  const std::string newest = times.empty() ? "" : fmt::format("{:.1f} ms", times.back());
  ImGui::PlotLines("##times", times.data(), static_cast<int>(times.size()), 0, newest.c_str(), 0,
                   FLT_MAX, ImVec2(ImGui::GetContentRegionAvail().x, 50));
  if (!readings.work.stage.empty()) {
    ImGui::ProgressBar(static_cast<float>(readings.work.share), ImVec2(-1, 0),
                       readings.work.stage.c_str());
  }
}

/// What reaches the clicked place, in all and by each light.
void draw_probe(PanelState& state, const Frame* frame) {
  if (!state.probe || !frame) return;
  bool open = true;
  ImGui::SetNextWindowPos(ImVec2(ImGui::GetIO().DisplaySize.x - 330, 10), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(320, 0), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Reading", &open)) {
    const LightMix mix = state.lights.mix();
    const int x = static_cast<int>(state.probe->x * frame->layers.width);
    const int y = static_cast<int>(state.probe->y * frame->layers.height);
    const auto readings = readings_at(*frame, mix, x, y);
    LightReading sum;
    for (const LightReading& reading : readings) {
      sum.illuminance += reading.illuminance;
      sum.luminance += reading.luminance;
    }
    const bool photometric = mix.lights.empty() || mix.lights[0].unit == PowerUnit::lumen;
    ImGui::Text("illuminance  %.4g %s", sum.illuminance, photometric ? "lx" : "W/m2");
    ImGui::Text("luminance    %.4g %s", sum.luminance, photometric ? "cd/m2" : "W/(m2 sr)");
    ImGui::Separator();
    for (std::size_t light = 0; light < readings.size(); ++light) {
      if (readings[light].illuminance == 0 && readings[light].luminance == 0) continue;
      ImGui::Text("%s: %.4g %s (%.0f%%)", mix.lights[light].name.c_str(),
                  readings[light].illuminance, photometric ? "lx" : "W/m2",
                  100 * readings[light].illuminance / std::max(sum.illuminance, 1e-300));
    }
  }
  ImGui::End();
  if (!open) state.probe.reset();
}

}  // namespace

PanelEvents draw_panels(PanelState& state, const PanelReadings& readings) {
  PanelEvents events;
  ImGui::SetNextWindowPos(ImVec2(10, 10), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(300, 0), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("photile")) {
    draw_frame_times(readings);
    if (!state.message.empty()) ImGui::TextWrapped("%s", state.message.c_str());
    events.lights_changed |= draw_lights(state);
    events.lights_changed |= draw_moods(state);
    draw_display(state, readings.frame, events);
    events.maps_changed = draw_maps(state.parameters);
    if (ImGui::CollapsingHeader("Walking")) {
      auto speed = static_cast<float>(state.speed);
      if (ImGui::SliderFloat("m/s", &speed, 0.05f, 20, "%.2f", ImGuiSliderFlags_Logarithmic)) {
        state.speed = static_cast<double>(speed);
      }
      ImGui::TextWrapped(
          "W A S D walk, E and Q rise and sink, Shift hurries. Left button looks, right button "
          "orbits, wheel goes ahead. A click reads the light there. F2 hides the panels, F12 keeps "
          "a screenshot, Ctrl+S the picture with its layers.");
    }
  }
  ImGui::End();
  draw_probe(state, readings.frame);
  return events;
}

}  // namespace photile::view
