#include "scene/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace photile::scene_io {
namespace {

constexpr std::size_t names_listed = 5;

/// A warning is one line, whatever the file's names hold.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  return text;
}

}  // namespace

void Warnings::add(const std::string& message) { add("", "", message); }

void Warnings::add(const std::string& kind, const std::string& name, const std::string& message) {
  auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& candidate) {
    return candidate.kind == kind && candidate.message == message;
  });
  if (entry == entries_.end()) entry = entries_.insert(entries_.end(), {kind, message, {}});
  if (std::find(entry->names.begin(), entry->names.end(), name) == entry->names.end()) {
    entry->names.push_back(name);
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
    const std::size_t listed = std::min(entry.names.size(), names_listed);
    for (std::size_t i = 0; i < listed; ++i) {
      line += fmt::format("{} '{}'", i == 0 ? "" : ",", entry.names[i]);
    }
    if (entry.names.size() > listed)
      line += fmt::format(" and {} more", entry.names.size() - listed);
    lines.push_back(one_line(line + ": " + entry.message));
  }
  return lines;
}

}  // namespace photile::scene_io
