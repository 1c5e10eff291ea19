#include "maps/gather_entries.hpp"

#include "maps/entry_defines.hpp"

namespace photile::maps {

using device::Defines;

void gather_entries(device::Context& context, const SceneNeeds& needs,
                    std::span<const PhotonPage> photon_pages, MapPage& page) {
  page.entry_stride = page.entry_count + entry_padding;
  page.entry_position = context.allocate<float>(3 * page.entry_stride, "photon map positions");
  page.entry_flux = context.allocate<float>(3 * page.entry_stride, "photon map flux");
  // Vector loads reach into the padding; what they find there is masked, but must be a number.
  context.fill(page.entry_position, 0.0f);
  context.fill(page.entry_flux, 0.0f);
  Defines defines;
  set_entry_defines(defines, needs);
  if (needs.light_count > 1) {
    page.entry_light = context.allocate<std::uint8_t>(
        std::size_t{bytes_per_light(needs)} * page.entry_stride, "photon map lights");
  }
  if (needs.glossy) {
    page.entry_incoming = context.allocate<float>(3 * page.entry_stride, "photon map directions");
  }
  const device::Kernel kernel = context.kernel("grid/gather_entries.cl", "gather_entries", defines);
  for (const PhotonPage& photons : photon_pages) {
    const auto launch = [&](const auto&... optional) {
      context.run(kernel, page.entry_count, work_group_size, page.entry_count, page.entry_stride,
                  page.entry_photon, photons.first_photon, photons.count, photons.position,
                  photons.flux, page.entry_position, page.entry_flux, optional...);
    };
    if (needs.light_count > 1 && needs.glossy) {
      launch(photons.light, page.entry_light, photons.incoming, page.entry_incoming);
    } else if (needs.light_count > 1) {
      launch(photons.light, page.entry_light);
    } else if (needs.glossy) {
      launch(photons.incoming, page.entry_incoming);
    } else {
      launch();
    }
  }
}

}  // namespace photile::maps
