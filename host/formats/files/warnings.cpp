#include "files/warnings.hpp"

#include <fmt/format.h>

namespace photile::files {
namespace {

constexpr std::size_t names_listed = 5;

}  // namespace

void Warnings::add(const std::string& message) { add("", "", message); }

void Warnings::add(const std::string& kind, const std::string& name, const std::string& message) {
  const auto [known, is_new] = index_.try_emplace({kind, message}, entries_.size());
  if (is_new) entries_.push_back({kind, message, {}, {}});
  Entry& entry = entries_[known->second];
  if (entry.names.insert(name).second && entry.first_names.size() < names_listed) {
    entry.first_names.push_back(name);
  }
}

std::vector<std::string> Warnings::lines() const {
  std::vector<std::string> lines;
  for (const Entry& entry : entries_) {
    if (entry.kind.empty()) {
      lines.push_back(one_line(entry.message));
      continue;
    }
    std::string line = entry.kind;
    const std::size_t listed = entry.first_names.size();
    for (std::size_t i = 0; i < listed; ++i) {
      line += fmt::format("{} '{}'", i == 0 ? "" : ",", entry.first_names[i]);
    }
    if (entry.names.size() > listed)
      line += fmt::format(" and {} more", entry.names.size() - listed);
    lines.push_back(one_line(line + ": " + entry.message));
  }
  return lines;
}

}  // namespace photile::files
