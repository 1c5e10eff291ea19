#include <memory>

#include "render/hit_source.hpp"
#include "render/kept_maps.hpp"
#include "render/rendering.hpp"

namespace photile {

RenderResult render_hits(const Scene& scene, const HitSource& hits, const Film& film,
                         std::span<Device> devices, const RenderParameters& parameters,
                         Progress& progress) {
  const auto prepared = std::make_shared<const PreparedScene>(scene);
  const bool reads_nodes = parameters.light_maps == LightMapMode::on || nodes_gather(parameters);
  if (parameters.passes > 1 && reads_nodes) {
    KeptMaps maps(prepared, devices, parameters, nullptr, {},
                  progress);  // nodes hold the mean of all passes
    maps.add_passes(progress);
    return maps.render(hits, film, progress);
  }
  Rendering rendering(*prepared, devices, parameters, progress);
  rendering.expect_one_picture();
  rendering.start(film);
  for (int pass = 0; pass < rendering.plan().passes(); ++pass) {
    rendering.prepare(pass, nullptr, nullptr);
    rendering.add_pass(hits);
  }
  rendering.release();
  return rendering.finish();
}

RenderResult render(const Scene& scene, const Camera& camera, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  return render_hits(scene, CameraHits(camera), parameters.film, devices, parameters, progress);
}

RenderResult render(const Scene& scene, const Camera& camera, Device& device,
                    const RenderParameters& parameters, Progress& progress) {
  return render(scene, camera, std::span(&device, 1), parameters, progress);
}

}  // namespace photile
