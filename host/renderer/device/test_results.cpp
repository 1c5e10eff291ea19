#include "device/test_results.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "device/cache_folder.hpp"
#include "device/embedded_files.hpp"
#include "device/kernel_store.hpp"

namespace photile::device {
namespace {

/// All kernels together: whichever changes, the test is to be made again.
const std::string& all_kernels() {
  static const std::string text = [] {
    std::vector<EmbeddedFile> files(embedded_files().begin(), embedded_files().end());
    std::sort(files.begin(), files.end(),
              [](const EmbeddedFile& a, const EmbeddedFile& b) { return a.path < b.path; });
    std::string joined;
    for (const EmbeddedFile& file : files) joined.append(file.path).append(file.text);
    return joined;
  }();
  return text;
}

CacheKey key_of(const DeviceInfo& device) {
  return program_key(device, "device test", all_kernels());
}

std::optional<KernelStore> results() {
  const auto folder = persistent_cache_folder();
  if (!folder) return std::nullopt;
  return KernelStore(*folder / "kernels", {}, ".test");
}

}  // namespace

std::string kept_test_result(const DeviceInfo& device) {
  const auto store = results();
  return store ? store->load(key_of(device)).value_or("") : "";
}

void keep_test_result(const DeviceInfo& device, const std::string& result) {
  if (const auto store = results()) {
    store->store(key_of(device), result);
  } else {
    warn(
        "the result of the device's test is not kept; set XDG_CACHE_HOME to a folder that can be "
        "written");
  }
}

}  // namespace photile::device
