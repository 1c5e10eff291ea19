#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "photile/renderer.hpp"
#include "render/setting.hpp"

namespace photile {

std::vector<std::string_view> setting_names() {
  std::vector<std::string_view> names;
  for (const Setting& setting : settings()) names.push_back(setting.name);
  return names;
}

void set_by_name(RenderParameters& parameters, std::string_view name,
                 const std::variant<std::uint64_t, double, std::string_view>& value) {
  const auto all = settings();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Setting& setting) { return setting.name == name; });
  if (found == all.end()) {
    throw UsageError(fmt::format("{}: there is no such setting; there are {}", name,
                                 fmt::join(setting_names(), ", ")));
  }
  SettingValue fitting = value;
  const bool any_number = std::holds_alternative<Numbers>(found->range) ||
                          std::holds_alternative<PositiveNumbers>(found->range);
  if (const auto* whole = std::get_if<std::uint64_t>(&value); whole && any_number) {
    fitting = static_cast<double>(*whole);
  }
  if (!contains(found->range, fitting)) {
    throw SettingError(*found, out_of_range(text_of(fitting), found->range));
  }
  found->set(parameters, fitting);
}

}  // namespace photile
