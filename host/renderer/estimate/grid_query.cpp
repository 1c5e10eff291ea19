#include <algorithm>
#include <string>

#include "device/cache_folder.hpp"
#include "device/launch.hpp"
#include "estimate/query.hpp"
#include "estimate/specialisation.hpp"
#include "photile/errors.hpp"

namespace photile::estimate {
namespace {

class GridQuery : public Query {
 public:
  GridQuery(const maps::MapStore& store, const QueryParameters& parameters)
      : store_(store),
        context_(device::context_of(*store.device)),
        pace_(context_),
        parameters_(parameters),
        choice_(specialise(parameters.tuning, store.needs,
                           static_cast<int>(parameters.compiled_neighbours))) {
    choice_.work_group_size =
        std::min<std::size_t>(choice_.work_group_size, context_.info().max_work_group_size);
  }

  const LightSums& sums() const override { return choice_.sums; }

  void estimate(const PageHits& hits, EstimateBuffers& estimates) override {
    device::Launch launch(context_, kernel(hits.page, "estimate/estimate.cl",
                                           "estimate_by_selection", [&](device::Defines& defines) {
                                             set_density_defines(defines,
                                                                 parameters_.surface != nullptr,
                                                                 parameters_.kernel);
                                           }));
    set_estimate_arguments(launch, hits, parameters_, estimates);
    set_grid(launch, hits.page);
    run(launch, hits, [&](std::uint32_t count) {
      launch.run(choice_.work_items(count), choice_.work_group_size);
    });
  }

  void nearest(const PageHits& hits, device::Buffer<std::uint32_t>& photons,
               device::Buffer<float>& squared_radius) override {
    device::Launch launch(context_, kernel(hits.page, "estimate/nearest.cl", "nearest_by_selection",
                                           [](device::Defines&) {}));
    set_page_arguments(launch, hits);
    set_grid(launch, hits.page);
    launch.set("neighbours", photons).set("squared_radius", squared_radius);
    run(launch, hits, [&](std::uint32_t count) {
      launch.run(choice_.nearest_items(count), choice_.work_group_size);
    });
  }

 private:
  /// Calls run_part(count) for the hits, part by part.
  template <class RunPart>
  void run(device::Launch& launch, const PageHits& hits, RunPart run_part) {
    // A work-item takes the same hits together whatever the parts are.
    constexpr std::uint32_t unit = 64;
    static_assert(unit % max_hits_per_item == 0);
    PhotileQuery query = query_of(store_, hits, parameters_);
    pace_.run(hits.hits.count, unit, [&](std::uint32_t first, std::uint32_t count) {
      query.first_hit = first;
      query.hit_count = count;
      launch.set("query", query);
      run_part(count);
    });
  }

  static void set_grid(device::Launch& launch, const maps::MapPage& page) {
    launch.set("grids", page.grids).set("cell_start", page.cell_start);
  }

  /// A kernel for a page. If the device cannot run it, a kernel that any device can run is used
  /// from then on.
  template <class SetDefines>
  device::Kernel kernel(const maps::MapPage& page, const char* file, const char* name,
                        SetDefines set_defines) {
    const auto built = [&] {
      device::Defines defines = choice_.defines();
      if (page.record_normal.size() > 0) defines.set("NORMALS");
      set_defines(defines);
      return context_.kernel(file, name, defines);
    };
    const DeviceInfo& info = context_.info();
    try {
      device::Kernel kernel = built();
      if (fits(choice_, kernel.resources(), info)) return kernel;
    } catch (const KernelBuildError& error) {
      // The compilers of CPUs have no such limits: it is the kernel that is wrong.
      if (info.type == DeviceType::cpu) throw;
      device::warn(std::string(error.what()) + "; a slower kernel is used");
    }
    choice_ = independent_of_k(choice_);
    return built();
  }

  const maps::MapStore& store_;
  device::Context& context_;
  device::LaunchPace pace_;
  QueryParameters parameters_;
  Specialisation choice_;
};

}  // namespace

std::unique_ptr<Query> make_query(const maps::MapStore& store, const QueryParameters& parameters) {
  if (store.make_query) return store.make_query(store, parameters);
  return std::make_unique<GridQuery>(store, parameters);
}

}  // namespace photile::estimate
