#include "bake/baked_light.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "cache/charts.hpp"
#include "cache/node_mix.hpp"
#include "photile/errors.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::bake {

namespace {

/// A lookup between the outermost texels stays within them; the border is for lookups outside.
constexpr std::uint32_t border = 1;

/// The factor by which the distance of texels grows where the picture is too small.
constexpr double coarser = 1.25;

/// Texels whose nodes are valued at a time: bounds the memory of their hits.
constexpr std::size_t texels_per_fill = std::size_t{1} << 16;

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

/// The light of all layers at a node.
std::span<const glm::vec3> light_of(const LightTable& values, std::uint32_t node) {
  const LightTable::Entries entries = values.row(node);
  return std::span(values.irradiance).subspan(entries.first, entries.last - entries.first);
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

/// Metres: no surface is as large.
constexpr double widest_texel = 1e6;

}  // namespace

BakedLight::BakedLight(const Scene& scene, cache::LightMaps& maps, const BakeParameters& parameters,
                       Progress& progress)
    : scene_(scene), maps_(maps) {
  progress.begin("find lit surfaces", 0, "");
  choose_sides(parameters, progress);
  progress.end();
  const auto most_side = static_cast<std::uint32_t>(parameters.most_side);
  texel_ = parameters.texel > 0 ? parameters.texel : maps.charts().spacing() / 2;
  const auto fits = [&] {
    return place_charts(texel_, most_side) &&
           std::uint64_t{atlas_.width} * atlas_.height <= parameters.most_texels;
  };
  while (!fits()) {
    if (texel_ > widest_texel) {
      const bool bounded = parameters.most_texels != std::numeric_limits<std::uint64_t>::max();
      throw UsageError(fmt::format(
          "a picture of {} x {}{} has no room for {} surfaces; give more by --most-texels",
          most_side, most_side,
          bounded ? fmt::format(" and {} texels", parameters.most_texels) : "",
          maps.charts().size()));
    }
    if (parameters.texel > 0 && parameters.exact) {
      throw UsageError(fmt::format("texels {} m apart do not fit a picture of {} x {}; give more",
                                   texel_, most_side, most_side));
    }
    texel_ *= coarser;
  }
  spread(fill(progress));
}

void BakedLight::choose_sides(const BakeParameters& parameters, const Progress& progress) {
  const std::span<const std::uint32_t> chart_of = maps_.charts().chart_of();
  const scene::CoincidentFaces& coincident = maps_.charts().coincident();
  const auto counts = [&](std::uint32_t s) {
    return coincident.before(s).empty() || !coincident.parts_of(scene_, s).counted.empty();
  };
  const auto open = [&](std::uint32_t s) {
    return (parameters.open.empty() || parameters.open[s]) && counts(s);
  };
  PrimaryHits samples;  // the middle, and a point towards each corner
  for (std::uint32_t s = 0; s < chart_of.size(); ++s) {
    if (chart_of[s] == none || !open(s)) continue;
    const std::array<glm::vec3, 3> corners = scene_.corners(triangle_of(s));
    const glm::vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
    add(samples, middle, s);
    for (const glm::vec3& corner : corners) add(samples, 0.5f * (middle + corner), s);
  }
  maps_.fill(samples, progress);
  std::vector<double> light_at(samples.size());
  const std::size_t layers = parameters.powers.size();
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    cache::BilinearWeights bilinear{};
    maps_.find(samples.oriented_face[i], samples.position[i], bilinear);
    for (std::size_t layer = 0; layer < layers; ++layer) {
      light_at[i] += parameters.powers[layer] *
                     luminance(glm::dvec3(interpolated(maps_.values(), bilinear, layer)));
    }
  });
  std::vector<double> light(chart_of.size(), 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) light[samples.oriented_face[i]] += light_at[i];
  for (std::uint32_t t = 0; t < scene_.triangle_count(); ++t) {
    const std::uint32_t front = scene_.front_side[t];
    const bool only_back = open(oriented(t, 1 - front)) && !open(oriented(t, front));
    const std::uint32_t brighter =
        only_back || light[oriented(t, 1 - front)] > light[oriented(t, front)] ? 1 - front : front;
    for (const std::uint32_t side : {0u, 1u}) {
      const std::uint32_t s = oriented(t, side);
      if ((side == brighter || light[s] > 0) && counts(s)) sides_.push_back(s);
    }
  }
}

