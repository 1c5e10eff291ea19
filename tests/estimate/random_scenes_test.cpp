// Small scenes of any shape through groups, maps and estimates, against the oracle: what nobody
// thought of as a case. PHOTILE_RANDOM_SCENES is how many, PHOTILE_RANDOM_SCENES_SEED the first.
// Of many, most are tried in one mode, with one number of neighbours and one or two structures.
#include <array>
#include <cmath>
#include <cstdlib>

#include "oracle_checks.hpp"
#include "photon_sets.hpp"

namespace photile::test {
namespace {

constexpr std::uint64_t quick_scenes = 1;
/// Beyond the first, one of so many scenes is tried in every mode, with every structure.
constexpr std::uint64_t whole_trials = 200;
constexpr std::array neighbour_counts{1, 8, 50};

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

class RandomScene {
 public:
  explicit RandomScene(std::uint64_t seed) : random_(seed) {
    scene_ = empty_scene(static_cast<std::size_t>(whole(1, 3)));
    for (int part = whole(1, 4); part > 0; --part) add_part();
  }

  const Scene& scene() const { return scene_; }
  int whole(int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random_);
  }
  float between(float least, float most) {
    return std::uniform_real_distribution<float>(least, most)(random_);
  }

 private:
  glm::vec3 vector(float size) {
    return {between(-size, size), between(-size, size), between(-size, size)};
  }

  void add_part() {
    const glm::vec3 corner = vector(1);
    switch (whole(0, 4)) {
      case 0:  // level: many distances are equal but for rounding
        add_plate(scene_, {corner.x, corner.y, 0}, {1, 0, 0}, {0, 1, 0}, whole(1, 3));
        break;
      case 1:
        add_plate(scene_, corner, vector(1), vector(1), whole(1, 2));
        break;
      case 2:
        add_torus(scene_, between(0.3f, 1), between(0.05f, 0.3f), whole(3, 6), whole(3, 5));
        break;
      case 3:  // a needle
        add_triangle(scene_, corner, corner + vector(1), corner + vector(between(1e-4f, 1e-2f)));
        break;
      default:  // two that share an edge, at any angle
        const glm::vec3 edge = corner + vector(1);
        add_triangle(scene_, corner, edge, corner + vector(1));
        add_triangle(scene_, edge, corner, corner + vector(1));
    }
  }

  std::mt19937_64 random_;
  Scene scene_;
};

}  // namespace

TEST_CASE("neighbours and irradiance in scenes at random are the oracle's") {
  const std::uint64_t count = number_from("PHOTILE_RANDOM_SCENES", quick_scenes),
                      first = number_from("PHOTILE_RANDOM_SCENES_SEED", 1);
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    CAPTURE(seed);
    RandomScene made(seed);
    const auto photon_count = static_cast<std::size_t>(std::pow(10.0f, made.between(0, 3)));
    const double radius = static_cast<double>(std::pow(10.0f, made.between(-2, 0.5f)));
    const Photons photons = uniform_photons(made.scene(), photon_count, 2 * seed);
    const PrimaryHits hits = uniform_hits(made.scene(), 20, 2 * seed + 1);
    if (seed < first + quick_scenes || seed % whole_trials == 0) {
      check_against_oracle(made.scene(), photons, hits, radius,
                           {neighbour_counts[0], neighbour_counts[1], neighbour_counts[2]}, true);
      continue;
    }
    const auto mode = std::array{MapMode::naive, MapMode::triangle,
                                 MapMode::patch}[static_cast<std::size_t>(made.whole(0, 2))];
    const MapsUnderTest maps(made.scene(), photons, hits, radius, mode);
    const auto k = static_cast<std::size_t>(made.whole(0, 2));
    const auto check = [&](const structures::Structure& structure) {
      maps.check(structure, std::span(neighbour_counts).subspan(k, 1), true);
    };
    check(structures::named("uniform-grid"));
    const auto all = structures::all();
    const auto other =
        static_cast<std::size_t>(made.whole(0, 4 * static_cast<int>(all.size()) - 1));
    if (other < all.size() && maps.has(all[other])) check(all[other]);
  }
}

}  // namespace photile::test
