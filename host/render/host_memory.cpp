#include "render/host_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace photile {
namespace {

constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

/// The number that follows `label` in a file of lines "label number"; an empty label: at its start.
std::optional<std::uint64_t> number_in(const char* file, const std::string& label) {
  std::ifstream stream(file);
  std::string word;
  while (!label.empty() && stream >> word && word != label) {
  }
  std::uint64_t number = 0;
  if (stream >> number) return number;
  return std::nullopt;
}

std::uint64_t system_bytes() {
  const auto kib = number_in("/proc/meminfo", "MemTotal:");
  return kib ? *kib * 1024 : unknown;
}

std::uint64_t control_group_bytes() {
  return number_in("/sys/fs/cgroup/memory.max", "").value_or(unknown);  // "max" is no number
}

}  // namespace

std::uint64_t installed_host_bytes() { return std::min(system_bytes(), control_group_bytes()); }

}  // namespace photile
