// What a click has read, and the list of all clicked points.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "measuring/requirements.hpp"
#include "photile/errors.hpp"
#include "report/tables.hpp"
#include "view/panels.hpp"
#include "view/picture_area.hpp"

namespace photile::view {
namespace {

constexpr float marker_radius = 5;  // pixels
constexpr float line_gap = 2;

/// "250 +-3 lx", and whether the target is met there.
std::string lux_text(const ClickedPoint& point, const PointSettings& settings,
                     const LightMix& mix) {
  if (!point.read()) return "measuring ...";
  const Measured lux = point.lux(mix, settings.maintenance).back();
  std::string text = text_of(lux) + " lx";
  if (settings.target > 0) {
    text += lux.value >= settings.target ? ", met" : fmt::format(", below {:g}", settings.target);
  }
  return text;
}

void draw_settings(PointSettings& settings) {
  auto factor = static_cast<float>(settings.maintenance);
  if (ImGui::InputFloat("maintenance", &factor, 0, 0, "%.2f") && factor > 0 && factor <= 1) {
    settings.maintenance = static_cast<double>(factor);
  }
  if (ImGui::BeginCombo("target", settings.target_name.c_str())) {
    const auto choose = [&](const std::string& name, double mean) {
      if (!ImGui::Selectable(name.c_str(), name == settings.target_name)) return;
      settings.target_name = name;
      settings.target = mean;
    };
    choose("none", 0);
    for (const measuring::Requirement& row : measuring::known_requirements()) {
      choose(row.name, row.mean);
    }
    ImGui::EndCombo();
  }
}

}  // namespace

void draw_point_markers(const PanelState& state, const Frame* frame) {
  if (!frame) return;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const PictureArea area = PictureArea::now();
  for (const ClickedPoint& point : state.points) {
    const auto middle = area.shown(frame->camera, position_in_scene(state.scene, point.position));
    if (!middle) continue;
    list->AddCircle(*middle, marker_radius, IM_COL32(0, 0, 0, 255), 0, 3);
    list->AddCircle(*middle, marker_radius, IM_COL32(255, 255, 255, 255), 0, 1.5f);
    list->AddText(ImVec2(middle->x + marker_radius + line_gap, middle->y - marker_radius),
                  IM_COL32(255, 255, 255, 255), std::to_string(point.number).c_str());
  }
}

void draw_points(PanelState& state, PanelEvents& events) {
  if (state.points.empty() || !ImGui::CollapsingHeader("Points")) return;
  const LightMix mix = state.lights.mix();
  draw_settings(state.point_settings);
  for (const ClickedPoint& point : state.points) {
    ImGui::PushID(point.number);
    if (ImGui::SmallButton("x")) events.removed_point = point.number;
    ImGui::SameLine();
    ImGui::TextWrapped("%d: %s at %.3f, %.3f, %.3f", point.number,
                       lux_text(point, state.point_settings, mix).c_str(), point.position.x,
                       point.position.y, point.position.z);
    ImGui::PopID();
  }
  events.keep_points = ImGui::SmallButton("keep as .pts and .csv");
}

void draw_newest_point(PanelState& state) {
  if (state.points.empty()) return;
  const LightMix mix = state.lights.mix();
  const ClickedPoint& point = state.points.back();
  ImGui::Text("illuminance %s", lux_text(point, state.point_settings, mix).c_str());
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip(
        "+- standard error, by rays from a sensor there; times the maintenance factor");
  }
  ImGui::Text("at %.3f, %.3f, %.3f m", point.position.x, point.position.y, point.position.z);
  if (!point.read()) return;
  ImGui::Separator();
  const LayerMixdown layers = state.lights.mixdown();
  const std::vector<Measured> lux = point.lux(mix, state.point_settings.maintenance, &layers);
  for (std::size_t light = 0; light + 1 < lux.size(); ++light) {
    if (lux[light].value == 0) continue;
    // Names last: they may be long.
    ImGui::TextWrapped("%12s lx %4.0f%%  %s", text_of(lux[light]).c_str(),
                       100 * lux[light].value / std::max(lux.back().value, 1e-300),
                       layers.layers[light].c_str());
  }
}

}  // namespace photile::view
