#include "view/light_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "photile/limits.hpp"

namespace photile::view {
namespace {

const char* word_of(PowerUnit unit) { return unit == PowerUnit::lumen ? "lm" : "W"; }

/// The temperature of a light's colour, dragged; "K" while it has none of its own.
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

}  // namespace

bool draw_lights(LightBoard& board) {
  bool changed = false;
  if (!ImGui::CollapsingHeader("Lights", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  ImGui::BeginChild(
      "lights", ImVec2(0, std::min(300.0f, 50.0f * static_cast<float>(board.controls().size()))));
  for (LightControl& control : board.controls()) changed |= draw_light(control);
  ImGui::EndChild();
  if (ImGui::Button("As in the scene")) {
    board.reset();
    changed = true;
  }
  for (const std::string& name : board.refused()) {
    ImGui::TextWrapped("%s cannot have that colour: it emits none of one of its primaries",
                       name.c_str());
  }
  return changed;
}

}  // namespace photile::view
