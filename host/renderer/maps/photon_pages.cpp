#include "maps/photon_pages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

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

PhotonRange with_maps(const CandidateMaps& candidates, std::uint32_t first, std::uint32_t last,
                      std::uint64_t first_member, std::uint64_t last_member) {
  if (first_member == last_member) return {first, last, 0, 0};
  const auto members = candidates.members.begin();
  const auto [least, most] =
      std::minmax_element(members + static_cast<std::ptrdiff_t>(first_member),
                          members + static_cast<std::ptrdiff_t>(last_member));
  return {first, last, *least, *most + 1};
}

}  // namespace

std::vector<PhotonRange> plan_photon_pages(const Photons& photons, const CandidateMaps& candidates,
                                           std::uint64_t max_bytes) {
  // Kernels index three floats of a photon, and the members of lists, in 32 bits.
  constexpr std::uint64_t most_indices = std::numeric_limits<std::uint32_t>::max();
  const std::uint64_t max_photons =
      std::clamp<std::uint64_t>(max_bytes / bytes_per_photon, 1, most_indices / 3);
  const std::uint64_t max_members =
      std::clamp<std::uint64_t>(max_bytes / sizeof(std::uint32_t), 2, most_indices) - 1;
  const auto first_member_of = [&](std::uint32_t map) {
    return candidates.offsets[candidates.first_list_of[map]];
  };
  const auto total = static_cast<std::uint32_t>(photons.size());
  std::vector<PhotonRange> pages;
  for (std::uint32_t first = 0; first < total;) {
    const std::uint32_t first_map = photons.oriented_face[first];
    const std::uint64_t most = std::min<std::uint64_t>(total, first + max_photons);
    // The last oriented face whose lists still fit.
    std::uint32_t end_map = photons.oriented_face[most - 1] + 1;
    while (end_map > first_map &&
           first_member_of(end_map) - first_member_of(first_map) > max_members) {
      --end_map;
    }
    if (end_map == first_map) {
      end_map = first_map + 1;
      const std::uint64_t members = first_member_of(end_map) - first_member_of(first_map);
      if (members >= most_indices) {
        throw DeviceError(
            fmt::format("the photons of triangle {} may enter {} maps, more than 32 bits can "
                        "count; use a smaller radius",
                        triangle_of(first_map), members));
      }
    }
    const std::uint64_t last = std::min<std::uint64_t>(most, photons.first_of[end_map]);
    pages.push_back(with_maps(candidates, first, static_cast<std::uint32_t>(last),
                              first_member_of(first_map), first_member_of(end_map)));
    first = static_cast<std::uint32_t>(last);
  }
  return pages;
}

PhotonPage upload_photon_records(device::Context& context, const Photons& photons,
                                 PhotonRange range) {
  PhotonPage page;
  page.first_photon = range.first;
  page.count = range.last - range.first;
  page.position = context.share(floats(photons.position, range), "photon positions",
                                device::SharedMemory::counted);
  page.oriented_face = context.share(part(photons.oriented_face, range), "photons' triangles",
                                     device::SharedMemory::counted);
  page.flux =
      context.share(floats(photons.flux, range), "photon flux", device::SharedMemory::counted);
  page.light =
      context.share(part(photons.light, range), "photon lights", device::SharedMemory::counted);
  page.incoming = context.share(floats(photons.incoming, range), "photon directions",
                                device::SharedMemory::counted);
  return page;
}

PhotonPage upload_photon_page(device::Context& context, const Photons& photons,
                              const CandidateMaps& candidates, PhotonRange range) {
  PhotonPage page = upload_photon_records(context, photons, range);
  const std::uint64_t first_list = candidates.first_list_of[photons.oriented_face[range.first]];
  const std::uint64_t end_list =
      candidates.first_list_of[photons.oriented_face[range.last - 1] + 1];
  const std::uint64_t first_member = candidates.offsets[first_list];
  page.first_list = static_cast<std::uint32_t>(first_list);
  std::vector<std::uint32_t> offsets(end_list - first_list + 1);
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    offsets[i] = static_cast<std::uint32_t>(candidates.offsets[first_list + i] - first_member);
  }
  page.list = context.share(part(candidates.list_of_photon, range), "candidate lists of photons",
                            device::SharedMemory::counted);
  page.list_offsets =
      context.upload(std::span<const std::uint32_t>(offsets), "candidate list offsets");
  page.list_members = context.share(
      std::span<const std::uint32_t>(candidates.members.data() + first_member, offsets.back()),
      "candidate maps", device::SharedMemory::counted);
  return page;
}

PhotonPages::PhotonPages(device::Context& context, Plan plan, Upload upload,
                         std::uint64_t max_bytes)
    : Residents(context),
      plan_(std::move(plan)),
      upload_(std::move(upload)),
      max_bytes_(max_bytes),
      ranges_(plan_(max_bytes)),
      pages_(ranges_.size()) {}

std::uint64_t PhotonPages::largest_array() const {
  std::uint64_t largest = 0;
  for (const PhotonRange& range : ranges_) {
    largest = std::max<std::uint64_t>(largest, bytes_per_photon * (range.last - range.first));
  }
  return largest;
}

std::uint64_t PhotonPages::page_bytes() const {
  constexpr std::uint64_t arrays = 4;  // positions, flux, and smaller ones
  return arrays * largest_array();
}

void PhotonPages::load(std::size_t page) {
  if (released_) throw DeviceMemoryError("photons were released before their maps were built");
  pages_[page] = upload_(ranges_[page]);
}

void PhotonPages::release_lists() {
  PhotonPage& page = pages_.front();
  for (auto* lists : {&page.list, &page.list_offsets, &page.list_members, &page.inserted}) {
    *lists = {};
  }
  released_ = true;
}

void PhotonPages::release_records() {
  PhotonPage& page = pages_.front();
  for (auto* records : {&page.position, &page.flux, &page.incoming}) *records = {};
  page.light = {};
  released_ = true;
}

bool PhotonPages::halve() {
  constexpr std::uint64_t least_bytes = 4096;
  const std::uint64_t largest = largest_array();
  if (largest < 2 * least_bytes) return false;
  release();
  while (reclaim()) {
  }
  max_bytes_ = largest / 2;
  ranges_ = plan_(max_bytes_);
  pages_ = std::vector<PhotonPage>(ranges_.size());
  return true;
}

}  // namespace photile::maps