std::vector<DrawnTriangle> BakedLight::drawn(std::uint32_t oriented_face) const {
  const std::uint32_t triangle = triangle_of(oriented_face);
  const std::size_t second = 1 + side_of(oriented_face), third = 2 - side_of(oriented_face);
  const scene::CoincidentFaces& coincident = maps_.charts().coincident();
  if (coincident.before(oriented_face).empty()) {
    const std::array<glm::vec3, 3> corner{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return {{corner[0], corner[second], corner[third]}};
  }
  std::vector<DrawnTriangle> triangles;
  for (const auto& part : coincident.parts_of(scene_, oriented_face).counted) {
    const auto weights = [&](std::size_t corner) {
      const auto [number, u, v, other, before] =
          trace::nearest_on_triangle(scene_, triangle, glm::dvec3(part[corner]));
      return glm::vec3(1.0f - u - v, u, v);
    };
    triangles.push_back({weights(0), weights(second), weights(third)});
  }
  return triangles;
}

bool BakedLight::place_charts(double texel, std::uint32_t most_side) {
  const cache::Charts& charts = maps_.charts();
  placed_.clear();
  place_of_chart_.assign(charts.size(), none);
  member_.assign(charts.size(), none);
  for (const std::uint32_t side : sides_) {
    const std::uint32_t chart = charts.chart_of()[side];
    if (chart == none || place_of_chart_[chart] != none) continue;
    member_[chart] = side;
    place_of_chart_[chart] = static_cast<std::uint32_t>(placed_.size());
    const cache::Chart& lattice = charts[chart];
    const glm::dvec2 size = lattice.spacing * glm::dvec2(lattice.columns, lattice.rows);
    // A hundredth of a cell more is rounding.
    const glm::dvec2 cells = glm::max(glm::ceil(size / texel - 0.01), glm::dvec2(1.0));
    if (std::max(cells.x, cells.y) > most_side) return false;
    const glm::uvec2 counted(cells);
    const std::uint32_t more = 1 + 2 * border;
    placed_.push_back({chart, counted, {0, 0, counted.x + more, counted.y + more}});
  }
  std::vector<TexelRectangle> rectangles;
  for (const Placed& placed : placed_) rectangles.push_back(placed.rectangle);
  const std::optional<Atlas> atlas = pack(rectangles, most_side);
  if (!atlas) return false;
  for (std::size_t i = 0; i < placed_.size(); ++i) placed_[i].rectangle = rectangles[i];
  atlas_ = *atlas;
  return true;
}

/// The position of a texel of the rectangle: metres from the chart's origin.
glm::dvec2 BakedLight::place(const Placed& placed, std::uint32_t x, std::uint32_t y) const {
  const cache::Chart& lattice = maps_.charts()[placed.chart];
  const glm::uvec2 within(std::clamp(x, border, placed.cells.x + border) - border,
                          std::clamp(y, border, placed.cells.y + border) - border);
  const glm::dvec2 size = lattice.spacing * glm::dvec2(lattice.columns, lattice.rows);
  return glm::dvec2(within) / glm::dvec2(placed.cells) * size;
}

glm::vec3 BakedLight::point(const Placed& placed, std::uint32_t x, std::uint32_t y) const {
  const cache::Chart& lattice = maps_.charts()[placed.chart];
  const glm::dvec2 at = place(placed, x, y);
  return glm::vec3(lattice.origin + at.x * lattice.across + at.y * lattice.along);
}

/// A texel that no triangle covers has the light of the surface nearest to it, so that a lookup at
/// an edge blends light of the surface alone.
PrimaryHits BakedLight::fill(Progress& progress) {
  cache::BilinearWeights nothing{};
  nothing.node.fill(none);
  bilinear_.assign(std::size_t{atlas_.width} * atlas_.height, nothing);
  PrimaryHits points;
  points.position.resize(bilinear_.size());
  points.oriented_face.resize(bilinear_.size(), none);
  progress.begin("bake light maps", used_texels(), "texels");
  PrimaryHits hits;
  std::vector<std::size_t> texels;
  const auto value = [&] {
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
    hits = {};
    texels.clear();
  };
  const cache::Charts& charts = maps_.charts();
  for (const Placed& placed : placed_) {
    const TexelRectangle& rectangle = placed.rectangle;
    const std::size_t first = hits.size();
    const std::size_t count = std::size_t{rectangle.width} * rectangle.height;
    hits.position.resize(first + count);
    hits.oriented_face.resize(first + count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      const auto x = static_cast<std::uint32_t>(i % rectangle.width);
      const auto y = static_cast<std::uint32_t>(i / rectangle.width);
      const cache::Charts::Support owner =
          charts.support(placed.chart, place(placed, x, y), 2 * texel_);
      hits.oriented_face[first + i] = oriented(owner.where.triangle, owner.side);
      hits.position[first + i] = trace::surface_point(scene_, owner.where, owner.side).position;
    });
    for (std::uint32_t y = 0; y < rectangle.height; ++y) {
      for (std::uint32_t x = 0; x < rectangle.width; ++x) {
        texels.push_back(std::size_t{rectangle.y + y} * atlas_.width + rectangle.x + x);
      }
    }
    if (texels.size() >= texels_per_fill) value();
  }
  value();
  progress.end();
  return points;
}

