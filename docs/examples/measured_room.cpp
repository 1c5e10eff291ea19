// A room made in memory: the illuminance of its floor.
#include <cstdio>
#include <photile/photile.hpp>
#include <vector>

int main() try {
  photile::SceneBuilder builder("room");
  photile::Material white;
  white.diffuse = glm::vec3(0.8f);
  builder.box({0, 0, 0}, {5, 4, 2.5f}, builder.add(white), /*inwards=*/true);  // metres, z upwards
  photile::Light lamp;
  lamp.name = "lamp";
  lamp.kind = photile::LightKind::point;
  lamp.position = {2.5f, 2, 2};
  lamp.power = 1500;  // lumens
  builder.add(lamp);
  const photile::Scene scene = std::move(builder).build();

  std::vector<photile::Sensor> sensors;
  for (double x = 0.5; x < 5; x += 1) sensors.push_back({{x, 2, 0}, {0, 0, 1}});
  std::vector<photile::Device> devices = photile::open_devices();
  const photile::RenderResult result = photile::measure(scene, sensors, devices, {});

  // Layers are those of lights at a power of 1.
  const photile::LightLayers::Layer& layer = result.layers.layers.front();
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    std::printf("x = %.1f m: %.0f lx\n", sensors[i].position.x, lamp.power * layer.illuminance[i]);
  }
} catch (const photile::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
