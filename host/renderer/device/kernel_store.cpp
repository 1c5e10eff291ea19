#include "device/kernel_store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

#include "device/cache_folder.hpp"

namespace photile::device {

namespace {

/// Variables of PoCL that do not change the code: where its cache is, what it prints, how many
/// threads it starts (`photile render --threads` sets the last two).
constexpr std::array<std::string_view, 4> without_effect{
    "POCL_CACHE_DIR=", "POCL_DEBUG", "POCL_MAX_PTHREAD_COUNT=", "POCL_CPU_MAX_CU_COUNT="};

/// The entries of the environment that begin like this, sorted, but for those without effect.
std::set<std::string> variables_of(std::string_view runtime) {
  std::set<std::string> entries;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (text.starts_with(runtime) &&
        std::none_of(without_effect.begin(), without_effect.end(),
                     [&](std::string_view variable) { return text.starts_with(variable); })) {
      entries.emplace(text);
    }
  }
  return entries;
}

}  // namespace

std::string CacheKey::hex() const {
  std::string digits;
  for (const unsigned char byte : bytes) digits += fmt::format("{:02x}", byte);
  return digits;
}

CacheKey hash(std::string_view text) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(text.data(), text.size()));
  CacheKey key;
  static_assert(sizeof canonical.digest == sizeof key.bytes);
  std::copy(std::begin(canonical.digest), std::end(canonical.digest), key.bytes.begin());
  return key;
}

CacheKey program_key(const DeviceInfo& device, std::string_view options, std::string_view source) {
  // The length before each field keeps ("ab", "c") and ("a", "bc") apart.
  std::string text;
  const auto add = [&](std::string_view field) {
    text += fmt::format("{}:", field.size());
    text += field;
  };
  add(device.platform);
  add(device.platform_version);
  add(device.name);
  add(device.vendor);
  add(device.version);
  add(device.driver_version);
  add(options);
  add(source);
  // Variables of PoCL, or of Intel's runtime, which others ignore.
  for (const auto& variable : variables_of(device.is_pocl ? "POCL_" : "CL_CONFIG_")) add(variable);
  return hash(text);
}

namespace {

constexpr std::string_view magic = "PHOTILEC";
constexpr std::uint32_t format_version = 1;
constexpr std::uint64_t max_payload_bytes = 1ull << 30;  ///< far above any program
constexpr std::size_t checksum_offset = 40;

/// Closes on scope exit.
struct Descriptor {
  int value;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

std::string header_of(const CacheKey& key, std::string_view payload) {
  std::string header(checked_file_header_bytes, '\0');
  const std::uint64_t length = payload.size();
  std::memcpy(header.data(), magic.data(), magic.size());
  std::memcpy(header.data() + 8, &format_version, sizeof format_version);
  std::memcpy(header.data() + 16, key.bytes.data(), key.bytes.size());
  std::memcpy(header.data() + 32, &length, sizeof length);
  const auto checksum = hash(header.substr(0, checksum_offset).append(payload));
  std::memcpy(header.data() + checksum_offset, checksum.bytes.data(), checksum.bytes.size());
  return header;
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

bool read_all(int file, std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const auto got = ::read(file, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

CheckedRead read_checked_file(const std::filesystem::path& path, const CacheKey& key) {
  // O_NONBLOCK: opening a FIFO of that name must not hang.
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.value < 0) return {{}, errno == ENOENT ? "" : std::strerror(errno)};
  struct stat status {};
  if (::fstat(file.value, &status) != 0) return {{}, std::strerror(errno)};
  if (!S_ISREG(status.st_mode)) return {{}, "not a regular file"};
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size < checked_file_header_bytes) return {{}, fmt::format("{} bytes, no header", size)};
  if (size - checked_file_header_bytes > max_payload_bytes) return {{}, "too large"};

  std::string bytes(size, '\0');
  if (!read_all(file.value, bytes)) return {{}, "cannot be read to its end"};
  std::string payload = bytes.substr(checked_file_header_bytes);
  // Magic, version, key, length and checksum are all functions of key and payload.
  if (bytes.compare(0, checked_file_header_bytes, header_of(key, payload)) != 0) {
    return {{}, "damaged"};
  }
  return {std::move(payload), {}};
}

std::string write_checked_file(const std::filesystem::path& path, const CacheKey& key,
                               std::string_view payload) {
  std::string temporary = path.string() + ".XXXXXX";
  Descriptor file{::mkostemp(temporary.data(), O_CLOEXEC)};
  if (file.value < 0) return std::strerror(errno);
  const bool written = write_all(file.value, header_of(key, payload)) &&
                       write_all(file.value, payload) && ::fsync(file.value) == 0;
  // close() reports what a network file system kept for itself until then.
  const bool closed = ::close(std::exchange(file.value, -1)) == 0;
  if (written && closed && ::rename(temporary.c_str(), path.c_str()) == 0) return {};
  const std::string problem = std::strerror(errno);
  ::unlink(temporary.c_str());
  return problem;
}

namespace fs = std::filesystem;

KernelStore::KernelStore(fs::path folder, std::vector<fs::path> installed, std::string ending)
    : folder_(std::move(folder)), installed_(std::move(installed)), ending_(std::move(ending)) {
  std::error_code ignored;  // storing will say so
  fs::create_directories(folder_, ignored);
}

std::optional<std::string> KernelStore::load(const CacheKey& key) const {
  std::vector<fs::path> folders{folder_};
  folders.insert(folders.end(), installed_.begin(), installed_.end());
  for (const fs::path& folder : folders) {
    const fs::path file = folder / name(key);
    CheckedRead read = read_checked_file(file, key);
    if (read.payload) return std::move(read.payload);
    if (!read.problem.empty()) {
      warn(fmt::format("compiled kernels '{}': {}; not used", file.string(), read.problem));
    }
  }
  return std::nullopt;
}

bool KernelStore::store(const CacheKey& key, std::string_view kernels) const {
  const std::string problem = write_checked_file(file(key), key, kernels);
  if (problem.empty()) return true;
  warn(fmt::format("compiled kernels are not kept in '{}': {}", folder_.string(), problem));
  return false;
}

}  // namespace photile::device