std::uint64_t BakedLight::used_texels() const {
  std::uint64_t count = 0;
  for (const Placed& placed : placed_) {
    count += std::uint64_t{placed.rectangle.width} * placed.rectangle.height;
  }
  return count;
}

/// A lookup beside a box that stands on a floor takes a part of the texels under the box. Those
/// that hold no light, and from which the box hides a lit texel next to them, get what that one
/// has; and so do those in the slit below a thing that stands a little above the surface, such as a
/// skirting board, where next to no light comes. A slit as high as texels are apart is lit where a
/// lookup beside the thing reaches.
void BakedLight::spread(const PrimaryHits& points) {
  const std::vector<cache::BilinearWeights> found = bilinear_;
  const LightTable& values = maps_.values();
  const auto lit = [&](const cache::BilinearWeights& bilinear) {
    for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
      if (bilinear.weight[i] == 0.0f) continue;
      const auto light = light_of(values, bilinear.node[i]);
      if (std::any_of(light.begin(), light.end(),
                      [](const glm::vec3& value) { return value.x + value.y + value.z > 0; })) {
        return true;
      }
    }
    return false;
  };
  const auto slit = static_cast<float>(texel_ / 4);
  const auto may_be_covered = [&](const cache::BilinearWeights& bilinear) {
    return std::any_of(bilinear.node.begin(), bilinear.node.end(), [&](std::uint32_t node) {
      return node != none && maps_.distance(node) < slit;
    });
  };
  const auto on_surface = [&](std::size_t texel) {
    return trace::location_on(scene_, points.oriented_face[texel], points.position[texel]);
  };
  constexpr int around[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
  tbb::parallel_for(std::size_t{0}, placed_.size(), [&](std::size_t i) {
    const trace::FlushDenormals flush_denormals;
    const Placed& placed = placed_[i];
    const TexelRectangle& rectangle = placed.rectangle;
    const auto texel = [&](std::uint32_t x, std::uint32_t y) {
      return std::size_t{rectangle.y + y} * atlas_.width + rectangle.x + x;
    };
    for (std::uint32_t y = 0; y < rectangle.height; ++y) {
      for (std::uint32_t x = 0; x < rectangle.width; ++x) {
        const std::size_t here = texel(x, y);
        const bool dark = !lit(found[here]), covered = may_be_covered(found[here]);
        if (!dark && !covered) continue;
        for (const auto& [dx, dy] : around) {
          const std::uint32_t nx = x + dx, ny = y + dy;  // beyond 0 they are large
          if (nx >= rectangle.width || ny >= rectangle.height) continue;
          const std::size_t beside = texel(nx, ny);
          if (!lit(found[beside])) continue;
          const bool hidden = dark && !maps_.sees(member_[placed.chart], point(placed, x, y),
                                                  point(placed, nx, ny));
          if (!hidden &&
              !(covered && maps_.is_in_slit(on_surface(beside), on_surface(here), slit))) {
            continue;
          }
          bilinear_[here] = found[beside];
          break;
        }
      }
    }
  });
}

