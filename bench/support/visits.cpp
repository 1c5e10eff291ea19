#include "support/visits.hpp"

#include <vector>

#include "estimate/map_order.hpp"
#include "estimate/query.hpp"
#include "structures/structure_arguments.hpp"

namespace photile::bench {

bool counts_visits(MapStructure structure) {
  return structure != MapStructure::uniform_grid && structure != MapStructure::brute_force;
}

Visits count_visits(const PhotonMaps& maps, const PrimaryHits& hits, int k) {
  const maps::MapStore& store = maps::store_of(maps);
  const auto order = estimate::order_by_map(store.maps_of(hits, 0, hits.size()));
  if (!order.empty()) return count_visits(maps, estimate::reordered(hits, 0, order), k);

  device::Context& context = device::context_of(*store.device);
  const std::vector<std::uint32_t> hit_maps = store.maps_of(hits, 0, hits.size());
  estimate::HitBuffers buffers;
  estimate::upload_hits(context, hits, 0, hit_maps, store.normals, nullptr, {}, buffers);
  const auto neighbours = static_cast<std::uint32_t>(k);
  estimate::QueryParameters parameters;
  parameters.neighbours = neighbours;
  parameters.radius = static_cast<float>(store.parameters.radius);
  // Lists in global memory, a work-item each: any k will do.
  const std::size_t lists = hits.size() * neighbours;
  auto photons = context.allocate<std::uint32_t>(lists, "neighbour lists");
  auto squared_radius = context.allocate<float>(hits.size(), "neighbour radii");
  auto list_distance = context.allocate<float>(lists, "candidate lists");
  auto list_entry = context.allocate<std::uint32_t>(lists, "candidate lists");
  auto visits = context.allocate<std::uint32_t>(2 * hits.size(), "visits");
  context.fill(visits, 0u);
  estimate::for_each_page(store, buffers, hit_maps, [&](const estimate::PageHits& page_hits) {
    device::Defines defines;
    defines.set("COUNT_VISITS");
    if (store.parameters.structure == MapStructure::kdtree_2d) defines.set("TREE_2D");
    if (page_hits.page.entry_normal.size() > 0) defines.set("NORMALS");
    device::Launch launch(context, context.kernel(maps::kernel_file(store.parameters.structure),
                                                  "nearest_by_list", defines));
    launch.set("query", estimate::query_of(store, page_hits, parameters));
    estimate::set_page_arguments(launch, page_hits);
    maps::set_structure_arguments(launch, page_hits.page);
    launch.set("neighbours", photons)
        .set("squared_radius", squared_radius)
        .set("list_distance", list_distance)
        .set("list_entry", list_entry)
        .set("visits", visits)
        .run(page_hits.count, maps::work_group_size);
  });
  std::vector<std::uint32_t> counts(2 * hits.size());
  context.read(visits, std::span(counts));
  Visits sum;
  for (std::size_t i = 0; i < counts.size(); i += 2) {
    sum.nodes += counts[i];
    sum.photons += counts[i + 1];
  }
  const auto hit_count = static_cast<double>(hits.size());
  return {sum.nodes / hit_count, sum.photons / hit_count};
}

}  // namespace photile::bench
