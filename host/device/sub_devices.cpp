#include "device/sub_devices.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace photile::device {
namespace {

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

}  // namespace

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
        fmt::format("{} of the {} compute units of {} '{}'; choose the whole device",
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