std::array<glm::vec2, 3> BakedLight::corners(std::uint32_t oriented_face) const {
  const cache::Charts& charts = maps_.charts();
  const std::uint32_t chart = charts.chart_of()[oriented_face];
  std::array<glm::vec2, 3> corners{};
  if (chart == none) return corners;
  const Placed& placed = placed_[place_of_chart_[chart]];
  const cache::Chart& lattice = charts[chart];
  const auto positions = scene_.corners(triangle_of(oriented_face));
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 offset = glm::dvec3(positions[i]) - lattice.origin;
    const glm::dvec2 place(glm::dot(offset, lattice.across), glm::dot(offset, lattice.along));
    const glm::dvec2 size = lattice.spacing * glm::dvec2(lattice.columns, lattice.rows);
    const glm::dvec2 texel = glm::dvec2(placed.rectangle.x, placed.rectangle.y) + (border + 0.5) +
                             glm::clamp(place / size, 0.0, 1.0) * glm::dvec2(placed.cells);
    corners[i] = glm::vec2(texel / glm::dvec2(atlas_.width, atlas_.height));
  }
  return corners;
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
  const glm::vec2 size(atlas_.width, atlas_.height);
  for (const std::uint32_t side : sides_) {
    if (sides[side] == 0) continue;
    const std::array<glm::vec2, 3> corners = this->corners(side);
    const glm::uvec2 low(glm::min(glm::min(corners[0], corners[1]), corners[2]) * size);
    const glm::uvec2 high(glm::max(glm::max(corners[0], corners[1]), corners[2]) * size);
    for (std::uint32_t y = low.y; y <= std::min(high.y, atlas_.height - 1); ++y) {
      for (std::uint32_t x = low.x; x <= std::min(high.x, atlas_.width - 1); ++x) {
        const cache::BilinearWeights& bilinear = bilinear_[std::size_t{y} * atlas_.width + x];
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

std::optional<Atlas> pack(std::span<TexelRectangle> rectangles, std::uint32_t most_side) {
  std::vector<std::size_t> order(rectangles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(rectangles[b].height, rectangles[b].width, a) <
           std::tuple(rectangles[a].height, rectangles[a].width, b);
  });
  double area = 0;
  std::uint32_t widest = 1;
  for (const TexelRectangle& rectangle : rectangles) {
    area += double{static_cast<double>(rectangle.width)} * rectangle.height;
    widest = std::max(widest, rectangle.width);
  }
  if (widest > most_side) return std::nullopt;
  const double square = std::ceil(std::sqrt(area));
  const auto width = static_cast<std::uint32_t>(
      std::clamp(square, static_cast<double>(widest), static_cast<double>(most_side)));
  std::uint64_t shelf = 0, x = 0, height = 0;
  for (const std::size_t i : order) {
    TexelRectangle& rectangle = rectangles[i];
    if (x + rectangle.width > width) {
      shelf = height;
      x = 0;
    }
    if (x == 0) height = shelf + rectangle.height;
    if (height > most_side) return std::nullopt;
    rectangle.x = static_cast<std::uint32_t>(x);
    rectangle.y = static_cast<std::uint32_t>(shelf);
    x += rectangle.width;
  }
  return Atlas{width, static_cast<std::uint32_t>(std::max<std::uint64_t>(height, 1))};
}

}  // namespace photile::bake
