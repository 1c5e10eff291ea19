#include "maps/photon_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace photile::maps {
namespace {

constexpr std::uint64_t bytes_per_photon = 3 * sizeof(float);  // of the largest array

std::span<const float> floats(const std::vector<glm::vec3>& values, PhotonRange range) {
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  if (values.empty()) return {};
  return {&values[range.first].x, 3 * std::size_t{range.last - range.first}};
}

template <class T>
std::span<const T> part(const std::vector<T>& values, PhotonRange range) {
  if (values.empty()) return {};
  return {values.data() + range.first, std::size_t{range.last - range.first}};
}

}  // namespace

std::vector<PhotonRange> plan_photon_pages(const Photons& photons, const NeighbourGroups& groups,
                                           std::uint64_t max_bytes) {
  const std::uint64_t max_photons = std::max<std::uint64_t>(1, max_bytes / bytes_per_photon);
  const std::uint64_t max_members = std::min<std::uint64_t>(
      max_bytes / sizeof(std::uint32_t) - 1, std::numeric_limits<std::uint32_t>::max() - 1);
  const auto total = static_cast<std::uint32_t>(photons.size());
  std::vector<PhotonRange> pages;
  for (std::uint32_t first = 0; first < total;) {
    const std::uint32_t first_map = photons.sided_triangle[first];
    // The groups of [first_map, end_map) fit in one buffer, and so do their offsets.
    const auto begin = groups.offsets.begin() + first_map;
    const auto end = std::upper_bound(begin, groups.offsets.end(), *begin + max_members);
    const auto end_map = static_cast<std::uint32_t>(
        first_map +
        std::min<std::uint64_t>(static_cast<std::uint64_t>(end - begin) - 1, max_members));
    if (end_map == first_map) {
      throw DeviceError(fmt::format(
          "the neighbour group of triangle {} has {} members, more than the device's largest "
          "buffer holds; use a smaller radius",
          triangle_of(first_map), groups.of(first_map).size()));
    }
    const std::uint64_t last =
        std::min<std::uint64_t>(photons.first_of[end_map], first + max_photons);
    pages.push_back({first, static_cast<std::uint32_t>(last)});
    first = static_cast<std::uint32_t>(last);
  }
  return pages;
}

PhotonPage upload_photon_page(device::Context& context, const Photons& photons,
                              const NeighbourGroups& groups, PhotonRange range) {
  PhotonPage page;
  page.first_photon = range.first;
  page.count = range.last - range.first;
  page.first_group = photons.sided_triangle[range.first];
  const std::uint32_t last_group = photons.sided_triangle[range.last - 1];

  page.position = context.upload(floats(photons.position, range), "photon positions");
  page.own_map = context.upload(part(photons.sided_triangle, range), "photon triangles");
  page.flux = context.upload(floats(photons.flux, range), "photon flux");
  page.light = context.upload(part(photons.light, range), "photon lights");
  page.incoming = context.upload(floats(photons.incoming, range), "photon directions");

  const std::uint64_t first_member = groups.offsets[page.first_group];
  std::vector<std::uint32_t> offsets(last_group - page.first_group + 2);
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    offsets[i] = static_cast<std::uint32_t>(groups.offsets[page.first_group + i] - first_member);
  }
  page.group_offsets =
      context.upload(std::span<const std::uint32_t>(offsets), "neighbour group offsets");
  page.group_members = context.upload(
      std::span<const std::uint32_t>(groups.members.data() + first_member, offsets.back()),
      "neighbour group members");
  return page;
}

}  // namespace photile::maps
