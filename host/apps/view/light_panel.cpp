#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "report/tables.hpp"
#include "view/panels.hpp"

namespace photile::view {

namespace {

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
                        static_cast<float>(limits::max_color_temperature),
                        set ? "%.0f K" : "kelvin", ImGuiSliderFlags_AlwaysClamp)) {
    return false;
  }
  control.kelvin = std::round(static_cast<double>(kelvin));
  control.color.reset();
  return true;
}

/// The name, cut between two characters and ended by dots where it is wider than `width` pixels.
std::string fitting(const std::string& name, float width) {
  if (ImGui::CalcTextSize(name.c_str()).x <= width) return name;
  std::string cut = name;
  const auto is_wide = [&] { return ImGui::CalcTextSize((cut + "...").c_str()).x > width; };
  const auto within_character = [&] {
    return (static_cast<unsigned char>(name[cut.size()]) & 0xC0u) == 0x80u;  // of UTF-8
  };
  while (!cut.empty() && (is_wide() || within_character())) cut.pop_back();
  return cut + "...";
}

/// The whole name, which may be longer than the panel is wide.
void tell_light(const LightControl& control) {
  if (control.members.empty()) {
    ImGui::SetTooltip("%s", control.name.c_str());
  } else {
    ImGui::SetTooltip("%s: %zu lights", control.name.c_str(), control.members.size());
  }
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
  ImGui::TextUnformatted(fitting(control.name, ImGui::GetContentRegionAvail().x).c_str());
  if (ImGui::IsItemHovered()) tell_light(control);
  // The slider of a lamp that is off in the scene still has to reach somewhere.
  const double most = control.scene_power > 0 ? 4 * control.scene_power : 1000;
  const double least = 0;
  const std::string format = report::grouped(control.power, 4) + " " + symbol_of(control.unit);
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

bool draw_lights(PanelState& state) {
  bool changed = false;
  if (!ImGui::CollapsingHeader("Lights", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  const float rows = 2 * static_cast<float>(state.lights.controls().size());
  const float height = rows * ImGui::GetFrameHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
  // The fraction that the rest of the panel leaves of a window of 600 pixels.
  constexpr float most = 0.35f;
  ImGui::BeginChild("lights", ImVec2(0, std::min(height, most * ImGui::GetIO().DisplaySize.y)));
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
  constexpr float widest_mood = 140;
  bool changed = false;
  if (!ImGui::CollapsingHeader("Moods", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  for (const std::string& name : state.moods.names()) {
    ImGui::PushID(name.c_str());
    // Room is left for the other buttons.
    const ImVec2 padding = ImGui::GetStyle().FramePadding;
    const float width = ImGui::CalcTextSize(name.c_str()).x + 2 * padding.x;
    const std::string shown = fitting(name, widest_mood - 2 * padding.x);
    if (ImGui::Button(shown.c_str(), ImVec2(std::min(width, widest_mood), 0))) {
      tell(state.message, [&] { state.moods.apply(name, state.lights); });
      changed = true;
    }
    if (width > widest_mood && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", name.c_str());
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

// Day and hour of the sky.

namespace {

/// What a year of it gives, while that is refined.
void draw_year(YearWorker& year) {
  if (ImGui::SmallButton("the year")) year.start();
  if (ImGui::IsItemHovered()) {
    ImGui::SetTooltip(
        "daylight autonomy of the first camera's room, by rays, with standard errors");
  }
  if (year.running()) {
    ImGui::SameLine();
    ImGui::TextUnformatted("refined ...");
  }
  for (std::string line : year.lines()) {
    // Blanks that align columns in a terminal would only break the lines here.
    line.erase(
        std::unique(line.begin(), line.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
        line.end());
    ImGui::TextWrapped("%s", line.c_str());
  }
}

}  // namespace

bool draw_daylight(PanelState& state) {
  const MovingSky* const sky = state.lights.sky();
  if (!sky || !ImGui::CollapsingHeader("Daylight", ImGuiTreeNodeFlags_DefaultOpen)) return false;
  LightBoard::Daylight& daylight = state.lights.daylight();
  bool changed = ImGui::Checkbox("##sky", &daylight.on);
  ImGui::SameLine();
  ImGui::TextUnformatted("daylight");
  ImGui::SameLine();
  ImGui::Checkbox("adapt", &state.display.adapts);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the exposure follows the hour");
  constexpr double first = 0, last = 24 - 1.0 / 60;
  double hour = daylight.moment.hour;
  if (ImGui::SliderScalar("hour", ImGuiDataType_Double, &hour, &first, &last,
                          hour_text(daylight.moment).c_str(), ImGuiSliderFlags_AlwaysClamp)) {
    daylight.moment.hour = hour;
    changed = true;
  }
  int day = daylight.moment.day;
  if (ImGui::SliderInt("day", &day, 1, 365, day_text(daylight.moment).c_str(),
                       ImGuiSliderFlags_AlwaysClamp)) {
    daylight.moment.day = day;
    changed = true;
  }
  ImGui::TextWrapped("%s", sky->text(daylight.moment).c_str());
  if (state.year.possible()) draw_year(state.year);
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
