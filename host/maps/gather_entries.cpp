#include "maps/gather_entries.hpp"

#include "maps/entry_defines.hpp"

namespace photile::maps {

using device::Defines;

void gather_entries(device::Context& context, const SceneNeeds& needs, PhotonPages& photon_pages,
                    bool normals, MapPage& page) {
  page.entry_stride = page.entry_count + entry_padding;
  // Vector loads reach into the padding; what they find there is masked, but must be a number.
  const auto planes = [&](std::string_view what) {
    auto buffer = context.allocate<float>(3 * std::size_t{page.entry_stride}, what);
    context.fill(buffer, 0.0f);
    return buffer;
  };
  page.entry_position = planes("photon map positions");
  page.entry_flux = planes("photon map flux");
  Defines defines;
  set_entry_defines(defines, needs);
  if (needs.light_count > 1) {
    page.entry_light = context.allocate<std::uint8_t>(
        std::size_t{bytes_per_light(needs)} * page.entry_stride, "photon map lights");
  }
  if (needs.glossy) page.entry_incoming = planes("photon map directions");
  if (normals) {
    defines.set("NORMALS");
    page.entry_normal = planes("photon map normals");
  }
  const device::Kernel kernel = context.kernel("grid/gather_entries.cl", "gather_entries", defines);
  for (const PhotonPage& photons : photon_pages) {
    const auto launch = [&](const auto&... optional) {
      context.run(kernel, page.entry_count, work_group_size, page.entry_count, page.entry_stride,
                  page.entry_photon, photons.first_photon, photons.count, photons.position,
                  photons.flux, page.entry_position, page.entry_flux, optional...);
    };
    const auto with_normals = [&](const auto&... optional) {
      if (normals) {
        launch(optional..., photons.normal, page.entry_normal);
      } else {
        launch(optional...);
      }
    };
    const auto with_directions = [&](const auto&... optional) {
      if (needs.glossy) {
        with_normals(optional..., photons.incoming, page.entry_incoming);
      } else {
        with_normals(optional...);
      }
    };
    if (needs.light_count > 1) {
      with_directions(photons.light, page.entry_light);
    } else {
      with_directions();
    }
  }
}

}  // namespace photile::maps
