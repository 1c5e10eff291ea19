// Day and hour of the sky.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "view/panel_parts.hpp"

namespace photile::view {

bool draw_daylight(PanelState& state) {
  const MovingSky* const sky = state.lights.sky();
  if (!sky || !ImGui::CollapsingHeader("Daylight", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  LightBoard::Daylight& daylight = state.lights.daylight();
  bool changed = ImGui::Checkbox("##sky", &daylight.on);
  ImGui::SameLine();
  ImGui::TextUnformatted(text_of(daylight.moment).c_str());
  ImGui::SameLine();
  ImGui::Checkbox("adapt", &state.display.adapts);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the exposure follows the hour");
  constexpr double first = 0, last = 24 - 1.0 / 60;
  double hour = daylight.moment.hour;
  if (ImGui::SliderScalar("hour", ImGuiDataType_Double, &hour, &first, &last, "%.2f",
                          ImGuiSliderFlags_AlwaysClamp)) {
    daylight.moment.hour = hour;
    changed = true;
  }
  int day = daylight.moment.day;
  if (ImGui::SliderInt("day", &day, 1, 365, "%d", ImGuiSliderFlags_AlwaysClamp)) {
    daylight.moment.day = day;
    changed = true;
  }
  ImGui::TextWrapped("%s", sky->text(daylight.moment).c_str());
  return changed;
}

bool take_sky_keys(SkyMoment& moment) {
  const auto pressed = [](int later, int earlier) {
    return static_cast<int>(ImGui::IsKeyPressed(later, true)) -
           static_cast<int>(ImGui::IsKeyPressed(earlier, true));
  };
  const bool shift = ImGui::GetIO().KeyShift;
  const int steps = pressed(GLFW_KEY_RIGHT, GLFW_KEY_LEFT);
  const int days = pressed(GLFW_KEY_PAGE_DOWN, GLFW_KEY_PAGE_UP);
  moment.add_hours(steps * (shift ? 1 : 0.25));
  moment.add_days(days * (shift ? 30 : 1));
  return steps != 0 || days != 0;
}

}  // namespace photile::view
