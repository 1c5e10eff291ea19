#include <algorithm>
#include <array>
#include <cmath>

#include "fuzz_files.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"

namespace photile::test {

namespace {

void check_plane(const std::vector<float>& plane, std::size_t pixels) {
  require(plane.size() == pixels, "pixels that lack");
  require(std::all_of(plane.begin(), plane.end(), [](float v) { return std::isfinite(v); }),
          "a pixel that is no number");
}

/// Reads a picture as an EXR is written: the root and then the lights.
void check_picture(const LayeredPicture& picture) {
  const Image root = picture.root();
  for (const std::vector<float>& plane : root.channels) check_plane(plane, root.pixels());
  for (std::size_t light = 0; light < picture.lights(); ++light) {
    const LightRows rows = picture.read(light, 0, root.height);
    for (const std::vector<float>& plane : rows.rgb) check_plane(plane, root.pixels());
    if (!rows.illuminance.empty()) check_plane(rows.illuminance, root.pixels());
  }
  for (const std::string& line : picture.overflows()) {
    require(line.find('\n') == std::string::npos, "two lines");
  }
}

/// Another of each light.
std::vector<LightChange> changes_of(const LightMix& mix) {
  constexpr std::array values{"x2", "#FFD8A0", "2700K", "50lm", "off", "x1e20", "3W"};
  std::vector<LightChange> changes;
  for (const MixedLight& light : mix.lights)
    changes.push_back({light.name, values[changes.size() % values.size()]});
  return changes;
}

}  // namespace

bool fuzz_relight(Bytes bytes) {
  const std::filesystem::path file = file_of("layers.exr", bytes);
  return accepts([&] {
    check_picture(*relit_picture(file, {}));
    const auto relit = relit_picture(file, changes_of(read_light_mix(file)));
    check_picture(*relit);
    constexpr std::size_t quickly_written = 4096;  // pixels
    if (relit->header().pixels() > quickly_written) return;
    // Its attributes are those of the input and photile's own.
    const std::filesystem::path output = file.parent_path() / "relit.exr";
    write_exr(output, *relit);
    require(read_header(output).pixels() == relit->header().pixels(), "another size");
  });
}

bool fuzz_picture(Bytes bytes) {
  const std::filesystem::path file = file_of("picture.png", bytes);  // its bytes say what it is
  return accepts([&] {
    check_pixels(file);
    const Image image = read_image(file);
    for (const std::vector<float>& plane : image.channels) {
      require(plane.size() == image.pixels(), "pixels that lack");
    }
  });
}

}  // namespace photile::test
