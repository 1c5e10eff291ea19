#include "serve/live_luminaires.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "common/json_object.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "serve/page_requests.hpp"

namespace photile::serve {
namespace {

using loading::PlacedLuminaires;
using nlohmann::json;

constexpr int most_entries = 1000, most_in_a_row = 100;
/// Metres, of spacings, and from the eye.
constexpr double widest_spacing = 100, farthest_pick = 1e4;

json components(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// Two members of an array, of any type.
const json& pair_in(const json& body, const char* key, const JsonObject& object) {
  static const json none;
  const json& pair = body.contains(key) ? body[key] : none;
  if (!pair.is_array() || pair.size() != 2) object.refuse(fmt::format("'{}' is not a pair", key));
  return pair;
}

void set_array(view::LuminaireEditor& editor, const json& body) {
  const JsonObject array(body, "luminaires", {"count", "spacing"});
  const json& counts = pair_in(body, "count", array);
  const json& metres = pair_in(body, "spacing", array);
  const std::optional<std::size_t> entry = editor.selected();
  if (!entry || *entry >= editor.placed().size()) return;
  const PlacedLuminaires& lamps = editor.placed()[*entry];
  glm::ivec2 count;
  glm::dvec2 spacing;
  for (const int i : {0, 1}) {
    const json members{{"count", counts[i]}, {"spacing", metres[i]}};
    const JsonObject along(members, "luminaires", {"count", "spacing"});
    count[i] = along.count("count", 1, most_in_a_row);
    spacing[i] = along.number("spacing", 0, widest_spacing);
    // Lamps in one place are of no use.
    if (count[i] > 1 && spacing[i] == 0) spacing[i] = 2 * lamps.opening[i];
  }
  editor.set_array(count[0], count[1], spacing);
}

}  // namespace

LiveLuminaires::LiveLuminaires(const std::filesystem::path& file,
                               std::vector<PlacedLuminaires> placed, const Scene& scene,
                               const SceneLoadOptions& load)
    : editor_(file, std::move(placed), scene), loader_(scene.source, load) {}

json LiveLuminaires::edit(const json& body) {
  const JsonObject asked(body, "luminaires",
                         {"select", "pick", "file", "place", "drag", "held", "rotate", "duplicate",
                          "remove", "position", "lumens", "array", "undo", "redo", "save"});
  const auto is_asked = [&](const char* what) { return body.value(what, json()) == true; };
  const auto refuse_many = [&] {
    if (editor_.list().entries.size() < most_entries) return;
    asked.refuse(fmt::format("there are {} entries, and no more can be added", most_entries));
  };
  const loading::LuminaireList before = editor_.list();
  json answer = json::object();
  if (asked.has("select")) {
    const int entry = asked.count("select", -1, most_entries);
    const bool known = entry >= 0 && static_cast<std::size_t>(entry) < before.entries.size();
    editor_.select(known ? std::optional<std::size_t>(static_cast<std::size_t>(entry))
                         : std::nullopt);
  }
  if (asked.has("pick")) {
    const JsonObject ray(body["pick"], "luminaires", {"eye", "direction", "farthest"});
    const auto under = editor_.along(ray.vector("eye"), direction_in(ray, "direction"),
                                     ray.number("farthest", 0, farthest_pick));
    if (under) editor_.select(under);
    answer["picked"] = under.has_value();
  }
  if (asked.has("file")) {
    const std::vector<std::string> files = editor_.photometric_files();
    const std::string file = asked.text("file", "");
    if (std::find(files.begin(), files.end(), file) == files.end()) {
      asked.refuse("names a photometric file that is not beside the list");
    }
    editor_.set_next_file(file);
  }
  if (asked.has("place")) {
    const JsonObject place(body["place"], "luminaires", {"place", "normal"});
    refuse_many();
    editor_.place(place.vector("place"), direction_in(place, "normal"));
  }
  if (asked.has("drag")) {
    const JsonObject drag(body["drag"], "luminaires", {"eye", "from", "to"});
    editor_.drag(drag.vector("eye"), direction_in(drag, "from"), direction_in(drag, "to"));
  }
  if (asked.has("rotate")) editor_.rotate(asked.number("rotate", -360, 360));
  if (asked.has("position")) editor_.set_position(asked.vector("position"));
  if (asked.has("lumens")) {
    editor_.set_lumens(asked.number("lumens", 0, limits::max_light_power));
  }
  if (asked.has("array")) set_array(editor_, body["array"]);
  if (is_asked("duplicate")) {
    refuse_many();
    editor_.duplicate();
  }
  if (is_asked("remove")) editor_.remove();
  const bool undoes = is_asked("undo");
  if (undoes || is_asked("redo")) {
    loading::LuminaireList list = before;
    if (undoes ? history_.undo(list) : history_.redo(list)) {
      editor_.restore(std::move(list));
      changed_ = true;
    }
  } else {
    const bool changed = editor_.list() != before;
    history_.note(before, changed, is_asked("held"));
    changed_ |= changed;
  }
  if (is_asked("save")) {
    editor_.save();
    answer["message"] = fmt::format("{} is saved", editor_.file().filename().string());
  }
  if (!is_asked("held") && std::exchange(changed_, false)) loader_.load(text());
  return answer;
}

json LiveLuminaires::state() const {
  const auto& entries = editor_.list().entries;
  json list = json::array();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i >= editor_.placed().size()) {  // until it is loaded
      list.push_back({{"name", entries[i].value("name", "...")}, {"middles", json::array()}});
      continue;
    }
    const PlacedLuminaires& lamps = editor_.placed()[i];
    json middles = json::array();
    for (const glm::dvec3& middle : lamps.middles()) middles.push_back(components(middle));
    list.push_back({{"name", lamps.name},
                    {"middles", std::move(middles)},
                    {"across", components(0.5 * lamps.opening.x * lamps.axes[0])},
                    {"along", components(0.5 * lamps.opening.y * lamps.axes[1])},
                    {"rotation", glm::degrees(lamps.rotation)},
                    {"lumens", lamps.lumens},
                    {"count", {lamps.columns, lamps.rows}},
                    {"spacing", {lamps.spacing.x, lamps.spacing.y}}});
  }
  json state{{"file", editor_.file().filename().string()},
             {"files", editor_.photometric_files()},
             {"next", editor_.next_file()},
             {"unsaved", editor_.unsaved()},
             {"loading", loader_.busy()},
             {"entries", std::move(list)}};
  if (const auto selected = editor_.selected()) {
    state["selected"] = *selected;
    state["position"] = components(editor_.position());
  }
  return state;
}

std::shared_ptr<const Scene> LiveLuminaires::take_scene() {
  if (const std::exception_ptr error = loader_.take_error()) std::rethrow_exception(error);
  const auto loaded = loader_.take();
  if (!loaded) return nullptr;
  editor_.loaded(loaded->luminaires, loaded->scene->luminaires);
  return {loaded->scene, &loaded->scene->scene};
}

void LiveLuminaires::tell_unsaved(Progress& notes) const {
  if (!editor_.unsaved()) return;
  notes.note(fmt::format("{}: changes to luminaires are not saved", editor_.file().string()));
}

}  // namespace photile::serve
