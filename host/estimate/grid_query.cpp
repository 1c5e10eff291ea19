#include <algorithm>

#include "estimate/query.hpp"
#include "estimate/specialisation.hpp"

namespace photile::estimate {
namespace {

class GridQuery : public Query {
 public:
  GridQuery(const maps::MapStore& store, const QueryParameters& parameters)
      : store_(store),
        context_(device::context_of(*store.device)),
        parameters_(parameters),
        choice_(specialise(parameters.tuning, store.needs,
                           static_cast<int>(parameters.compiled_neighbours))) {
    choice_.work_group_size =
        std::min<std::size_t>(choice_.work_group_size, context_.info().max_work_group_size);
  }

  const LightSums& sums() const override { return choice_.sums; }

  void estimate(const PageHits& hits, EstimateBuffers& estimates) override {
    device::Defines estimate_defines = defines(hits.page);
    set_density_defines(estimate_defines, parameters_.surface, parameters_.kernel);
    const device::Kernel kernel =
        context_.kernel(choice_.kernel_file(), "estimate", estimate_defines);
    const maps::MapPage& page = hits.page;
    with_scene_arguments(store_, hits, parameters_.surface, estimates, [&](const auto&... scene) {
      context_.run(kernel, choice_.work_items(hits.count), choice_.work_group_size, hits.count,
                   hits.first, hits.hits.position, hits.hits.map, page.first_map, page.grids,
                   page.cell_start, page.entry_stride, page.entry_position, page.entry_flux,
                   page.entry_photon, scene..., parameters_.neighbours, parameters_.radius,
                   parameters_.least_radius, estimates.irradiance);
    });
  }

  void nearest(const PageHits& hits, device::Buffer<std::uint32_t>& photons,
               device::Buffer<float>& squared_radius) override {
    const device::Kernel kernel =
        context_.kernel("estimate/nearest.cl", "nearest", defines(hits.page));
    const maps::MapPage& page = hits.page;
    with_normal_arguments(store_, hits, nullptr, [&](const auto&... normals) {
      context_.run(kernel, hits.count, maps::work_group_size, hits.count, hits.first,
                   hits.hits.position, hits.hits.map, page.first_map, page.grids, page.cell_start,
                   page.entry_stride, page.entry_position, page.entry_photon, normals...,
                   parameters_.neighbours, parameters_.radius, photons, squared_radius);
    });
  }

 private:
  device::Defines defines(const maps::MapPage& page) const {
    device::Defines defines = choice_.defines();
    if (page.entry_normal.size() > 0) defines.set("NORMALS");
    return defines;
  }

  const maps::MapStore& store_;
  device::Context& context_;
  QueryParameters parameters_;
  Specialisation choice_;
};

}  // namespace

std::unique_ptr<Query> make_grid_query(const maps::MapStore& store,
                                       const QueryParameters& parameters) {
  return std::make_unique<GridQuery>(store, parameters);
}

}  // namespace photile::estimate
