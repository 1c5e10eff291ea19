#include "estimate/query.hpp"
#include "estimate/specialisation.hpp"

namespace photile::estimate {
namespace {

class GridQuery : public Query {
 public:
  GridQuery(const maps::MapStore& store, std::uint32_t neighbours, float radius)
      : store_(store),
        context_(store.device->context()),
        neighbours_(neighbours),
        radius_(radius),
        choice_(specialise(context_.info(), store.needs, static_cast<int>(neighbours))) {}

  void estimate(const PageHits& hits, device::Buffer<float>& irradiance,
                device::Buffer<float>& radiance) override {
    const device::Kernel kernel =
        context_.kernel("estimate/estimate.cl", "estimate", choice_.defines());
    const maps::MapPage& page = hits.page;
    const auto hits_per_item = static_cast<std::uint32_t>(choice_.hits_per_item);
    const std::uint32_t work_items = (hits.count + hits_per_item - 1) / hits_per_item;
    with_scene_arguments(store_.needs, hits, radiance, [&](const auto&... scene) {
      context_.run(kernel, work_items, maps::work_group_size, hits.count, hits.first,
                   hits.hits.position, hits.hits.map, page.first_map, page.grids, page.cell_start,
                   page.entry_stride, page.entry_position, page.entry_flux, page.entry_photon,
                   scene..., neighbours_, radius_, store_.needs.light_count, irradiance);
    });
  }

  void nearest(const PageHits& hits, device::Buffer<std::uint32_t>& photons,
               device::Buffer<float>& squared_radius) override {
    const maps::MapPage& page = hits.page;
    context_.run(context_.kernel("estimate/nearest.cl", "nearest", choice_.defines()), hits.count,
                 maps::work_group_size, hits.count, hits.first, hits.hits.position, hits.hits.map,
                 page.first_map, page.grids, page.cell_start, page.entry_stride,
                 page.entry_position, page.entry_photon, neighbours_, radius_, photons,
                 squared_radius);
  }

 private:
  const maps::MapStore& store_;
  device::Context& context_;
  std::uint32_t neighbours_;
  float radius_;
  Specialisation choice_;
};

}  // namespace

std::unique_ptr<Query> make_grid_query(const maps::MapStore& store, std::uint32_t neighbours,
                                       float radius) {
  return std::make_unique<GridQuery>(store, neighbours, radius);
}

}  // namespace photile::estimate
