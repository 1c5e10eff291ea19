#include "device/device_selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <optional>
#include <vector>

#include "photile/errors.hpp"

namespace photile::device {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Smaller is better.
int rank(const DeviceInfo& device) {
  if (device.platform == "Oclgrind") return 4;  // a checker, about 1000 times slower
  if (device.type == DeviceType::gpu) return 0;
  if (device.is_pocl) return 1;
  return device.type == DeviceType::cpu ? 2 : 3;
}

std::optional<std::size_t> best(std::span<const DeviceInfo> devices,
                                const std::function<bool(const DeviceInfo&)>& matches) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (matches(devices[i]) && (!found || rank(devices[i]) < rank(devices[*found]))) found = i;
  }
  return found;
}

std::optional<std::size_t> find(std::span<const DeviceInfo> devices, const std::string& wanted) {
  if (wanted.empty()) return best(devices, [](const DeviceInfo&) { return true; });
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (devices[i].id == wanted) return i;
  }
  if (wanted.find_first_not_of("0123456789") == std::string::npos) {
    std::size_t index = 0;
    const auto parsed = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    const bool listed = parsed.ec == std::errc() && index < devices.size();
    return listed ? std::optional(index) : std::nullopt;
  }
  if (wanted == "cpu" || wanted == "gpu") {
    const auto type = wanted == "cpu" ? DeviceType::cpu : DeviceType::gpu;
    return best(devices, [&](const DeviceInfo& device) { return device.type == type; });
  }
  return best(devices, [&](const DeviceInfo& device) {
    return lower(device.name).find(wanted) != std::string::npos ||
           lower(device.platform).find(wanted) != std::string::npos;
  });
}

}  // namespace

std::size_t select_device(std::span<const DeviceInfo> devices, std::string selector,
                          std::span<const std::string> left_out) {
  std::string source = "device selector";
  if (const char* const variable = std::getenv(device_variable);
      selector.empty() && variable != nullptr && *variable != '\0') {
    selector = variable;
    source = device_variable;
  }
  if (devices.empty()) {
    throw DeviceError(fmt::format(
        "no usable OpenCL device{}; install a runtime (Debian: apt install pocl-opencl-icd)",
        left_out.empty() ? ": no OpenCL runtime is installed"
                         : fmt::format(" ({})", fmt::join(left_out, "; "))));
  }
  if (const auto found = find(devices, lower(selector))) return *found;
  std::vector<std::string> names;
  for (const auto& device : devices) names.push_back(fmt::format("{} {}", device.id, device.name));
  throw DeviceError(
      fmt::format("{} '{}' matches no OpenCL device; there are: {}; give platform:device, an "
                  "index, cpu, gpu or "
                  "a part of a name",
                  source, selector, fmt::join(names, ", ")));
}

}  // namespace photile::device
