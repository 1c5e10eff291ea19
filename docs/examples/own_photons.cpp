// Photons of another program: their nearest around points, and the density of flux.
#include <cmath>
#include <cstdio>
#include <photile/photile.hpp>
#include <random>
#include <vector>

int main() try {
  // 100,000 photons on a floor of 2 m x 2 m; together they carry 400 lm.
  constexpr std::size_t count = 100'000;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(-1.0f, 1.0f);
  std::vector<glm::vec3> positions, normals(count, glm::vec3(0, 0, 1));
  for (std::size_t i = 0; i < count; ++i) positions.emplace_back(place(random), place(random), 0);
  const std::vector<glm::vec3> flux(count, glm::vec3(400.0f / count));

  photile::Device device;
  photile::PhotonCloud cloud(device, {.position = positions, .normal = normals, .flux = flux},
                             {.radius = 0.1});

  const std::vector<glm::vec3> points{{0, 0, 0}, {0.3f, -0.4f, 0}, {0, 0, 5}};
  const std::vector<glm::vec3> up(points.size(), glm::vec3(0, 0, 1));
  const photile::CloudNeighbours near = cloud.nearest(points, up, 8);
  const photile::LightTable lux = cloud.irradiance(points, up, {.neighbours = 1000});
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::printf("point %zu: nearest photon %u, the 8th %.4f m away, %.1f lx\n", i,
                near.photons[8 * i], std::sqrt(near.squared_distance[8 * i + 7]),
                photile::luminance(lux.irradiance[i]));
  }
} catch (const photile::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
