#include "view/luminaire_editor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"

namespace photile::view {
namespace {

using loading::PlacedLuminaires;

constexpr double off_surface = 0.005;  // metres: an opening is seen before what it hangs on
/// Positions and spacings are written to the millimetre, rotations to a hundredth of a degree.
constexpr double millimetre = 1e-3, hundredth = 1e-2;
/// A copy lies this many widths of its opening beside the first, if they have no spacing.
constexpr double widths_apart = 1.5;
/// The cosine to straight down from which on surfaces are ceilings.
constexpr double down_cosine = 0.999;

double rounded(double value, double step) {
  const double steps = std::round(value / step), per_one = std::round(1 / step);
  return steps / per_one + 0.0;  // no -0
}

nlohmann::ordered_json vector_of(const glm::dvec3& value, double step) {
  return {rounded(value.x, step), rounded(value.y, step), rounded(value.z, step)};
}

/// Along the ray to the opening's plane, where it is met within the opening; infinite elsewhere.
double distance_to(const PlacedLuminaires& lamps, const glm::dvec3& middle, const glm::dvec3& eye,
                   const glm::dvec3& direction) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const double across = glm::dot(direction, lamps.axes[2]);
  if (across == 0) return never;
  const double distance = glm::dot(middle - eye, lamps.axes[2]) / across;
  if (!(distance > 0)) return never;
  const glm::dvec3 within = eye + distance * direction - middle;
  const bool inside = std::abs(glm::dot(within, lamps.axes[0])) <= 0.5 * lamps.opening.x &&
                      std::abs(glm::dot(within, lamps.axes[1])) <= 0.5 * lamps.opening.y;
  return inside ? distance : never;
}

bool is_photometric(const std::filesystem::path& file) {
  const std::string extension = lower(file.extension().string());
  return extension == ".ies" || extension == ".ldt";
}

}  // namespace

LuminaireEditor::LuminaireEditor(std::filesystem::path file, std::vector<PlacedLuminaires> placed,
                                 const Scene& scene)
    : file_(std::move(file)),
      origin_(scene.origin),
      turn_(scene.turn),
      list_(loading::read_own_luminaires(file_)),
      saved_(list_),
      placed_(std::move(placed)) {}

void LuminaireEditor::restore(loading::LuminaireList list) {
  if (list == list_) return;
  list_ = std::move(list);
  placed_.clear();
  if (selected_ && *selected_ >= list_.entries.size()) selected_.reset();
}

void LuminaireEditor::loaded(const std::string& text, std::vector<PlacedLuminaires> placed) {
  if (text == list_.text()) placed_ = std::move(placed);
}

void LuminaireEditor::save() {
  write_luminaires(file_, list_);
  saved_ = list_;
}

std::vector<std::string> LuminaireEditor::photometric_files() const {
  std::set<std::string> names;
  const std::filesystem::path folder = file_.has_parent_path() ? file_.parent_path() : ".";
  std::error_code ignored;
  for (const auto& each : std::filesystem::directory_iterator(folder, ignored)) {
    if (is_photometric(each.path())) names.insert(each.path().filename().string());
  }
  for (const auto& entry : list_.entries) {
    if (entry.contains("file") && entry["file"].is_string()) {
      names.insert(entry["file"].get<std::string>());
    }
  }
  return {names.begin(), names.end()};
}

std::string LuminaireEditor::next_file() const {
  if (!next_file_.empty()) return next_file_;
  if (!list_.entries.empty()) return list_.entries.back().value("file", "");
  const std::vector<std::string> files = photometric_files();
  return files.empty() ? "" : files.front();
}

std::optional<std::size_t> LuminaireEditor::along(const glm::dvec3& eye,
                                                  const glm::dvec3& direction,
                                                  double farthest) const {
  std::optional<std::size_t> found;
  double nearest = farthest;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    for (const glm::dvec3& middle : placed_[i].middles()) {
      const double distance = distance_to(placed_[i], middle, eye, direction);
      if (distance > nearest) continue;
      nearest = distance;
      found = i;
    }
  }
  return found;
}

PlacedLuminaires* LuminaireEditor::at() {
  return selected_ && *selected_ < placed_.size() ? &placed_[*selected_] : nullptr;
}

std::string LuminaireEditor::free_name(const std::string& name) const {
  const auto taken = [&](const std::string& asked) {
    return std::any_of(list_.entries.begin(), list_.entries.end(), [&](const auto& entry) {
      const std::string stem = std::filesystem::path(entry.value("file", "")).stem().string();
      return entry.value("name", stem) == asked;
    });
  };
  // "panel_2" is followed by "panel_3", not by "panel_2_2".
  const std::size_t underscore = name.rfind('_');
  const bool numbered = underscore != std::string::npos && underscore + 1 < name.size() &&
                        name.find_first_not_of("0123456789", underscore + 1) == std::string::npos;
  const std::string stem = numbered && taken(name) ? name.substr(0, underscore) : name;
  std::string free = name;
  for (int number = 2; taken(free); ++number) free = fmt::format("{}_{}", stem, number);
  return free;
}

