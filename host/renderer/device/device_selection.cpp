#include "device/device_selection.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <optional>
#include <string_view>
#include <vector>

#include "common/ascii_text.hpp"
#include "device/cache_folder.hpp"
#include "photile/errors.hpp"

namespace photile::device {
namespace {

/// Smaller is better.
int rank(const DeviceInfo& device) {
  if (device.platform == "Oclgrind") return 4;  // a checker, about 1000 times slower
  if (device.type == DeviceType::gpu) return 0;
  if (device.is_pocl) return 1;
  return device.type == DeviceType::cpu ? 2 : 3;
}

/// The rank of a device that was not asked for.
int default_rank(const DeviceInfo& device) {
  const bool untested = device.type == DeviceType::gpu && device.test_result != passed;
  return untested ? 3 : rank(device);
}

std::optional<std::size_t> best(std::span<const DeviceInfo> devices,
                                const std::function<bool(const DeviceInfo&)>& matches,
                                int (*rank_of)(const DeviceInfo&) = rank) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (matches(devices[i]) && (!found || rank_of(devices[i]) < rank_of(devices[*found]))) {
      found = i;
    }
  }
  return found;
}

std::optional<std::size_t> find(std::span<const DeviceInfo> devices, const std::string& requested) {
  if (requested.empty()) {
    return best(
        devices, [](const DeviceInfo&) { return true; }, default_rank);
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (devices[i].id == requested) return i;
  }
  if (requested.find_first_not_of("0123456789") == std::string::npos) {
    const auto index = parse_number<std::size_t>(requested);
    return index && *index < devices.size() ? index : std::nullopt;
  }
  if (requested == "cpu" || requested == "gpu") {
    const auto type = requested == "cpu" ? DeviceType::cpu : DeviceType::gpu;
    return best(devices, [&](const DeviceInfo& device) { return device.type == type; });
  }
  return best(devices, [&](const DeviceInfo& device) {
    return lower(device.name).find(requested) != std::string::npos ||
           lower(device.platform).find(requested) != std::string::npos;
  });
}

/// Where a selector came from, for messages: "device selector 'cpu'", "PHOTILE_DEVICE 'cpu'".
struct Source {
  std::string text;

  [[noreturn]] void refuse(const std::string& problem) const {
    throw DeviceError(fmt::format("{} {}", text, problem));
  }
};

/// A positive number of at most 9 digits.
std::optional<std::uint32_t> parse_positive(std::string_view text) {
  const auto number = parse_number<std::uint32_t>(text);
  return number && *number > 0 && text.size() <= 9 ? number : std::nullopt;
}

/// What follows a device's name: sub-devices.
struct Partition {
  std::uint32_t equal_parts = 0;             ///< "/N"
  std::vector<std::uint32_t> compute_units;  ///< "=A+B"
};

/// Cuts the partition off the end of `name`. Device names themselves may hold a '/' or '=': only
/// numbers after it make it a partition.
Partition take_partition(std::string& name) {
  const std::size_t at = name.find_last_of("/=");
  if (at == std::string::npos) return {};
  Partition partition;
  std::string_view numbers = std::string_view(name).substr(at + 1);
  if (name[at] == '/') {
    const auto parts = parse_positive(numbers);
    if (!parts) return {};
    partition.equal_parts = *parts;
  } else {
    for (;;) {
      const std::size_t plus = numbers.find('+');
      const auto count = parse_positive(numbers.substr(0, plus));
      if (!count) return {};
      partition.compute_units.push_back(*count);
      if (plus == std::string_view::npos) break;
      numbers.remove_prefix(plus + 1);
    }
  }
  name.erase(at);
  return partition;
}

/// Compute units of each sub-device. Parts that cannot be equal differ by one unit.
std::vector<std::uint32_t> compute_units_of(const Partition& partition, const DeviceInfo& device,
                                            const Source& source) {
  const std::uint64_t requested =
      std::accumulate(partition.compute_units.begin(), partition.compute_units.end(),
                      std::uint64_t{partition.equal_parts});
  if (requested > device.compute_units) {
    source.refuse(fmt::format("asks for {} compute units, but {} {} has {}; ask for fewer",
                              requested, device.id, device.name, device.compute_units));
  }
  std::vector<std::uint32_t> units = partition.compute_units;
  for (std::uint32_t part = 0; part < partition.equal_parts; ++part) {
    units.push_back((device.compute_units + part) / partition.equal_parts);
  }
  return units;
}

