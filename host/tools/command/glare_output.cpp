#include "tools/command/glare_output.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "image/glare.hpp"
#include "image/srgb.hpp"
#include "photile/layered_picture.hpp"
#include "tools/view/snapshots.hpp"

namespace photile::app {

void write_glare(const RenderOptions& options, const LightLayers& layers,
                 const LightLayers& reflections, const LightMix& mix, Progress& progress) {
  const image::Glare glare = image::find_glare(layers, reflections, mix, options.glare_limit);
  const Image displayed =
      tone_map(mixed_picture(layers, mix)->root(),
               {!options.pictures.no_automatic_exposure, options.pictures.exposure});
  std::vector<std::uint8_t> rgb = image::srgb8_texels(displayed);
  image::draw_marks(glare.marks, rgb);
  view::write_screenshot(options.glare, layers.width, layers.height, rgb);
  const PowerUnit unit = mix.lights.empty() ? PowerUnit::lumen : mix.lights.front().unit;
  for (const std::string& line : image::glare_lines(glare, unit)) progress.note(line);
}

}  // namespace photile::app