glm::dvec3 LuminaireEditor::in_world(const glm::dvec3& in_scene) const {
  return glm::transpose(turn_) * (in_scene + origin_);
}

void LuminaireEditor::write_position(const glm::dvec3& in_scene) {
  entry()["position"] = vector_of(in_world(in_scene), millimetre);
  entry().erase("inside");  // a room whose ceiling it hung from
}

void LuminaireEditor::place(const glm::dvec3& position, const glm::dvec3& normal) {
  const std::string name = next_file();
  if (name.empty()) {
    throw UsageError(
        fmt::format("there is no lamp to place: put a photometric file (.ies, .ldt) beside {}",
                    file_.string()));
  }
  nlohmann::ordered_json entry{{"name", free_name(std::filesystem::path(name).stem().string())},
                               {"file", name}};
  const std::optional<glm::dvec2> stated = loading::stated_opening(file_.parent_path() / name);
  if (!stated) entry["size"] = {defaults::luminaire_side, defaults::luminaire_side};
  PlacedLuminaires lamp;
  lamp.name = entry["name"].get<std::string>();
  lamp.position = position + off_surface * normal;
  lamp.opening = stated.value_or(glm::dvec2(defaults::luminaire_side));
  glm::dvec3 aim(0.0, -1.0, 0.0);
  if (-normal.y < down_cosine) {
    aim = normal;
    entry["aim"] = vector_of(glm::transpose(turn_) * aim, millimetre);
  }
  lamp.axes = loading::luminaire_axes(aim, 0);
  const bool known = placed_.size() == list_.entries.size();
  list_.entries.push_back(std::move(entry));
  if (known) placed_.push_back(lamp);
  selected_ = list_.entries.size() - 1;
  write_position(lamp.position);
}

void LuminaireEditor::duplicate() {
  PlacedLuminaires* const first = at();
  if (!first) return;
  PlacedLuminaires copy = *first;
  nlohmann::ordered_json copied = entry();
  const double step = std::max(copy.spacing.x, widths_apart * copy.opening.x);
  copy.position += ((copy.columns - 1) * copy.spacing.x + step) * copy.axes[0];
  copy.name = free_name(copy.name);
  copied["name"] = copy.name;
  list_.entries.push_back(std::move(copied));
  placed_.push_back(copy);
  selected_ = list_.entries.size() - 1;
  write_position(copy.position);
}

void LuminaireEditor::remove() {
  if (!selected_) return;
  const auto offset = static_cast<std::ptrdiff_t>(*selected_);
  if (at()) placed_.erase(placed_.begin() + offset);
  list_.entries.erase(list_.entries.begin() + offset);
  if (list_.entries.empty()) list_.alone = false;
  selected_.reset();
}

void LuminaireEditor::rotate(double degrees) {
  PlacedLuminaires* const lamps = at();
  if (!lamps) return;
  const double turned = std::remainder(glm::degrees(lamps->rotation) + degrees, 360.0);
  entry()["rotation"] = rounded(turned, hundredth);
  lamps->rotation = glm::radians(turned);
  lamps->axes = loading::luminaire_axes(-lamps->axes[2], lamps->rotation);
}

bool LuminaireEditor::drag(const glm::dvec3& eye, const glm::dvec3& from, const glm::dvec3& to) {
  PlacedLuminaires* const lamps = at();
  if (!lamps) return false;
  const glm::dvec3 normal = lamps->axes[2];
  const auto on_plane = [&](const glm::dvec3& direction) -> std::optional<glm::dvec3> {
    const double distance = glm::dot(lamps->position - eye, normal) / glm::dot(direction, normal);
    // Towards the plane's horizon a pixel would move it by kilometres.
    constexpr double farthest = 100;
    if (!(distance > 0) || distance > farthest) return std::nullopt;
    return eye + distance * direction;
  };
  const auto start = on_plane(from), end = on_plane(to);
  if (!start || !end) return false;
  lamps->position += *end - *start;
  write_position(lamps->position);
  return true;
}

void LuminaireEditor::set_position(const glm::dvec3& world) {
  if (PlacedLuminaires* const lamps = at()) {
    lamps->position = turn_ * world - origin_;
    write_position(lamps->position);
  }
}

void LuminaireEditor::set_lumens(double lumens) {
  if (PlacedLuminaires* const lamps = at()) {
    lamps->lumens = lumens;
    entry()["lumens"] = lumens;
  }
}

void LuminaireEditor::set_array(int columns, int rows, const glm::dvec2& spacing) {
  PlacedLuminaires* const lamps = at();
  if (!lamps) return;
  lamps->columns = columns;
  lamps->rows = rows;
  lamps->spacing = spacing;
  entry()["count"] = {columns, rows};
  entry()["spacing"] = {rounded(spacing.x, millimetre), rounded(spacing.y, millimetre)};
}

glm::dvec3 LuminaireEditor::position() const {
  const bool known = selected_ && *selected_ < placed_.size();
  return known ? in_world(placed_[*selected_].position) : glm::dvec3(0.0);
}

}  // namespace photile::view
