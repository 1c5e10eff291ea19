// The table of settings: each parameter of a rendering once, for everything that lists them:
// checks, options of the command, qualities, records of a run, saved maps, the documentation.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/value_range.hpp"
#include "photile/errors.hpp"
#include "photile/renderer.hpp"

namespace photile {

/// A row of the table; or of a command's own settings, which are no parameters of a rendering.
struct Setting {
  std::string_view name = {};    ///< in records and refusals, such as "photons_emitted"
  std::string_view unit = {};    ///< "" = none
  std::string_view option = {};  ///< of the command, "k,neighbours"; "" = set by its name
  std::string_view group = {};   ///< of options: Picture, Photons or Estimate
  std::string_view reader = {};  ///< the stage that reads it
  std::string_view help = {};
  /// What applies where it is not given, which the value 0 stands for. "" = it always has a value
  /// in its range.
  std::string otherwise = {};
  ValueRange range = {};
  /// The value for each of all_qualities, where they set it.
  std::vector<SettingValue> by_quality = {};
  /// What photons and their groups depend on, in words; "" = not on this. Null: they never do.
  std::string (*kept)(const Setting& setting, const RenderParameters& parameters) = nullptr;
  bool kept_for_groups = false;  ///< photons alone do not depend on it

  SettingValue (*value)(const RenderParameters& parameters) = nullptr;
  void (*set)(RenderParameters& parameters, const SettingValue& value) = nullptr;
  /// In lists of what a command can set: sets the value, within its range, where that is kept.
  std::function<void(const SettingValue& value)> assign = {};

  bool is_of_quality() const { return !by_quality.empty(); }
  bool is_given(const RenderParameters& parameters) const;
};

/// All rows, by group.
std::span<const Setting> settings();

/// The row of this name, which has to be there.
const Setting& setting_named(std::string_view name);

/// Whether a setting is of the group Picture, which path tracing has, too.
inline bool is_of_any_integrator(const Setting& setting) { return setting.group == "Picture"; }

/// The number times `factor`, within its range.
SettingValue scaled(const Setting& setting, const RenderParameters& parameters, double factor);

/// "45 degrees".
std::string text_with_unit(const Setting& setting, const RenderParameters& parameters);

/// What photons depend on beside the scene, in words that a refusal can name.
std::string photon_settings(const RenderParameters& parameters);

/// What neighbour groups depend on beside the photons.
std::string group_settings(const RenderParameters& parameters);

/// A setting is out of its range. The message begins with its name.
struct SettingError : UsageError {
  SettingError(const Setting& setting, const std::string& problem)
      : UsageError(std::string(setting.name) + ": " + problem),
        setting(setting),
        problem(problem) {}
  const Setting& setting;
  std::string problem;  ///< without the name
};

/// Errors: SettingError for the first setting out of its range, or that goes with no other.
void check(const RenderParameters& parameters);

}  // namespace photile
