#include "structures/structure_query.hpp"

#include <algorithm>
#include <bit>

#include "maps/map_page.hpp"

namespace photile::structures {
namespace {

/// Largest k whose list is kept in private memory.
constexpr std::uint32_t private_list_limit = 256;
/// Most bytes of lists in global memory, for larger k: bounds the work-items in flight. An eighth
/// of the memory where that is less.
constexpr std::uint64_t global_list_bytes = 64u << 20;

}  // namespace

StructureQuery::StructureQuery(const Structure& structure, std::shared_ptr<const Indices> indices,
                               const maps::MapStore& store,
                               const estimate::QueryParameters& parameters)
    : indices_(std::move(indices)),
      store_(store),
      context_(device::context_of(*store.device)),
      pace_(context_),
      parameters_(parameters),
      file_(structure.kernel_file()),
      sums_(store.needs, parameters.compiled_neighbours) {
  const std::uint32_t neighbours = parameters.neighbours;
  const std::uint32_t compiled_neighbours = parameters.compiled_neighbours;
  if (!structure.symbol.empty()) defines_.set(structure.symbol);
  if (structure.global) defines_.set("ONE_LIST");
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
    list_record_ = context_.allocate<std::uint32_t>(work_items_ * neighbours, "candidate lists");
  }
}

void StructureQuery::estimate(const estimate::PageHits& hits,
                              estimate::EstimateBuffers& estimates) {
  device::Defines defines = page_defines(hits.page);
  maps::set_record_defines(defines, store_.needs);
  sums_.set_defines(defines);
  if (store_.needs.normal_maps) defines.set("NORMAL_MAPS");
  estimate::set_density_defines(defines, parameters_.surface != nullptr, parameters_.kernel);
  device::Launch launch(context_, context_.kernel(file_, "estimate_by_list", defines));
  estimate::set_estimate_arguments(launch, hits, parameters_, estimates);
  run(launch, hits);
}

void StructureQuery::nearest(const estimate::PageHits& hits, device::Buffer<std::uint32_t>& photons,
                             device::Buffer<float>& squared_radius) {
  run_nearest(hits, page_defines(hits.page), photons, squared_radius, {});
}

void StructureQuery::count_visits(const estimate::PageHits& hits,
                                  device::Buffer<std::uint32_t>& photons,
                                  device::Buffer<float>& squared_radius,
                                  device::Buffer<std::uint32_t>& visits) {
  device::Defines defines = page_defines(hits.page);
  defines.set("COUNT_VISITS");
  run_nearest(hits, defines, photons, squared_radius, visits);
}

void StructureQuery::run_nearest(const estimate::PageHits& hits, device::Defines defines,
                                 device::Buffer<std::uint32_t>& photons,
                                 device::Buffer<float>& squared_radius,
                                 const device::Buffer<std::uint32_t>& visits) {
  device::Launch launch(context_, context_.kernel(file_, "nearest_by_list", defines));
  estimate::set_page_arguments(launch, hits);
  launch.set("neighbours", photons).set("squared_radius", squared_radius).set("visits", visits);
  run(launch, hits);
}

device::Defines StructureQuery::page_defines(const maps::MapPage& page) const {
  device::Defines defines = defines_;
  if (page.record_normal.size() > 0) defines.set("NORMALS");
  return defines;
}

void StructureQuery::run(device::Launch& launch, const estimate::PageHits& hits) {
  const Index& index = indices_->at(hits.page.first_map);
  launch.set("record_count", hits.page.record_count)
      .set("root", index.root)
      .set("frames", hits.page.grids)
      .set("nodes", index.nodes)
      .set("cell_start", index.cell_start)
      .set("list_distance", list_distance_)
      .set("list_record", list_record_);
  PhotileQuery query = estimate::query_of(store_, hits, parameters_);
  pace_.run(hits.count, 1, [&](std::uint32_t first, std::uint32_t count) {
    query.first_hit = hits.first + first;
    query.hit_count = count;
    launch.set("query", query);
    launch.run_no_more(std::min<std::size_t>(count, work_items_), maps::work_group_size);
  });
}

}  // namespace photile::structures
