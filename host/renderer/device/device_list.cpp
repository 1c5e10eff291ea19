#include "device/device_list.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "common/ascii_text.hpp"
#include "common/process_limits.hpp"
#include "device/cache_folder.hpp"
#include "device/context.hpp"
#include "device/pocl_cache.hpp"
#include "photile/device.hpp"

namespace photile::device {
namespace {

/// The loader's answer (cl_khr_icd) where no runtime is installed.
constexpr cl_int no_platform = -1001;

DeviceType type_of(cl_device_type type) {
  // Oclgrind's simulator claims every type at once; it runs on the CPU.
  if (type & CL_DEVICE_TYPE_CPU) return DeviceType::cpu;
  if (type & CL_DEVICE_TYPE_GPU) return DeviceType::gpu;
  if (type & CL_DEVICE_TYPE_ACCELERATOR) return DeviceType::accelerator;
  return DeviceType::other;
}

/// The width of the warps of NVIDIA's and the wavefronts of AMD's devices; 0 of others.
std::uint32_t lanes_of(cl_device_id device) {
  for (const cl_device_info name : {CL_DEVICE_WARP_SIZE_NV, CL_DEVICE_WAVEFRONT_WIDTH_AMD}) {
    cl_uint lanes = 0;
    if (clGetDeviceInfo(device, name, sizeof lanes, &lanes, nullptr) == CL_SUCCESS) return lanes;
  }
  return 0;
}

/// As DeviceInfo has it. Intel's runtime for CPUs refuses sub-groups of a given size where its
/// vectorizer has a mode (keep_intel_from_vectorizing).
bool has_shuffles(cl_device_id device, const DeviceInfo& info) {
  cl_uint major = 0, minor = 0;
  const bool told = clGetDeviceInfo(device, CL_DEVICE_COMPUTE_CAPABILITY_MAJOR_NV, sizeof major,
                                    &major, nullptr) == CL_SUCCESS &&
                    clGetDeviceInfo(device, CL_DEVICE_COMPUTE_CAPABILITY_MINOR_NV, sizeof minor,
                                    &minor, nullptr) == CL_SUCCESS;
  if (told) return major >= 8;
  const char* const mode = std::getenv("CL_CONFIG_CPU_VECTORIZER_MODE");
  if (info.platform == "Intel(R) OpenCL" && mode && std::string_view(mode) != "0") return false;
  return info.extensions.find("cl_intel_subgroups") != std::string::npos &&
         info.extensions.find("cl_intel_required_subgroup_size") != std::string::npos;
}

DeviceInfo describe(cl_platform_id platform, cl_device_id device) {
  DeviceInfo info;
  info.name = device_text(device, CL_DEVICE_NAME);
  info.platform = platform_text(platform, CL_PLATFORM_NAME);
  info.vendor = device_text(device, CL_DEVICE_VENDOR);
  info.version = device_text(device, CL_DEVICE_VERSION);
  info.driver_version = device_text(device, CL_DRIVER_VERSION);
  info.platform_version = platform_text(platform, CL_PLATFORM_VERSION);
  info.type = type_of(device_property<cl_device_type>(device, CL_DEVICE_TYPE));
  info.compute_units = device_property<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS);
  info.clock_mhz = device_property<cl_uint>(device, CL_DEVICE_MAX_CLOCK_FREQUENCY);
  info.extensions = device_text(device, CL_DEVICE_EXTENSIONS);
  info.global_memory_bytes = device_property<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
  info.max_allocation_bytes = device_property<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  info.local_memory_bytes = device_property<cl_ulong>(device, CL_DEVICE_LOCAL_MEM_SIZE);
  info.max_work_group_size = device_property<std::size_t>(device, CL_DEVICE_MAX_WORK_GROUP_SIZE);
  info.native_float_width = device_property<cl_uint>(device, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT);
  if (info.type != DeviceType::cpu) info.lanes = lanes_of(device);
  info.shuffles = has_shuffles(device, info);
  const auto single = device_property<cl_device_fp_config>(device, CL_DEVICE_SINGLE_FP_CONFIG);
  info.denormals = (single & CL_FP_DENORM) != 0;
  info.exact_division = (single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  info.is_pocl = info.platform == "Portable Computing Language";
  // Asked of others than CPUs alone: what these compute is tested with photile.
  if (info.type != DeviceType::cpu) info.test_result = kept_test_result(info);
  return info;
}

/// Why photile cannot use a device, or "".
std::string refusal(const DeviceInfo& info, cl_device_id device) {
  if (info.platform == "Clover") return "Mesa Clover computes wrong results; not supported";
  if (info.platform == "rusticl" && info.driver_version.starts_with("22."))
    return "rusticl of Mesa 22 computes wrong results; use a newer Mesa";
  if (!device_property<cl_bool>(device, CL_DEVICE_AVAILABLE)) return "not available";
  if (!device_property<cl_bool>(device, CL_DEVICE_COMPILER_AVAILABLE)) return "has no compiler";
  if (!device_property<cl_bool>(device, CL_DEVICE_ENDIAN_LITTLE)) return "is big-endian";
  int major = 0, minor = 0;
  if (std::sscanf(info.version.c_str(), "OpenCL %d.%d", &major, &minor) != 2 ||
      major * 10 + minor < 12) {
    return fmt::format("has '{}', photile needs OpenCL 1.2", info.version);
  }
  return {};
}

DeviceInfo describe_part(const DeviceInfo& whole, std::size_t part, std::size_t part_count,
                         cl_device_id device) {
  DeviceInfo info = whole;
  info.id = fmt::format("{}.{}", whole.id, part);
  info.parent = whole.id;
  info.compute_units = device_property<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS);
  info.global_memory_bytes = whole.global_memory_bytes / part_count;
  info.max_allocation_bytes = std::min(whole.max_allocation_bytes, info.global_memory_bytes);
  return info;
}

std::vector<cl_device_id> devices_of(cl_platform_id platform) {
  cl_uint count = 0;
  // CL_DEVICE_NOT_FOUND is the usual answer of a platform without devices, but some fail otherwise:
  // none of that is a reason to stop.
  if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count) != CL_SUCCESS) return {};
  std::vector<cl_device_id> devices(count);
  if (count == 0 ||
      clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, devices.data(), nullptr) != CL_SUCCESS) {
    return {};
  }
  return devices;
}

