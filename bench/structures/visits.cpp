#include "structures/visits.hpp"

#include <vector>

#include "structures/structure_query.hpp"

namespace photile::structures {

Visits count_visits(const PhotonMaps& maps, const PrimaryHits& hits, int k) {
  const maps::MapStore& store = maps::store_of(maps);
  device::Context& context = device::context_of(*store.device);
  const std::vector<std::uint32_t> hit_maps = store.maps_of(hits, 0, hits.size());
  const estimate::HitBuffers buffers =
      estimate::upload_hits(context, hits, 0, hit_maps, store.normals, nullptr, {});
  const auto neighbours = static_cast<std::uint32_t>(k);
  estimate::QueryParameters parameters;
  parameters.neighbours = parameters.compiled_neighbours = neighbours;
  parameters.radius = static_cast<float>(store.parameters.radius);
  const auto query = store.make_query(store, parameters);
  auto photons = context.allocate<std::uint32_t>(hits.size() * neighbours, "neighbour lists");
  auto squared_radius = context.allocate<float>(hits.size(), "neighbour radii");
  auto visits = context.allocate<std::uint32_t>(2 * hits.size(), "visits");
  context.fill(visits, 0u);
  estimate::for_each_page(store, buffers, hit_maps, [&](const estimate::PageHits& page_hits) {
    dynamic_cast<StructureQuery&>(*query).count_visits(page_hits, photons, squared_radius, visits);
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

}  // namespace photile::structures
