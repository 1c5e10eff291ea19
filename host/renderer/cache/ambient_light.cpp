#include "cache/ambient_light.hpp"

#include <algorithm>
#include <limits>

namespace photile::cache {

namespace {

/// More nodes than these hardly change the light that is read; a subset is taken evenly.
constexpr std::size_t most_nodes = 2048;
/// Lattices have 1, 2, 4 ... cells along each axis.
constexpr int finest_level = 4;
/// Weight of a coarser lattice relative to the next finer one: it only matters where no node is
/// near.
constexpr float coarser_weight = 1.0f / 16;
/// Weight of a node for the directions that it does not face, so that no direction is without
/// light.
constexpr float other_directions = 0.01f;

int side_of_lattice(int level) { return (1 << level) + 1; }

/// Weights of the six directions for a unit normal: squared cosines, whose sum is 1.
std::array<float, 6> weights_of(const glm::vec3& normal) {
  std::array<float, 6> weights{};
  for (int axis = 0; axis < 3; ++axis) {
    const float along = normal[axis];
    weights[static_cast<std::size_t>(2 * axis + (along < 0 ? 1 : 0))] = along * along;
  }
  return weights;
}

/// Calls visit(vertex, weight) for the eight around a position.
///   at   in [0, 1]^3 of the bounds
template <class Vertices, class Visit>
void around(Vertices& vertices, int level, const glm::vec3& at, const Visit& visit) {
  const int side = side_of_lattice(level), cells = side - 1;
  const glm::vec3 in_cells = at * static_cast<float>(cells);
  const glm::ivec3 cell = glm::min(glm::ivec3(in_cells), cells - 1);
  const glm::vec3 within = in_cells - glm::vec3(cell);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::vec3 weight = glm::mix(1.0f - within, within, glm::vec3(step));
    const glm::ivec3 at = cell + step;
    visit(vertices[static_cast<std::size_t>((at.z * side + at.y) * side + at.x)],
          weight.x * weight.y * weight.z);
  }
}

}  // namespace

void AmbientLight::gather(const LightMaps& maps, const Scene& scene,
                          std::span<const glm::vec4> light) {
  finest_.clear();
  if (light.empty()) return;
  const auto step = static_cast<std::uint32_t>((light.size() + most_nodes - 1) / most_nodes);
  const auto nodes = static_cast<std::uint32_t>(light.size());
  const auto spacing = static_cast<float>(maps.charts().spacing());
  glm::vec3 highest(std::numeric_limits<float>::lowest());
  lowest_ = -highest;
  for (std::uint32_t node = 0; node < nodes; node += step) {
    lowest_ = glm::min(lowest_, maps.point(node).position);
    highest = glm::max(highest, maps.point(node).position);
  }
  const glm::vec3 sides = highest - lowest_;
  const float least = std::max({sides.x, sides.y, sides.z}) / (1 << finest_level);
  extent_ = glm::max(sides, glm::vec3(std::max(least, std::numeric_limits<float>::min())));

  Vertex all{};
  std::vector<Vertex> coarser;
  for (int level = 0; level <= finest_level; ++level) {
    const int side = side_of_lattice(level);
    finest_.assign(static_cast<std::size_t>(side * side * side), Vertex{});
    for (std::uint32_t node = 0; node < nodes; node += step) {
      const LightMaps::NodePoint& point = maps.point(node);
      const auto weights = weights_of(glm::vec3(face_normal(scene, point.oriented_face)));
      const glm::vec4 counted = std::clamp(maps.distance(node) / spacing, least_node_weight, 1.0f) *
                                glm::vec4(glm::vec3(light[node]), 1.0f);
      const auto add_to = [&](Vertex& vertex, float share) {
        for (std::size_t i = 0; i < weights.size(); ++i) {
          vertex[i] += share * (weights[i] + other_directions) * counted;
        }
      };
      around(finest_, level, within_bounds(point.position), add_to);
      if (level == 0) add_to(all, 1.0f);
    }
    for (int i = 0; i < side * side * side; ++i) {
      const auto add = [&](const Vertex& vertex, float weight) {
        for (std::size_t j = 0; j < vertex.size(); ++j) {
          finest_[static_cast<std::size_t>(i)][j] += coarser_weight * weight * vertex[j];
        }
      };
      const glm::vec3 at =
          glm::vec3(i % side, i / side % side, i / (side * side)) / static_cast<float>(side - 1);
      if (level == 0) {
        add(all, 1.0f);
      } else {
        around(coarser, level - 1, at, add);
      }
    }
    coarser = finest_;
  }
}

glm::vec3 AmbientLight::within_bounds(const glm::vec3& position) const {
  return glm::clamp((position - lowest_) / extent_, 0.0f, 1.0f);
}

glm::vec3 AmbientLight::irradiance(const glm::vec3& position, const glm::vec3& normal) const {
  if (finest_.empty()) return glm::vec3(0.0f);
  const auto weights = weights_of(normal);
  glm::vec4 sum(0.0f);
  around(finest_, finest_level, within_bounds(position), [&](const Vertex& vertex, float weight) {
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] > 0) sum += weight * weights[i] * vertex[i];
    }
  });
  return sum.w > 0 ? glm::vec3(sum) / sum.w : glm::vec3(0.0f);
}

}  // namespace photile::cache
