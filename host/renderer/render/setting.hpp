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

/// A row of the table, or of a command's own settings, which are not parameters of a rendering.
struct Setting {
  std::string_view name = {};    ///< in records and refusals, such as "photons_emitted"
  std::string_view unit = {};    ///< "" = none
  std::string_view option = {};  ///< of the command, "k,neighbours"; "" = set by its name
  std::string_view group = {};   ///< of options: Picture, Photons or Estimate
  std::string_view reader = {};  ///< the stage that reads it
  std::string_view help = {};
  /// What applies by default, as the value 0. "" = it always has a value in its range.
  std::string otherwise = {};
  ValueRange range = {};
  /// The value for each of all_qualities, where they set it.
  std::vector<SettingValue> by_quality = {};
  /// How photons and their groups depend on the setting, in words; "" = not for these values. Null:
  /// they never do.
  std::string (*kept)(const Setting& setting, const RenderParameters& parameters) = nullptr;
  bool kept_for_groups = false;  ///< only groups depend on it, not photons

  SettingValue (*value)(const RenderParameters& parameters) = nullptr;
  void (*set)(RenderParameters& parameters, const SettingValue& value) = nullptr;
  /// In lists of what a command can set: stores the value, which is within its range.
  std::function<void(const SettingValue& value)> assign = {};

  bool is_of_quality() const { return !by_quality.empty(); }
  bool is_given(const RenderParameters& parameters) const;
};

/// All rows, by group.
std::span<const Setting> settings();

/// The row of this name, which must exist.
const Setting& setting_named(std::string_view name);

/// Whether a setting is of the group Picture, which path tracing has, too.
inline bool is_of_any_integrator(const Setting& setting) { return setting.group == "Picture"; }

/// The number times `factor`, within its range.
SettingValue scaled(const Setting& setting, const RenderParameters& parameters, double factor);

/// "45 degrees".
std::string text_with_unit(const Setting& setting, const RenderParameters& parameters);

/// What photons depend on besides the scene, in words for refusals.
std::string photon_settings(const RenderParameters& parameters);

/// What neighbour groups depend on besides the photons.
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

/// Errors: SettingError for the first setting that is out of its range or does not fit the others.
void check(const RenderParameters& parameters);

}  // namespace photile
