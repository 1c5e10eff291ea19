// A scene file rendered once, and its picture with other lights: relit_picture SCENE OUT.exr
// OUT.png
#include <cstdio>
#include <photile/photile.hpp>
#include <vector>

int main(int count, char** arguments) try {
  if (count != 4) throw photile::UsageError("usage: relit_picture SCENE OUT.exr OUT.png");
  const photile::Scene scene = photile::load_scene(arguments[1]);
  photile::RenderParameters parameters;
  parameters.film.width = 256;
  parameters.film.height = 192;
  parameters.photons.emitted_photons = 200'000;
  std::vector<photile::Device> devices = photile::open_devices();
  const photile::RenderResult result =
      photile::render(scene, scene.cameras.front(), devices, parameters);

  photile::LightMix mix = photile::LightMix::of(scene, photile::defaults::lumen_per_watt);
  photile::write_exr(arguments[2], photile::mix_layers(result.layers, mix));
  for (photile::MixedLight& light : mix.lights) {
    std::printf("%s at half of its power\n", light.name.c_str());
    light.power /= 2;
  }
  const photile::Image relit = photile::mix_layers(result.layers, mix);
  photile::write_png(arguments[3], photile::tone_map(relit, {.automatic_exposure = true}));
} catch (const photile::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
