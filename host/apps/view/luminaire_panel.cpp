// The luminaires that are placed, and the selected ones' numbers.
#include <imgui.h>

#include <algorithm>
#include <array>

#include "photile/limits.hpp"
#include "view/panels.hpp"

namespace photile::view {
namespace {

/// The speed of a slider as imgui takes it: a step of the slider for each pixel.
constexpr float metres_per_pixel = 0.01f, degrees_per_pixel = 0.5f;
constexpr int most_in_a_row = 100;  ///< that the panel sets

void draw_file(LuminaireTool& tool) {
  LuminaireEditor& editor = tool.editor();
  const std::string next = editor.next_file();
  if (ImGui::BeginCombo("file", next.empty() ? "none" : next.c_str())) {
    for (const std::string& name : editor.photometric_files()) {
      if (ImGui::Selectable(name.c_str(), name == next)) editor.set_next_file(name);
    }
    ImGui::EndCombo();
  }
  if (ImGui::Button(tool.placing() ? "click a surface" : "place")) tool.placing() = !tool.placing();
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the next click on a surface places a lamp (P)");
}

void draw_list(LuminaireEditor& editor) {
  const auto& entries = editor.list().entries;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const std::string name =
        i < editor.placed().size() ? editor.placed()[i].name : entries[i].value("name", "...");
    if (ImGui::Selectable(name.c_str(), editor.selected() == i)) editor.select(i);
    ImGui::PopID();
  }
}

void draw_array(LuminaireEditor& editor, const loading::PlacedLuminaires& lamps) {
  std::array<int, 2> count{lamps.columns, lamps.rows};
  glm::vec2 spacing(lamps.spacing);
  bool changed = ImGui::DragInt2("count", count.data(), 0.1f, 1, most_in_a_row, "%d",
                                 ImGuiSliderFlags_AlwaysClamp);
  changed |= ImGui::DragFloat2("spacing", &spacing.x, metres_per_pixel, 0, 100, "%.2f m",
                               ImGuiSliderFlags_AlwaysClamp);
  if (!changed) return;
  glm::dvec2 apart(spacing);
  for (int i = 0; i < 2; ++i) {  // lamps in one place are of no use
    if (count[static_cast<std::size_t>(i)] > 1 && apart[i] == 0) apart[i] = 2 * lamps.opening[i];
  }
  editor.set_array(count[0], count[1], apart);
}

void draw_selected(LuminaireEditor& editor) {
  if (!editor.selected() || *editor.selected() >= editor.placed().size()) return;
  const loading::PlacedLuminaires lamps = editor.placed()[*editor.selected()];
  glm::vec3 position(editor.position());
  if (ImGui::DragFloat3("position", &position.x, metres_per_pixel, 0, 0, "%.2f")) {
    editor.set_position(glm::dvec3(position));
  }
  auto degrees = static_cast<float>(glm::degrees(lamps.rotation));
  const double before = static_cast<double>(degrees);
  if (ImGui::DragFloat("rotation", &degrees, degrees_per_pixel, -180, 180, "%.1f deg")) {
    editor.rotate(static_cast<double>(degrees) - before);
  }
  double lumens = lamps.lumens;
  if (ImGui::InputDouble("lumens", &lumens, 0, 0, "%.6g", ImGuiInputTextFlags_EnterReturnsTrue)) {
    editor.set_lumens(std::clamp(lumens, 0.0, limits::max_light_power));
  }
  draw_array(editor, lamps);
  if (ImGui::Button("duplicate")) editor.duplicate();
  ImGui::SameLine();
  if (ImGui::Button("turn 90")) editor.rotate(90);
  ImGui::SameLine();
  if (ImGui::Button("delete")) editor.remove();
}

}  // namespace

void draw_luminaires(PanelState& state, const PanelReadings& readings, PanelEvents& events) {
  if (!state.luminaires) return;
  if (!ImGui::CollapsingHeader("Luminaires", ImGuiTreeNodeFlags_DefaultOpen)) return;
  LuminaireEditor& editor = state.luminaires->editor();
  draw_file(*state.luminaires);
  ImGui::SameLine();
  if (ImGui::Button("save")) events.save_luminaires = true;
  ImGui::SameLine();
  ImGui::TextUnformatted(readings.loading ? "loading ..." : editor.unsaved() ? "not saved" : "");
  draw_list(editor);
  draw_selected(editor);
}

void draw_closing(PanelState& state, PanelEvents& events) {
  constexpr const char* title = "Unsaved luminaires";
  if (!ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(0.5f * size.x, 0.5f * size.y), ImGuiCond_Always,
                          ImVec2(0.5f, 0.5f));
  if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  ImGui::Text("%s has changes that are not saved.",
              state.luminaires->editor().file().filename().string().c_str());
  const auto choose = [&](const char* label, Closing closing) {
    if (!ImGui::Button(label)) return;
    events.closing = closing;
    ImGui::CloseCurrentPopup();
  };
  choose("save and close", Closing::save);
  ImGui::SameLine();
  choose("close without", Closing::discard);
  ImGui::SameLine();
  choose("stay", Closing::stay);
  ImGui::EndPopup();
}

}  // namespace photile::view
