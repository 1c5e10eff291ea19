// Queries on maps in another structure than the grid.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>

#include "device/launch.hpp"
#include "estimate/query.hpp"
#include "estimate/specialisation.hpp"
#include "maps/map_page.hpp"
#include "structures/structure.hpp"

namespace photile::structures {

/// By the first map of the page whose photons they index.
using Indices = std::map<std::uint32_t, Index>;

/// The kernels of kernels/structures/kernels.clh for one k and radius.
class StructureQuery final : public estimate::Query {
 public:
  /// References are kept.
  StructureQuery(const Structure& structure, std::shared_ptr<const Indices> indices,
                 const maps::MapStore& store, const estimate::QueryParameters& parameters);

  const estimate::LightSums& sums() const override { return sums_; }
  void estimate(const estimate::PageHits& hits, estimate::EstimateBuffers& estimates) override;
  void nearest(const estimate::PageHits& hits, device::Buffer<std::uint32_t>& photons,
               device::Buffer<float>& squared_radius) override;

  /// What searches look at, by kernels that count it. After: two numbers a hit, of nodes or cells
  /// and of photons. `photons`, `squared_radius`: as `nearest`.
  void count_visits(const estimate::PageHits& hits, device::Buffer<std::uint32_t>& photons,
                    device::Buffer<float>& squared_radius, device::Buffer<std::uint32_t>& visits);

 private:
  /// Bounds the work-items in flight by the memory that each has for itself.
  void limit_items(std::uint64_t words_per_item);
  void set_page_defines(device::Defines& defines, const maps::MapPage& page) const;
  void run_nearest(const estimate::PageHits& hits, device::Defines defines,
                   device::Buffer<std::uint32_t>& photons, device::Buffer<float>& squared_radius,
                   const device::Buffer<std::uint32_t>& visits);
  /// With the arguments of the structure.
  void run(device::Launch& launch, const estimate::PageHits& hits, int hits_per_item = 1,
           std::size_t work_group_size = maps::work_group_size);

  const Structure& structure_;
  std::shared_ptr<const Indices> indices_;
  const maps::MapStore& store_;
  device::Context& context_;
  device::LaunchPace pace_;
  estimate::QueryParameters parameters_;
  estimate::LightSums sums_;
  std::uint64_t work_items_ = std::numeric_limits<std::uint32_t>::max();
  device::Buffer<float> list_distance_;
  device::Buffer<std::uint32_t> list_record_;
  // Where the selection is the grid's:
  std::optional<estimate::Specialisation> by_radix_;
  device::Buffer<std::uint32_t> words_;
};

}  // namespace photile::structures
