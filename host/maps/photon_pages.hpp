// Photons and the maps they may enter on the device, in pages for the build.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "device/context.hpp"
#include "maps/candidate_maps.hpp"
#include "photile/patches.hpp"
#include "photile/photons.hpp"

namespace photile::maps {

/// Photons [first_photon, first_photon + count) with their candidate maps.
struct PhotonPage {
  std::uint32_t first_photon = 0;
  std::uint32_t count = 0;

  device::Buffer<float> position;  ///< 3 per photon
  device::Buffer<std::uint32_t> own_map;       ///< of the photon's sided triangle
  device::Buffer<float> flux;                  ///< 3 per photon
  device::Buffer<std::uint16_t> light;         ///< empty for a single light
  device::Buffer<float> incoming;              ///< 3 per photon; empty unless glossy
  device::Buffer<float> normal;                ///< 3 per photon: of its sided triangle; or empty
  device::Buffer<std::uint32_t> list;          ///< of each photon, relative to the page's first
  device::Buffer<std::uint32_t> list_offsets;  ///< relative to the page's first member
  device::Buffer<std::uint32_t> list_members;
};

/// The bounds of one page: photons [first, last).
struct PhotonRange {
  std::uint32_t first = 0, last = 0;
};

/// Splits photons so that no buffer of a page is larger than `max_bytes`.
/// Errors: DeviceError when the lists of a single sided triangle alone are larger.
std::vector<PhotonRange> plan_photon_pages(const Photons& photons, const CandidateMaps& candidates,
                                           std::uint64_t max_bytes);

/// Records only, without candidate maps.
///   normals   per sided triangle, where maps need them; else empty
PhotonPage upload_photon_records(device::Context& context, const Photons& photons,
                                 std::span<const glm::vec3> normals, const Patches& patches,
                                 PhotonRange range);

PhotonPage upload_photon_page(device::Context& context, const Photons& photons,
                              std::span<const glm::vec3> normals, const Patches& patches,
                              const CandidateMaps& candidates, PhotonRange range);

}  // namespace photile::maps
