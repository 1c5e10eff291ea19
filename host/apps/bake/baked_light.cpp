#include "bake/baked_light.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cache/charts.hpp"
#include "cache/node_mix.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::bake {

namespace {

/// Texels whose nodes are filled at a time: bounds the memory of their hits.
constexpr std::size_t texels_per_fill = std::size_t{1} << 16;

/// A texel with less than this fraction of the light beside it, and of the median of all, may lie
/// under a thing: what gets there comes through seams between faces.
constexpr float dark_beside = 0.01f;

void add(PrimaryHits& hits, const glm::vec3& position, std::uint32_t oriented_face) {
  hits.position.push_back(position);
  hits.oriented_face.push_back(oriented_face);
}

/// Calls visit(value) for each estimate of a layer at a node.
template <class Visit>
void for_each_value(const LightTable& values, std::uint32_t node, std::size_t layer,
                    const Visit& visit) {
  if (!values.sparse()) return visit(values.row(node).first + layer);
  values.for_each(node, [&](std::size_t light, std::size_t i) {
    if (light == layer) visit(i);
  });
}

/// Light of a layer between nodes, at power 1.
glm::vec3 interpolated(const LightTable& values, const cache::BilinearWeights& bilinear,
                       std::size_t layer) {
  glm::vec3 light(0.0f);
  for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
    for_each_value(values, bilinear.node[i], layer, [&](std::size_t value) {
      light += bilinear.weight[i] * values.irradiance[value];
    });
  }
  return light;
}

/// The irradiance of a plane of this normal.
glm::vec3 turned(const LightTable& values, const cache::BilinearWeights& bilinear,
                 std::size_t layer, const glm::vec3& normal) {
  glm::vec4 by_normal(0.0f);
  for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
    for_each_value(values, bilinear.node[i], layer, [&](std::size_t value) {
      by_normal += bilinear.weight[i] * values.by_normal[value];
    });
  }
  return cache::turned(interpolated(values, bilinear, layer), by_normal, normal);
}

/// Of each triangle the side on which more light falls, and the other where it is open and lit.
std::vector<std::uint32_t> chosen_sides(const Scene& scene, cache::LightMaps& maps,
                                        const BakeParameters& parameters, Progress& progress) {
  progress.begin("find lit surfaces", 0, "");
  const std::span<const std::uint32_t> chart_of = maps.charts().chart_of();
  const auto counts = [&](std::uint32_t s) { return is_drawn(scene, maps.charts(), s); };
  const auto open = [&](std::uint32_t s) {
    return (parameters.open.empty() || parameters.open[s]) && counts(s);
  };
  PrimaryHits samples;  // the middle, and a point towards each corner
  for (std::uint32_t s = 0; s < chart_of.size(); ++s) {
    if (chart_of[s] == none || !open(s)) continue;
    const std::array<glm::vec3, 3> corners = scene.corners(triangle_of(s));
    const glm::vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
    add(samples, middle, s);
    for (const glm::vec3& corner : corners) add(samples, 0.5f * (middle + corner), s);
  }
  maps.fill(samples, progress);
  std::vector<double> light_at(samples.size());
  const std::size_t layers = parameters.powers.size();
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    cache::BilinearWeights bilinear{};
    maps.find(samples.oriented_face[i], samples.position[i], bilinear);
    for (std::size_t layer = 0; layer < layers; ++layer) {
      light_at[i] += parameters.powers[layer] *
                     luminance(glm::dvec3(interpolated(maps.values(), bilinear, layer)));
    }
  });
  std::vector<double> light(chart_of.size(), 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) light[samples.oriented_face[i]] += light_at[i];
  std::vector<std::uint32_t> sides;
  for (std::uint32_t t = 0; t < scene.triangle_count(); ++t) {
    const std::uint32_t front = scene.front_side[t];
    const bool only_back = open(oriented(t, 1 - front)) && !open(oriented(t, front));
    const std::uint32_t brighter =
        only_back || light[oriented(t, 1 - front)] > light[oriented(t, front)] ? 1 - front : front;
    for (const std::uint32_t side : {0u, 1u}) {
      const std::uint32_t s = oriented(t, side);
      if ((side == brighter || light[s] > 0) && counts(s)) sides.push_back(s);
    }
  }
  progress.end();
  return sides;
}

}  // namespace

