#include "view/panels.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <functional>

#include "image/glare.hpp"
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

/// The temperature of a light's colour, dragged; "own" while it has none.
bool draw_temperature(LightControl& control) {
  constexpr float kelvin_per_pixel = 20;
  constexpr float white = 6500;  // where a light without one begins
  const bool set = control.kelvin > 0;
  auto kelvin = set ? static_cast<float>(control.kelvin) : white;
  if (!ImGui::DragFloat("##kelvin", &kelvin, kelvin_per_pixel,
                        static_cast<float>(limits::min_color_temperature),
                        static_cast<float>(limits::max_color_temperature), set ? "%.0f K" : "K",
                        ImGuiSliderFlags_AlwaysClamp)) {
    return false;
  }
  control.kelvin = std::round(static_cast<double>(kelvin));
  control.color.reset();
  return true;
}

/// Two rows per light: on, solo, colour, name; power and temperature.
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
    control.kelvin = 0;
    changed = true;
  }
  if (control.tinted()) {
    ImGui::SameLine();
    if (ImGui::SmallButton("own")) {
      control.color.reset();
      control.kelvin = 0;
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
  constexpr float temperature_width = 70;
  ImGui::SetNextItemWidth(-temperature_width - ImGui::GetStyle().ItemSpacing.x);
  changed |= ImGui::SliderScalar("##power", ImGuiDataType_Double, &control.power, &least, &most,
                                 format.c_str(), ImGuiSliderFlags_AlwaysClamp);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  changed |= draw_temperature(control);
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

bool draw_moods(PanelState& state, PanelEvents& events) {
  bool changed = false;
  if (!ImGui::CollapsingHeader("Moods", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  for (const std::string& name : state.moods.names()) {
    ImGui::PushID(name.c_str());
    if (ImGui::Button(name.c_str())) {
      tell(state.message, [&] { state.moods.apply(name, state.lights); });
      changed = true;
    }
    ImGui::SameLine();
    if (ImGui::SmallButton("to scene")) events.mood_to_scene = name;
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

/// Contours and palette of false colour.
bool draw_false_colour(measuring::FalseColour& colours) {
  bool changed = false;
  constexpr std::array names{"filled", "lines", "bands", "steps"};
  int contours = static_cast<int>(colours.contours);
  if (ImGui::Combo("contours", &contours, names.data(), static_cast<int>(names.size()))) {
    colours.contours = static_cast<measuring::Contours>(contours);
    changed = true;
  }
  if (ImGui::BeginCombo("palette", colours.palette.c_str())) {
    for (const std::string& name : image::Palette::names()) {
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
  if (ImGui::InputFloat("limit (to 100: x mean)", &limit, 0, 0, "%.4g",
                        ImGuiInputTextFlags_EnterReturnsTrue) &&
      limit > 0) {
    state.display.glare_limit = static_cast<double>(limit);
    changed = true;
  }
  if (!frame || !frame->reflections) return changed;
  const image::Glare glare = image::find_glare(frame->layers, *frame->reflections,
                                               state.lights.mix(), state.display.glare_limit);
  ImGui::Text("above %.4g", glare.limit);
  for (std::size_t light = 0; light < glare.lights.size(); ++light) {
    const image::LightGlare& its = glare.lights[light];
    if (!(its.share > 0)) continue;
    const auto rgb = image::mark_colour(static_cast<int>(light));
    ImGui::ColorButton("##mark", ImVec4(rgb[0] / 255.0f, rgb[1] / 255.0f, rgb[2] / 255.0f, 1),
                       ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop);
    ImGui::SameLine();
    ImGui::Text("%s: %.2g%%, up to %.4g", its.light.c_str(), 100 * its.share, its.peak);
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
      triangle_of(map->sided_triangle), side_of(map->sided_triangle), map->own_photons.size(),
      map->group.size(), map->group_photons.size(), map->patch.size());
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
    if (ImGui::SliderFloat("stops", &exposure, -15, 15)) {
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
  if (ImGui::InputFloat("top, lux (0: largest)", &top, 0, 0, "%.0f") && top >= 0) {
    display.false_colour.scale = static_cast<double>(top);
    events.display_changed = true;
  }
  events.display_changed |= draw_false_colour(display.false_colour);
  draw_legend(readings.frame, state);
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
          "orbits, wheel goes ahead. A click reads the light there. F2 hides the panels, F12 keeps "
          "a screenshot, Ctrl+S the picture with its layers.");
    }
  }
  ImGui::End();
  draw_probe(state, readings.frame);
  return events;
}

}  // namespace photile::view
