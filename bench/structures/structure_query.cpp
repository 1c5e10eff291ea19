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
    : structure_(structure),
      indices_(std::move(indices)),
      store_(store),
      context_(device::context_of(*store.device)),
      pace_(context_),
      parameters_(parameters),
      sums_(store.needs, parameters.compiled_neighbours) {
  const std::uint64_t neighbours = parameters.neighbours;
  if (parameters.compiled_neighbours > private_list_limit) {
    limit_items(2 * neighbours);
    list_distance_ = context_.allocate<float>(work_items_ * neighbours, "candidate lists");
    list_record_ = context_.allocate<std::uint32_t>(work_items_ * neighbours, "candidate lists");
  }
  if (structure.words_per_item == 0) return;
  limit_items(structure.words_per_item);
  words_ =
      context_.allocate<std::uint32_t>(work_items_ * structure.words_per_item, "rows of blocks");
  by_radix_ = estimate::specialise(shipped_tuning(context_.info(), EstimateStrategy::select),
                                   store.needs, static_cast<int>(parameters.compiled_neighbours));
}

void StructureQuery::limit_items(std::uint64_t words_per_item) {
  constexpr std::uint64_t group = maps::work_group_size;
  const std::uint64_t bytes = std::min(global_list_bytes, context_.memory_limit() / 8);
  const std::uint64_t items = bytes / (words_per_item * sizeof(std::uint32_t));
  work_items_ = std::min(work_items_, std::max(group, items / group * group));
}

void StructureQuery::estimate(const estimate::PageHits& hits,
                              estimate::EstimateBuffers& estimates) {
  device::Defines defines;
  if (by_radix_) {
    defines = by_radix_->defines();
  } else {
    maps::set_record_defines(defines, store_.needs);
    sums_.set_defines(defines);
    if (store_.needs.normal_maps) defines.set("NORMAL_MAPS");
  }
  set_page_defines(defines, hits.page);
  estimate::set_density_defines(defines, parameters_.surface != nullptr, parameters_.kernel);
  const char* const kernel = by_radix_ ? "estimate_by_radix" : "estimate_by_list";
  device::Launch launch(context_, context_.kernel(structure_.kernel_file(), kernel, defines));
  estimate::set_estimate_arguments(launch, hits, parameters_, estimates);
  if (!by_radix_) return run(launch, hits);
  launch.set("rows", words_);
  run(launch, hits, by_radix_->hits_per_item, by_radix_->work_group_size);
}

void StructureQuery::nearest(const estimate::PageHits& hits, device::Buffer<std::uint32_t>& photons,
                             device::Buffer<float>& squared_radius) {
  run_nearest(hits, {}, photons, squared_radius, {});
}

void StructureQuery::count_visits(const estimate::PageHits& hits,
                                  device::Buffer<std::uint32_t>& photons,
                                  device::Buffer<float>& squared_radius,
                                  device::Buffer<std::uint32_t>& visits) {
  device::Defines defines;
  defines.set("COUNT_VISITS");
  run_nearest(hits, defines, photons, squared_radius, visits);
}

void StructureQuery::run_nearest(const estimate::PageHits& hits, device::Defines defines,
                                 device::Buffer<std::uint32_t>& photons,
                                 device::Buffer<float>& squared_radius,
                                 const device::Buffer<std::uint32_t>& visits) {
  set_page_defines(defines, hits.page);
  device::Launch launch(context_,
                        context_.kernel(structure_.kernel_file(), "nearest_by_list", defines));
  estimate::set_page_arguments(launch, hits);
  launch.set("neighbours", photons).set("squared_radius", squared_radius).set("visits", visits);
  run(launch, hits);
}

void StructureQuery::set_page_defines(device::Defines& defines, const maps::MapPage& page) const {
  if (!structure_.symbol.empty()) defines.set(structure_.symbol, structure_.symbol_value);
  if (structure_.words_per_item > 0)
    defines.set("WORDS_PER_ITEM", static_cast<long long>(structure_.words_per_item));
  if (structure_.global) defines.set("ONE_LIST");
  if (page.record_normal.size() > 0) defines.set("NORMALS");
  const std::uint32_t neighbours = parameters_.compiled_neighbours;
  if (neighbours > private_list_limit) return;
  // Few sizes, so that few programs are compiled.
  defines.set("LIST_CAPACITY", static_cast<long long>(std::bit_ceil(std::max(neighbours, 16u))));
}

void StructureQuery::run(device::Launch& launch, const estimate::PageHits& hits, int hits_per_item,
                         std::size_t work_group_size) {
  const Index& index = indices_->at(hits.page.first_map);
  launch.set("record_count", hits.page.record_count)
      .set("root", index.root)
      .set("frames", hits.page.grids)
      .set("nodes", index.nodes)
      .set("cell_start", index.cell_start)
      .set("list_distance", list_distance_)
      .set("list_record", list_record_);
  PhotileQuery query = estimate::query_of(store_, hits, parameters_);
  const auto unit = static_cast<std::uint32_t>(hits_per_item);
  pace_.run(hits.hits.count, unit, [&](std::uint32_t first, std::uint32_t count) {
    query.first_hit = first;
    query.hit_count = count;
    launch.set("query", query);
    launch.run_no_more(std::min<std::size_t>((count + unit - 1) / unit, work_items_),
                       work_group_size);
  });
}

}  // namespace photile::structures