std::vector<cl_platform_id> platforms() {
  cl_uint count = 0;
  const cl_int status = clGetPlatformIDs(0, nullptr, &count);
  if (status == no_platform || (status == CL_SUCCESS && count == 0)) return {};
  check(status, "clGetPlatformIDs");
  std::vector<cl_platform_id> found(count);
  check(clGetPlatformIDs(count, found.data(), nullptr), "clGetPlatformIDs");
  return found;
}

/// Intel's runtime for CPUs would put several work-items into one vector, beside the vectors that
/// kernels hold, and builds wrong photon maps that way (docs/kernels/runtimes.md). Call before the
/// first OpenCL call. What the user set stays.
void keep_intel_from_vectorizing() { ::setenv("CL_CONFIG_CPU_VECTORIZER_MODE", "1", 0); }

/// PoCL aborts where it cannot start a thread, and where its number of threads is not a number.
/// Call before the first OpenCL call.
void bound_pocl_threads() {
  int threads = core_count();
  for (const char* variable : pocl_thread_variables) {
    const char* const text = std::getenv(variable);
    if (text == nullptr) continue;
    const int asked = std::atoi(text);
    if (asked > 0) threads = std::min(threads, asked);
    ::setenv(variable, std::to_string(threads).c_str(), 1);
  }
  static const bool enough = (require_threads(threads), true);  // once: later, PoCL has its threads
  static_cast<void>(enough);
}

/// The dynamic linker's message for each runtime that is registered and cannot be loaded.
std::vector<std::string> unloadable_runtimes() {
  const char* const given = std::getenv("OCL_ICD_VENDORS");
  const std::filesystem::path folder = given ? given : "/etc/OpenCL/vendors";
  std::vector<std::string> lines;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    std::string library;
    if (entry.path().extension() != ".icd") continue;
    if (!std::getline(std::ifstream(entry.path()), library)) continue;
    void* const loaded = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (loaded) {
      dlclose(loaded);
    } else {
      lines.push_back(entry.path().filename().string() + ": " + dlerror());
    }
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

/// PoCL's compiler hangs where its memory ends: an exception leaves its locks held.
void require_address_space() {
  const std::uint64_t left = address_bytes_left();
  if (left >= reserved_address_bytes) return;
  throw DeviceMemoryError(
      fmt::format("{} MiB of address space are left, but the compiler of a device takes up to {}; "
                  "raise its limit (ulimit -v)",
                  left >> 20, reserved_address_bytes >> 20));
}

/// Compilers of devices take a file that they cannot write for a kernel that does not build, or
/// abort.
void require_file_size() {
  constexpr rlim_t least = 16 << 20;
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur >= least) return;
  throw DeviceError(
      fmt::format("a file may have {} kB, but the compiler of a device writes up to {}; raise the "
                  "limit (ulimit -f)",
                  limit.rlim_cur >> 10, least >> 10));
}

}  // namespace

