#include <algorithm>
#include <bit>
#include <limits>

#include "device/launch_pace.hpp"
#include "estimate/query.hpp"
#include "maps/entry_defines.hpp"
#include "structures/structure_arguments.hpp"

namespace photile::estimate {
namespace {

/// Largest k whose list is kept in private memory.
constexpr std::uint32_t private_list_limit = 256;
/// Most bytes of lists in global memory, for larger k: bounds the work-items in flight. An eighth
/// of the memory where that is less.
constexpr std::uint64_t global_list_bytes = 64u << 20;

class StructureQuery : public Query {
 public:
  StructureQuery(const maps::MapStore& store, const QueryParameters& parameters)
      : store_(store),
        context_(device::context_of(*store.device)),
        pace_(context_),
        parameters_(parameters),
        file_(maps::kernel_file(store.parameters.structure)),
        sums_(store.needs, parameters.compiled_neighbours) {
    const std::uint32_t neighbours = parameters.neighbours;
    const std::uint32_t compiled_neighbours = parameters.compiled_neighbours;
    if (store.parameters.structure == MapStructure::kdtree_2d) defines_.set("TREE_2D");
    if (compiled_neighbours <= private_list_limit) {
      // Few sizes, so that few programs are compiled.
      defines_.set("LIST_CAPACITY",
                   static_cast<long long>(std::bit_ceil(std::max(compiled_neighbours, 16u))));
    } else {
      constexpr std::uint64_t group = maps::work_group_size;
      const std::uint64_t bytes_per_item = std::uint64_t{neighbours} * 8;
      const std::uint64_t bytes = std::min(global_list_bytes, context_.memory_limit() / 8);
      work_items_ = std::max(group, bytes / bytes_per_item / group * group);
      list_distance_ = context_.allocate<float>(work_items_ * neighbours, "candidate lists");
      list_entry_ = context_.allocate<std::uint32_t>(work_items_ * neighbours, "candidate lists");
    }
  }

  const LightSums& sums() const override { return sums_; }

  void estimate(const PageHits& hits, EstimateBuffers& estimates) override {
    device::Defines defines = page_defines(hits.page);
    maps::set_entry_defines(defines, store_.needs);
    sums_.set_defines(defines);
    if (store_.needs.normal_maps) defines.set("NORMAL_MAPS");
    set_density_defines(defines, parameters_.surface != nullptr, parameters_.kernel);
    device::Launch launch(context_, context_.kernel(file_, "estimate_by_list", defines));
    set_estimate_arguments(launch, hits, parameters_, estimates);
    run(launch, hits);
  }

  void nearest(const PageHits& hits, device::Buffer<std::uint32_t>& photons,
               device::Buffer<float>& squared_radius) override {
    device::Launch launch(context_,
                          context_.kernel(file_, "nearest_by_list", page_defines(hits.page)));
    set_page_arguments(launch, hits);
    launch.set("neighbours", photons)
        .set("squared_radius", squared_radius)
        .set("visits", device::Buffer<std::uint32_t>());
    run(launch, hits);
  }

 private:
  device::Defines page_defines(const maps::MapPage& page) const {
    device::Defines defines = defines_;
    if (page.entry_normal.size() > 0) defines.set("NORMALS");
    return defines;
  }

  /// With the arguments of the structure.
  void run(device::Launch& launch, const PageHits& hits) {
    maps::set_structure_arguments(launch, hits.page);
    launch.set("list_distance", list_distance_).set("list_entry", list_entry_);
    PhotileQuery query = query_of(store_, hits, parameters_);
    pace_.run(hits.count, 1, [&](std::uint32_t first, std::uint32_t count) {
      query.first_hit = hits.first + first;
      query.hit_count = count;
      launch.set("query", query);
      launch.run_no_more(std::min<std::size_t>(count, work_items_), maps::work_group_size);
    });
  }

  const maps::MapStore& store_;
  device::Context& context_;
  device::LaunchPace pace_;
  QueryParameters parameters_;
  const char* file_;
  LightSums sums_;
  device::Defines defines_;
  std::uint64_t work_items_ = std::numeric_limits<std::uint32_t>::max();
  device::Buffer<float> list_distance_;
  device::Buffer<std::uint32_t> list_entry_;
};

}  // namespace

std::unique_ptr<Query> make_structure_query(const maps::MapStore& store,
                                            const QueryParameters& parameters) {
  return std::make_unique<StructureQuery>(store, parameters);
}

std::unique_ptr<Query> make_query(const maps::MapStore& store, const QueryParameters& parameters) {
  switch (store.parameters.structure) {
    case MapStructure::uniform_grid:
    case MapStructure::brute_force:
      return make_grid_query(store, parameters);
    default:
      return make_structure_query(store, parameters);
  }
}

}  // namespace photile::estimate
