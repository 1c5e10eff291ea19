#include "app/glare_output.hpp"

#include <memory>
#include <string>

#include "image/glare.hpp"
#include "image/srgb.hpp"
#include "photile/layered_picture.hpp"
#include "view/snapshots.hpp"

namespace photile::app {

void write_glare(const RenderOptions& options, const LightLayers& layers,
                 const LightLayers& reflections, const LightMix& mix, Progress& progress) {
  const image::Glare glare = image::find_glare(layers, reflections, mix, options.glare_limit);
  const Image displayed =
      tone_map(mixed_picture(layers, mix)->root(),
               {!options.pictures.no_automatic_exposure, options.pictures.exposure});
  std::vector<std::uint8_t> rgb(3 * displayed.pixels());
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const std::vector<float>& plane = *displayed.find(std::string(1, "RGB"[channel]));
    for (std::size_t pixel = 0; pixel < plane.size(); ++pixel) {
      rgb[3 * pixel + channel] = image::srgb8_from_linear(plane[pixel]);
    }
  }
  image::draw_marks(glare.marks, rgb);
  view::write_screenshot(options.glare, layers.width, layers.height, rgb);
  const PowerUnit unit = mix.lights.empty() ? PowerUnit::lumen : mix.lights.front().unit;
  for (const std::string& line : image::glare_lines(glare, unit)) progress.note(line);
}

}  // namespace photile::app