/// Every device but Oclgrind's simulator, a checker: by far the slowest, it would be the last to
/// finish its share.
std::vector<DeviceChoice> all_of(std::span<const DeviceInfo> devices) {
  std::vector<DeviceChoice> choices;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (devices[i].platform != "Oclgrind") choices.push_back({i});
  }
  if (choices.empty()) choices.push_back({0});
  return choices;
}

DeviceChoice choose(std::span<const DeviceInfo> devices, std::string name, const Source& source) {
  const Partition partition = take_partition(name);
  const auto found = find(devices, name);
  if (!found) {
    std::vector<std::string> names;
    for (const auto& device : devices) {
      names.push_back(fmt::format("{} {}", device.id, device.name));
    }
    source.refuse(fmt::format(
        "matches no OpenCL device; there are: {}; give platform:device, an index, cpu, gpu or a "
        "part of a name",
        fmt::join(names, ", ")));
  }
  return {*found, compute_units_of(partition, devices[*found], source)};
}

/// $PHOTILE_DEVICE, or "".
std::string device_from_environment() {
  const char* const variable = std::getenv(device_variable);
  return variable == nullptr ? "" : variable;
}

}  // namespace

bool chooses_best(const std::string& selector) {
  return selector.empty() && device_from_environment().empty();
}

std::string untested_gpu(std::span<const DeviceInfo> devices, const DeviceInfo& chosen) {
  const auto untested = [](const DeviceInfo& device) {
    return device.type == DeviceType::gpu && device.test_result != passed;
  };
  const auto found = std::find_if(devices.begin(), devices.end(), untested);
  const bool is_gpu = chosen.type == DeviceType::gpu;
  if (found == devices.end() || (is_gpu && !untested(chosen))) return {};
  const DeviceInfo& gpu = is_gpu ? chosen : *found;
  const std::string why = gpu.test_result.empty()
                              ? "has not been tested; run photile devices --test once"
                              : "did not pass its test (" + gpu.test_result + ")";
  return is_gpu ? fmt::format("{} {} {}, and there is no other device", gpu.id, gpu.name, why)
                : fmt::format("{} {} is not used because it {}; or select it by --device {}",
                              gpu.id, gpu.name, why, gpu.id);
}

namespace {

/// Whether the process may not open as many files as loading a runtime takes.
bool files_run_out() {
  std::array<int, 16> files{};
  for (int& file : files) file = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const bool out = files.back() < 0 && (errno == EMFILE || errno == ENFILE);
  for (const int file : files) {
    if (file >= 0) ::close(file);
  }
  return out;
}

}  // namespace

std::vector<DeviceChoice> select_devices(std::span<const DeviceInfo> devices, std::string selector,
                                         std::span<const std::string> left_out) {
  std::string origin = "device selector";
  if (selector.empty() && !chooses_best(selector)) {
    selector = device_from_environment();
    origin = device_variable;
  }
  if (devices.empty() && files_run_out()) {
    throw DeviceError(
        "too many files are open to load an OpenCL runtime; raise the limit (ulimit -n)");
  }
  if (devices.empty()) {
    throw DeviceError(fmt::format(
        "no usable OpenCL device{}; install a runtime (Debian: apt install pocl-opencl-icd)",
        left_out.empty() ? ": no OpenCL runtime is installed"
                         : fmt::format(" ({})", fmt::join(left_out, "; "))));
  }
  const Source source{fmt::format("{} '{}'", origin, selector)};
  selector = lower(selector);
  if (selector == "all") return all_of(devices);
  std::vector<DeviceChoice> choices;
  for (std::size_t begin = 0; begin <= selector.size();) {
    const std::size_t end = std::min(selector.find(',', begin), selector.size());
    if (begin == end && !selector.empty()) {
      source.refuse("has a comma without a device on both sides; name one or remove the comma");
    }
    choices.push_back(choose(devices, selector.substr(begin, end - begin), source));
    const std::size_t index = choices.back().index;
    if (std::any_of(choices.begin(), choices.end() - 1,
                    [&](const DeviceChoice& choice) { return choice.index == index; })) {
      source.refuse(fmt::format("names {} {} twice; name each device once", devices[index].id,
                                devices[index].name));
    }
    begin = end + 1;
  }
  return choices;
}

}  // namespace photile::device
