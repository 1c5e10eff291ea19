// Light at nodes by formulas, and the light maps filled from it.
#pragma once

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "cache/light_maps.hpp"
#include "photile/progress.hpp"
#include "test_scenes.hpp"

namespace photile::test {

/// One light, whose irradiance is a function of the place; counts what it was asked.
class FormulaSource : public cache::NodeSource {
 public:
  using Formula = std::function<float(const glm::vec3& position, std::uint32_t oriented_face)>;
  explicit FormulaSource(Formula formula) : formula_(std::move(formula)) {}

  cache::NodeValues value(const cache::NodeBatch& batch, const Progress&) override {
    cache::NodeValues values{LightTable(1, false), {}, {}};
    for (std::size_t i = 0; i < batch.points.size(); ++i) {
      values.light.irradiance.emplace_back(
          formula_(batch.points.position[i], batch.points.oriented_face[i]));
    }
    asked += batch.points.size();
    return values;
  }

  std::size_t asked = 0;

 private:
  Formula formula_;
};

/// The scene with one light in place of its own.
inline Scene with_one_lamp(Scene scene) {
  scene.lights = {point_light("the lamp", {0.5f, 0.5f, 1.0f})};
  std::fill(scene.triangle_light.begin(), scene.triangle_light.end(), none);
  return scene;
}

/// One light of power 1, noise left out.
inline cache::LightMapParameters quiet_parameters(double spacing = 0.04, int levels = 4) {
  cache::LightMapParameters parameters;
  parameters.spacing = spacing;
  parameters.levels = levels;
  parameters.neighbours = 1e12;
  parameters.powers = {1.0};
  return parameters;
}

inline void add_hit(PrimaryHits& hits, const glm::vec3& position, std::uint32_t oriented_face) {
  hits.position.push_back(position);
  hits.oriented_face.push_back(oriented_face);
  hits.pixel.push_back(0);
  hits.throughput.emplace_back(1.0f);
  hits.diffuse_albedo.emplace_back(1.0f);
}

/// count^2 points on each oriented face, away from its corners and edges by half a step.
inline PrimaryHits points_on(const Scene& scene, int count) {
  PrimaryHits hits;
  for (std::uint32_t s = 0; s < 2 * scene.triangle_count(); ++s) {
    const auto [a, b, c] = scene.corners(triangle_of(s));
    for (int i = 0; i < count; ++i) {
      for (int j = 0; i + j < count; ++j) {
        const float n = static_cast<float>(count) + 0.5f;
        const float u = (static_cast<float>(i) + 0.5f) / n, v = (static_cast<float>(j) + 0.5f) / n;
        add_hit(hits, a + u * (b - a) + v * (c - a), s);
      }
    }
  }
  return hits;
}

/// Those hits for which `holds` of their position and oriented face.
template <class Predicate>
PrimaryHits hits_where(const PrimaryHits& hits, Predicate&& holds) {
  PrimaryHits found;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (holds(hits.position[i], hits.oriented_face[i])) {
      add_hit(found, hits.position[i], hits.oriented_face[i]);
    }
  }
  return found;
}

/// Whether a face is a front of one of so many triangles.
inline auto fronts_of(const Scene& scene, std::uint32_t triangles = none) {
  return [&scene, triangles](const glm::vec3&, std::uint32_t face) {
    return triangle_of(face) < triangles && side_of(face) == scene.front_side[triangle_of(face)];
  };
}

/// What light maps say of a point; all of its nodes are valued.
inline float read(const cache::LightMaps& maps, const glm::vec3& position,
                  std::uint32_t oriented_face) {
  cache::BilinearWeights bilinear;
  if (!maps.find(oriented_face, position, bilinear)) return -1.0f;
  float sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += bilinear.weight[i] * maps.values().irradiance[bilinear.node[i]].x;
  }
  return sum;
}

inline std::vector<float> read_all(const cache::LightMaps& maps, const PrimaryHits& hits) {
  std::vector<float> values;
  for (std::size_t i = 0; i < hits.size(); ++i)
    values.push_back(read(maps, hits.position[i], hits.oriented_face[i]));
  return values;
}

}  // namespace photile::test
