// The interface of C over PhotonCloud's.
#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/glm.hpp>
#include <new>
#include <span>
#include <string>

#include "photile/device.hpp"
#include "photile/errors.hpp"
#include "photile/neighbours.h"
#include "photile/photon_cloud.hpp"

struct photile_device {
  photile::Device device;
};

namespace photile {
namespace {

std::string& last_error() {
  static thread_local std::string text;
  return text;
}

/// Does work of C's functions; what it throws becomes a status, and its message the last error.
template <class Work>
photile_status status_of(const Work& work) noexcept {
  const auto failed = [](photile_status status, const char* message) noexcept {
    try {
      last_error() = message;
    } catch (...) {
      last_error().clear();
    }
    return status;
  };
  try {
    work();
    return PHOTILE_OK;
  } catch (const DeviceMemoryError& error) {
    return failed(PHOTILE_OUT_OF_MEMORY, error.what());
  } catch (const DeviceError& error) {
    return failed(PHOTILE_DEVICE_ERROR, error.what());
  } catch (const InputError& error) {
    return failed(PHOTILE_BAD_INPUT, error.what());
  } catch (const UsageError& error) {
    return failed(PHOTILE_BAD_INPUT, error.what());
  } catch (const std::bad_alloc&) {
    return failed(PHOTILE_OUT_OF_MEMORY, "neighbours: not enough memory");
  } catch (const std::exception& error) {
    return failed(PHOTILE_INTERNAL_ERROR, error.what());
  } catch (...) {
    return failed(PHOTILE_INTERNAL_ERROR, "neighbours: an unknown exception");
  }
}

std::span<const glm::vec3> places_of(const float* coordinates, std::size_t count) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  if (count > 0 && coordinates == nullptr) {
    throw UsageError("neighbours: the coordinates are a null pointer");
  }
  return {reinterpret_cast<const glm::vec3*>(coordinates), count};
}

}  // namespace
}  // namespace photile

const char* photile_last_error(void) { return photile::last_error().c_str(); }

photile_status photile_open_device(const char* selector, photile_device** device) {
  return photile::status_of([&] {
    if (device == nullptr) throw photile::UsageError("device: the result is a null pointer");
    *device = nullptr;
    *device =
        new photile_device{photile::Device({.selector = selector == nullptr ? "" : selector})};
  });
}

void photile_close_device(photile_device* device) { delete device; }

photile_status photile_find_neighbours(photile_device* device, const float* points,
                                       size_t point_count, const float* queries, size_t query_count,
                                       int k, float max_distance, uint32_t* indices,
                                       float* distances) {
  return photile::status_of([&] {
    if (device == nullptr || indices == nullptr) {
      throw photile::UsageError("neighbours: the device or the indices are a null pointer");
    }
    const photile::CloudNeighbours found = photile::find_neighbours(
        device->device, {.points = photile::places_of(points, point_count),
                         .queries = photile::places_of(queries, query_count),
                         .k = k,
                         .max_distance = max_distance});
    std::replace_copy(found.photons.begin(), found.photons.end(), indices, photile::none,
                      static_cast<std::uint32_t>(point_count));
    if (distances == nullptr) return;
    std::transform(found.squared_distance.begin(), found.squared_distance.end(), distances,
                   [](float squared) { return std::sqrt(squared); });
  });
}