BakedLight::BakedLight(const Scene& scene, cache::LightMaps& maps, const BakeParameters& parameters,
                       Progress& progress)
    : LightAtlas(scene, maps.charts(), chosen_sides(scene, maps, parameters, progress), parameters),
      maps_(maps) {
  spread(fill(progress));
}

PrimaryHits BakedLight::fill(Progress& progress) {
  cache::BilinearWeights nothing{};
  nothing.node.fill(none);
  bilinear_.assign(area(), nothing);
  PrimaryHits points;
  points.position.resize(bilinear_.size());
  points.oriented_face.resize(bilinear_.size(), none);
  progress.begin("bake light maps", used_texels(), "texels");
  TexelPoints next;
  const auto value = [&] {
    const std::vector<std::size_t>& texels = next.texels;
    const PrimaryHits& hits = next.hits;
    maps_.fill(hits, progress);
    tbb::parallel_for(std::size_t{0}, texels.size(), [&](std::size_t i) {
      const trace::FlushDenormals flush_denormals;
      cache::BilinearWeights& bilinear = bilinear_[texels[i]];
      maps_.find(hits.oriented_face[i], hits.position[i], bilinear);
      maps_.keep_visible(hits.oriented_face[i], hits.position[i], bilinear);
    });
    for (std::size_t i = 0; i < texels.size(); ++i) {
      points.position[texels[i]] = hits.position[i];
      points.oriented_face[texels[i]] = hits.oriented_face[i];
    }
    if (!maps_.values().by_normal.empty()) {
      normal_.resize(bilinear_.size());
      for (std::size_t i = 0; i < texels.size(); ++i) {
        normal_[texels[i]] = trace::shading_normal(scene_, hits.oriented_face[i], hits.position[i]);
      }
    }
    progress.advance(texels.size());
    next = {};
  };
  for (std::size_t i = 0; i < chart_count(); ++i) {
    add_points(i, next);
    if (next.texels.size() >= texels_per_fill) value();
  }
  value();
  progress.end();
  return points;
}

/// A lookup beside a box that stands on a floor takes a part of the texels under the box. Those
/// with hardly any light, from which the box hides a lit texel next to them, get what that one has;
/// and so do those in the slit below a thing that stands a little above the surface, such as a
/// skirting board. A slit as high as texels are apart is lit where a lookup beside it reaches.
void BakedLight::spread(const PrimaryHits& points) {
  const std::vector<cache::BilinearWeights> found = bilinear_;
  const LightTable& values = maps_.values();
  std::vector<float> light(found.size(), 0.0f);  // of all layers and channels together
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t texel) {
    const cache::BilinearWeights& bilinear = found[texel];
    for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
      if (bilinear.weight[i] == 0.0f) continue;
      values.for_each(bilinear.node[i], [&](std::size_t, std::size_t entry) {
        const glm::vec3& value = values.irradiance[entry];
        light[texel] += bilinear.weight[i] * (value.x + value.y + value.z);
      });
    }
  });
  std::vector<float> lit = light;
  std::erase(lit, 0.0f);
  if (lit.empty()) return;
  const auto median = lit.begin() + std::ssize(lit) / 2;
  std::nth_element(lit.begin(), median, lit.end());
  const auto slit = static_cast<float>(texel() / 4);
  const auto low = [&](std::uint32_t node) { return node != none && maps_.distance(node) < slit; };
  const auto on_surface = [&](std::size_t texel) {
    return trace::location_on(scene_, points.oriented_face[texel], points.position[texel]);
  };
  constexpr int around[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  tbb::parallel_for(std::size_t{0}, placed().size(), [&](std::size_t i) {
    const trace::FlushDenormals flush_denormals;
    const Placed& at = placed()[i];
    const TexelRectangle& rectangle = at.rectangle;
    const auto texel = [&](std::uint32_t x, std::uint32_t y) {
      return std::size_t{rectangle.y + y} * width() + rectangle.x + x;
    };
    for (std::uint32_t y = 0; y < rectangle.height; ++y) {
      for (std::uint32_t x = 0; x < rectangle.width; ++x) {
        const std::size_t here = texel(x, y);
        const bool covered = std::ranges::any_of(found[here].node, low);
        for (const auto& [dx, dy] : around) {
          const std::uint32_t nx = x + dx, ny = y + dy;  // beyond 0 they are large
          if (nx >= rectangle.width || ny >= rectangle.height) continue;
          const std::size_t beside = texel(nx, ny);
          if (!(light[beside] > 0)) continue;
          if ((light[here] < dark_beside * std::min(light[beside], *median) &&
               !maps_.sees(member(at.chart), point(at, x, y), point(at, nx, ny))) ||
              (covered && maps_.is_in_slit(on_surface(beside), on_surface(here), slit))) {
            bilinear_[here] = found[beside];
            break;
          }
        }
      }
    }
  });
}

