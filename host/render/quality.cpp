#include "render/quality.hpp"

namespace photile {
namespace {

void set(RenderParameters& parameters, std::uint64_t photons, int neighbours, int samples,
         int rays) {
  parameters.photons.emitted_photons = photons;
  parameters.neighbours = neighbours;
  parameters.film.samples_per_pixel = samples;
  parameters.light_maps = LightMapMode::automatic;
  parameters.light_map_rays = rays;
}

}  // namespace

std::string_view name_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return "draft";
    case Quality::good:
      return "good";
    case Quality::best:
      return "final";
  }
  return "unknown";
}

void set_quality(RenderParameters& parameters, Quality quality) {
  switch (quality) {
    case Quality::draft:
      return set(parameters, defaults::emitted_photons, defaults::neighbours,
                 defaults::samples_per_pixel, 0);
    case Quality::good:
      return set(parameters, 500'000, 100, 16, 64);
    case Quality::best:
      return set(parameters, 2'000'000, 100, 64, 256);
  }
}

}  // namespace photile
