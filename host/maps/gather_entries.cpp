#include "maps/gather_entries.hpp"

#include "maps/entry_defines.hpp"

namespace photile::maps {

void gather_entries(const device::KernelSet& build, const SceneNeeds& needs,
                    PhotonPages& photon_pages, const device::Buffer<float>* normals, bool gaps,
                    MapPage& page) {
  device::Context& context = build.context();
  page.entry_stride = entry_stride(page.entry_count);
  // Vector loads reach into padding and gaps; what they find there is masked, but must be a number.
  const auto planes = [&](std::string_view what) {
    auto buffer = context.allocate<float>(3 * std::size_t{page.entry_stride}, what,
                                          device::MemoryPages::large);
    const std::size_t first_empty = gaps ? 0 : page.entry_count;
    for (std::size_t plane = 0; plane < 3; ++plane) {
      context.fill(buffer, 0.0f, plane * page.entry_stride + first_empty,
                   page.entry_stride - first_empty);
    }
    return buffer;
  };
  page.entry_position = planes("photon map positions");
  page.entry_flux = planes("photon map flux");
  if (needs.several_lights()) {
    page.entry_light =
        context.allocate<std::uint8_t>(std::size_t{bytes_per_light(needs)} * page.entry_stride,
                                       "photon map lights", device::MemoryPages::large);
  }
  if (needs.glossy) page.entry_incoming = planes("photon map directions");
  if (normals != nullptr) page.entry_normal = planes("photon map normals");
  for (const PhotonPage& photons : photon_pages.entering(page.first_map, page.last_map)) {
    const auto launch_of = [&](const char* kernel) {
      device::Launch launch = build.launch(kernel);
      launch.set("entry_count", page.entry_count)
          .set("entry_stride", page.entry_stride)
          .set("entry_photon", page.entry_photon)
          .set("first_photon", photons.first_photon)
          .set("photon_count", photons.count);
      return launch;
    };
    device::Launch gather = launch_of("gather_entries");
    gather.set("position", photons.position)
        .set("flux", photons.flux)
        .set("entry_position", page.entry_position)
        .set("entry_flux", page.entry_flux);
    if (needs.several_lights()) {
      gather.set("light", photons.light).set("entry_light", page.entry_light);
    }
    if (needs.glossy) {
      gather.set("incoming", photons.incoming).set("entry_incoming", page.entry_incoming);
    }
    gather.run(page.entry_count, work_group_size);
    if (normals != nullptr) {
      launch_of("gather_normals")
          .set("sided_triangle", photons.sided_triangle)
          .set("normal", *normals)
          .set("entry_normal", page.entry_normal)
          .run(page.entry_count, work_group_size);
    }
  }
}

}  // namespace photile::maps
