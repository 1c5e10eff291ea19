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
    device::Launch launch(context_,
                          context_.kernel(choice_.kernel_file(), "estimate", estimate_defines));
    set_estimate_arguments(launch, store_, hits, parameters_, estimates);
    set_grid(launch, hits.page);
    launch.run(choice_.work_items(hits.count), choice_.work_group_size);
  }

  void nearest(const PageHits& hits, device::Buffer<std::uint32_t>& photons,
               device::Buffer<float>& squared_radius) override {
    device::Launch launch(context_,
                          context_.kernel("estimate/nearest.cl", "nearest", defines(hits.page)));
    set_page_arguments(launch, hits, parameters_);
    set_normal_arguments(launch, store_, hits, nullptr);
    set_grid(launch, hits.page);
    launch.set("neighbours", photons).set("squared_radius", squared_radius);
    launch.run(hits.count, maps::work_group_size);
  }

 private:
  static void set_grid(device::Launch& launch, const maps::MapPage& page) {
    launch.set("grids", page.grids).set("cell_start", page.cell_start);
  }

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
