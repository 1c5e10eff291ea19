// OpenCL devices and how a user chooses them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace photile {

enum class DeviceType { cpu, gpu, accelerator, other };

/// "cpu", "gpu", "accelerator", "other".
std::string_view name_of(DeviceType type);

struct DeviceInfo {
  std::string id;      ///< "platform:device", e.g. "0:0"; of a sub-device "0:0.0", "0:0.1", ...
  std::string parent;  ///< id of the device that this is a sub-device of; "" = a whole device
  std::string name;
  std::string platform;
  std::string vendor;
  std::string version;  ///< OpenCL version string of the device
  std::string driver_version;
  std::string platform_version;
  DeviceType type = DeviceType::other;
  std::uint32_t compute_units = 0;
  std::uint32_t clock_mhz = 0;  ///< the highest, as the device reports
  std::string extensions;       ///< names, separated by spaces
  std::uint64_t global_memory_bytes = 0;
  std::uint64_t max_allocation_bytes = 0;  ///< largest single buffer
  std::uint64_t local_memory_bytes = 0;
  std::uint64_t max_work_group_size = 0;
  std::uint32_t native_float_width = 0;  ///< the device's native vector width for float
  std::uint32_t lanes = 0;  ///< work-items that it runs in lockstep, where it reports them; else 0
  /// Work-items that it runs in lockstep can read each other's registers by instructions that the
  /// kernels use: those of NVIDIA's processors of compute capability 8.0 and later, or sub-groups
  /// of a requested size, as Intel's runtimes offer.
  bool shuffles = false;
  /// Single-precision numbers below 1.2e-38 are kept, and quotients and roots are correctly
  /// rounded. Without these, only the last bits of results are wrong.
  bool denormals = false, exact_division = false;
  bool is_pocl = false;
  /// The result of the last test of this device, with this driver and these kernels: "passed", what
  /// was found wrong, or "" where none is remembered; see test_device.
  std::string test_result;
};

/// Every usable device of every platform. A platform without devices is skipped; no platform at all
/// gives an empty list.
std::vector<DeviceInfo> list_devices();

struct DeviceOptions {
  /// "" = the best (a GPU that has passed its test before PoCL before other CPUs); else
  /// "platform:device", an index into list_devices(), "cpu", "gpu", or a part of the device's or
  /// platform's name. A suffix takes sub-devices in place of the whole: "cpu/2" splits it into two
  /// of equal size, "cpu=3" is one of 3 compute units, "cpu=2+1" takes two. Several, separated by
  /// commas, or "all" (every device but Oclgrind's simulator) are for open_devices.
  std::string selector;
  bool use_program_cache = true;
  bool profile = false;            ///< keep event times of every kernel
  std::uint64_t memory_bytes = 0;  ///< bound of all live buffers together; 0 = the device's memory
};

class Device;
namespace device {
class Context;
Context& context_of(Device& device);
}  // namespace device

/// An open device: context, queue and program cache. Movable.
class Device {
 public:
  /// Errors: DeviceError when there is no device, none matches the selector (the message lists the
  /// devices), or the selector means several.
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const DeviceInfo& info() const;
  double compile_seconds() const;  ///< spent building programs so far
  std::uint64_t programs_built() const;
  std::uint64_t programs_from_cache() const;
  std::uint64_t peak_allocated_bytes()
      const;  ///< the most that live buffers have taken together so far

 private:
  friend std::vector<Device> open_devices(const DeviceOptions& options);
  friend device::Context& device::context_of(Device& device);
  explicit Device(std::unique_ptr<device::Context> context);

  std::unique_ptr<device::Context> context_;
};

/// Opens every device that the selector means, in its order; never none. Errors: DeviceError as for
/// Device, when a device is named twice, or cannot be split as asked for.
std::vector<Device> open_devices(const DeviceOptions& options = {});

/// Builds photon maps of 20,000 uniform photons on a square metre and asks the device for the 50
/// nearest of a thousand hits and for their irradiance. Both are compared with a search of all
/// photons in double precision, and the mean irradiance with that for which the photons were made.
/// Takes seconds, most of them for compiling kernels. Returns "" where all agree, else one line
/// about what does not; an error of the device is returned as such a line, too.
std::string test_device(Device& device);

/// Tests the device, as test_device does, and keeps the result for later runs
/// (DeviceInfo::test_result).
std::string test_device_and_remember(Device& device);

}  // namespace photile
