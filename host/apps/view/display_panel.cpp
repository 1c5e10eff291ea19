#include <imgui.h>

#include <algorithm>
#include <array>

#include "image/glare.hpp"
#include "report/tables.hpp"
#include "view/panel_parts.hpp"

namespace photile::view {
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
    if (!(its.share > 0)) continue;
    draw_colour(image::mark_colour(static_cast<int>(light)));
    ImGui::SameLine();
    ImGui::TextWrapped("%s: %.2g%%, up to %s", its.light.c_str(), 100 * its.share,
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
      triangle_of(map->sided_triangle), side_of(map->sided_triangle), map->own_photons.size(),
      map->group.size(), map->group_photons.size(), map->patch.size());
}

}  // namespace

const char* luminance_unit(const LightMix& mix) {
  const bool photometric = mix.lights.empty() || mix.lights[0].unit == PowerUnit::lumen;
  return photometric ? "cd/m2" : "W/(m2 sr)";
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
    if (ImGui::SliderFloat("stops", &exposure, -15, 15, "%.1f")) {
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
