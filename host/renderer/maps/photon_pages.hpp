// Photons and the maps they may enter on the device, in pages for the build.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "device/context.hpp"
#include "maps/candidate_maps.hpp"
#include "maps/resident_maps.hpp"
#include "photile/photons.hpp"
#include "photile/scene.hpp"

namespace photile::maps {

/// Photons [first_photon, first_photon + count) with their candidate maps.
struct PhotonPage {
  std::uint32_t first_photon = 0;
  std::uint32_t count = 0;

  device::Buffer<float> position;  ///< 3 per photon
  device::Buffer<std::uint32_t> oriented_face;
  device::Buffer<float> flux;                  ///< 3 per photon
  device::Buffer<std::uint16_t> light;         ///< empty for a single light
  device::Buffer<float> incoming;              ///< 3 per photon; empty unless glossy
  device::Buffer<std::uint32_t> list;          ///< of each photon, among all lists
  std::uint32_t first_list = 0;                ///< the page's first
  device::Buffer<std::uint32_t> list_offsets;  ///< relative to the page's first list and member
  device::Buffer<std::uint32_t> list_members;
  device::Buffer<std::uint32_t> inserted;  ///< kernels/grid/count_photons.cl, find_insertions
};

/// The bounds of one page: photons [first, last), which enter maps of [first_map, last_map) at
/// most.
struct PhotonRange {
  std::uint32_t first = 0, last = 0;
  std::uint32_t first_map = 0, last_map = none;

  bool may_enter(std::uint32_t first_of_maps, std::uint32_t last_of_maps) const {
    return first_map < last_of_maps && first_of_maps < last_map;
  }
};

/// Splits photons so that no buffer of a page is larger than `max_bytes`, except where the lists of
/// a single oriented face are larger. Errors: DeviceError when these exceed 32 bits.
std::vector<PhotonRange> plan_photon_pages(const Photons& photons, const CandidateMaps& candidates,
                                           std::uint64_t max_bytes);

/// Records only, without candidate maps. Photons must stay as they are for the life of the page.
PhotonPage upload_photon_records(device::Context& context, const Photons& photons,
                                 PhotonRange range);

/// Uploads the lists of candidate maps as well, which must stay, too; `inserted` is not uploaded.
PhotonPage upload_photon_page(device::Context& context, const Photons& photons,
                              const CandidateMaps& candidates, PhotonRange range);

/// The photons of a build, page by page: on the device while there is memory, otherwise uploaded
/// again when they are used.
class PhotonPages final : private Residents {
 public:
  using Plan = std::function<std::vector<PhotonRange>(std::uint64_t max_bytes)>;
  using Upload = std::function<PhotonPage(PhotonRange range)>;

  /// `max_bytes`: of any buffer, for the plan.
  PhotonPages(device::Context& context, Plan plan, Upload upload, std::uint64_t max_bytes);

  /// Calls visit(page) for each. Errors: DeviceMemoryError, as visit().
  template <class Visit>
  void for_each(const Visit& visit) {
    for_each_entering(0, none, visit);
  }
  /// The same for pages whose photons may be in maps of [first_map, last_map).
  template <class Visit>
  void for_each_entering(std::uint32_t first_map, std::uint32_t last_map, const Visit& visit) {
    for (std::size_t i = 0; i < pages_.size(); ++i) {
      if (!ranges_[i].may_enter(first_map, last_map)) continue;
      use(i);
      visit(std::as_const(pages_[i]));
      release();
    }
  }

  /// Device memory that the largest page takes, about.
  std::uint64_t page_bytes() const;

  /// Whether one page holds all photons.
  bool single() const { return ranges_.size() == 1; }
  /// Release parts of the only page: lists and `inserted`; all else but oriented_face. It cannot be
  /// uploaded again afterwards.
  void release_lists();
  void release_records();
  bool released() const { return released_; }

  /// Smaller pages from now on. False where they are already as small as is useful.
  bool halve();

 private:
  std::uint64_t largest_array() const;
  void load(std::size_t page) override;
  void unload(std::size_t page) override { pages_[page] = {}; }

  Plan plan_;
  Upload upload_;
  std::uint64_t max_bytes_;
  std::vector<PhotonRange> ranges_;
  std::vector<PhotonPage> pages_;
  bool released_ = false;
};

}  // namespace photile::maps
