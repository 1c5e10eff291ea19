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
    const auto run = [&](const char* kernel, const auto&... arrays) {
      build.run(kernel, page.entry_count, work_group_size, page.entry_count, page.entry_stride,
                page.entry_photon, photons.first_photon, photons.count, arrays...);
    };
    const auto gather = [&](const auto&... optional) {
      run("gather_entries", photons.position, photons.flux, page.entry_position, page.entry_flux,
          optional...);
    };
    const auto with_directions = [&](const auto&... optional) {
      if (needs.glossy) {
        gather(optional..., photons.incoming, page.entry_incoming);
      } else {
        gather(optional...);
      }
    };
    if (needs.several_lights()) {
      with_directions(photons.light, page.entry_light);
    } else {
      with_directions();
    }
    if (normals != nullptr) {
      run("gather_normals", photons.sided_triangle, *normals, page.entry_normal);
    }
  }
}

}  // namespace photile::maps