std::vector<glm::vec3> BakedLight::layer(std::size_t layer) const {
  std::vector<glm::vec3> texels(bilinear_.size(), glm::vec3(0.0f));
  const LightTable& values = maps_.values();
  tbb::parallel_for(std::size_t{0}, texels.size(), [&](std::size_t i) {
    if (bilinear_[i].node[0] == none) return;
    texels[i] = normal_.empty() ? interpolated(values, bilinear_[i], layer)
                                : turned(values, bilinear_[i], layer, normal_[i]);
  });
  return texels;
}

std::vector<bool> BakedLight::reaches(std::span<const std::uint8_t> sides,
                                      std::size_t layers) const {
  const LightTable& values = maps_.values();
  std::vector<bool> reached(layers, false);
  const glm::vec2 size(width(), height());
  for (const std::uint32_t side : this->sides()) {
    if (sides[side] == 0) continue;
    const std::array<glm::vec2, 3> corners = this->corners(side);
    const glm::uvec2 low(glm::min(glm::min(corners[0], corners[1]), corners[2]) * size);
    const glm::uvec2 high(glm::max(glm::max(corners[0], corners[1]), corners[2]) * size);
    for (std::uint32_t y = low.y; y <= std::min(high.y, height() - 1); ++y) {
      for (std::uint32_t x = low.x; x <= std::min(high.x, width() - 1); ++x) {
        const cache::BilinearWeights& bilinear = bilinear_[std::size_t{y} * width() + x];
        if (bilinear.node[0] == none) continue;
        for (std::size_t layer = 0; layer < layers; ++layer) {
          if (!reached[layer] && interpolated(values, bilinear, layer) != glm::vec3(0.0f)) {
            reached[layer] = true;
          }
        }
      }
    }
  }
  return reached;
}

std::vector<float> BakedLight::errors(std::size_t layer, const LightTable& of_nodes) const {
  std::vector<float> texels(bilinear_.size(), 0.0f);
  tbb::parallel_for(std::size_t{0}, texels.size(), [&](std::size_t i) {
    if (bilinear_[i].node[0] == none) return;
    const glm::vec3 error = interpolated(of_nodes, bilinear_[i], layer);
    texels[i] = static_cast<float>(luminance(glm::dvec3(error)));
  });
  return texels;
}

double BakedLight::standard_error(std::span<const double> powers,
                                  const LightTable& of_nodes) const {
  double squares = 0, light = 0, lit = 0;
  std::vector<double> sum(bilinear_.size(), 0.0);
  for (std::size_t i = 0; i < powers.size(); ++i) {
    const std::vector<glm::vec3> texels = layer(i);
    const std::vector<float> errors_of_layer = errors(i, of_nodes);
    for (std::size_t texel = 0; texel < texels.size(); ++texel) {
      const double error = powers[i] * errors_of_layer[texel];
      squares += error * error;  // lights err apart
      sum[texel] += powers[i] * luminance(glm::dvec3(texels[texel]));
    }
  }
  for (const double value : sum) {
    if (value > 0) light += value, ++lit;
  }
  return lit > 0 ? std::sqrt(squares * lit) / light : 0.0;
}

}  // namespace photile::bake