DeviceList enumerate_devices() {
  require_address_space();
  require_file_size();
  bound_pocl_threads();
  pocl_work_folder();
  keep_intel_from_vectorizing();
  DeviceList list;
  const auto found = platforms();
  if (found.empty()) list.left_out = unloadable_runtimes();
  for (std::size_t p = 0; p < found.size(); ++p) {
    const auto devices = devices_of(found[p]);
    if (devices.empty()) {
      list.left_out.push_back(platform_text(found[p], CL_PLATFORM_NAME) + ": has no devices");
    }
    for (std::size_t d = 0; d < devices.size(); ++d) {
      ListedDevice listed{describe(found[p], devices[d]), found[p], devices[d]};
      listed.info.id = fmt::format("{}:{}", p, d);
      if (const auto reason = refusal(listed.info, devices[d]); !reason.empty()) {
        list.left_out.push_back(listed.info.name + ": " + reason);
      } else {
        list.usable.push_back(std::move(listed));
      }
    }
  }
  return list;
}

std::vector<ListedDevice> make_sub_devices(const ListedDevice& whole,
                                           std::span<const std::uint32_t> compute_units) {
  // Equal parts are asked for by their counts as well: CL_DEVICE_PARTITION_EQUALLY makes as many of
  // a size as there are, and leaves out what remains.
  std::vector<cl_device_partition_property> properties{CL_DEVICE_PARTITION_BY_COUNTS};
  properties.insert(properties.end(), compute_units.begin(), compute_units.end());
  properties.insert(properties.end(), {CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0});
  std::vector<cl_device_id> devices(compute_units.size());
  cl_uint made = 0;
  check(clCreateSubDevices(whole.device, properties.data(), static_cast<cl_uint>(devices.size()),
                           devices.data(), &made),
        "clCreateSubDevices",
        fmt::format("{} of the {} compute units of {} '{}'; select the whole device",
                    fmt::join(compute_units, " + "), whole.info.compute_units, whole.info.id,
                    whole.info.name));
  std::vector<ListedDevice> parts;
  for (std::size_t i = 0; i < made; ++i) {
    SubDeviceHandle owner(devices[i]);
    parts.push_back({describe_part(whole.info, i, made, devices[i]), whole.platform, devices[i],
                     std::move(owner)});
  }
  return parts;
}

}  // namespace photile::device

namespace photile {

std::string_view name_of(DeviceType type) {
  return name_in({"cpu", "gpu", "accelerator", "other"}, type);
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> devices;
  for (auto& listed : device::enumerate_devices().usable) {
    devices.push_back(std::move(listed.info));
  }
  return devices;
}

}  // namespace photile

namespace photile {

Device::Device(const DeviceOptions& options)
    : context_(std::make_unique<device::Context>(options)) {}
Device::Device(std::unique_ptr<device::Context> context) : context_(std::move(context)) {}

device::Context& device::context_of(Device& device) { return *device.context_; }
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

const DeviceInfo& Device::info() const { return context_->info(); }
double Device::compile_seconds() const { return context_->compile_seconds(); }
std::uint64_t Device::programs_built() const { return context_->programs_built(); }
std::uint64_t Device::programs_from_cache() const { return context_->programs_from_cache(); }
std::uint64_t Device::peak_allocated_bytes() const { return context_->peak_allocated_bytes(); }

std::vector<Device> open_devices(const DeviceOptions& options) {
  std::vector<Device> devices;
  for (auto& context : device::Context::open_all(options)) {
    devices.push_back(Device(std::move(context)));
  }
  return devices;
}

}  // namespace photile
