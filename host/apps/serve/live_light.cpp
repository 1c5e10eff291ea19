#include "serve/live_light.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "bake/baked_light.hpp"
#include "photile/defaults.hpp"
#include "photile/limits.hpp"
#include "publish/sections.hpp"

namespace photile::serve {
namespace {

/// Texels on a side of a tile.
constexpr std::uint32_t tile_side = 128;
/// Metres between texels: soft light needs no more, and pictures at rest have none.
constexpr double live_texel = 0.04;
/// Metres, of the lattices that charts are grown for.
constexpr double chart_spacing = 0.25;
/// Of the time, at most one part in this many goes into taking light.
constexpr double seldom = 5;
/// Share of a first picture that may show the light around it, whose colour is another.
constexpr double most_unlit = 0.12;
/// Texels that are taken beside those in view.
constexpr std::size_t texels_beside = 60'000;
/// Rays that find what is in view, across and down.
constexpr int rays_across = 96, rays_down = 64;
constexpr int quickest_packing = 1;

bake::BakeParameters live_parameters(std::size_t layers) {
  bake::BakeParameters parameters;
  parameters.texel = live_texel;
  parameters.exact = false;
  parameters.most_texels = limits::max_published_texels / std::max<std::size_t>(1, layers);
  return parameters;
}

std::uint32_t tiles_across(const bake::LightAtlas& atlas) {
  return (atlas.width() + tile_side - 1) / tile_side;
}

}  // namespace

LiveLight::LiveLight(const Scene& scene, std::size_t layers, std::function<void()> changed)
    : scene_(scene),
      layers_(layers),
      changed_(std::move(changed)),
      rays_(scene),
      charts_(scene, chart_spacing, defaults::group_angle_degrees),
      atlas_(scene, charts_, sides_to_draw(), live_parameters(layers)),
      part_of_chart_(charts_.size(), none),
      parts_(atlas_.chart_count()),
      light_(layers, std::vector<glm::vec3>(atlas_.area(), glm::vec3(0.0f))),
      tiles_(std::size_t{tiles_across(atlas_)} * ((atlas_.height() + tile_side - 1) / tile_side)) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    part_of_chart_[atlas_.chart(i)] = static_cast<std::uint32_t>(i);
  }
}

/// Of each triangle the sides that are open: which of them are lit is not known yet.
std::vector<std::uint32_t> LiveLight::sides_to_draw() const {
  const std::vector<std::uint8_t> open = bake::open_sides(rays_);
  std::vector<std::uint32_t> sides;
  for (std::uint32_t t = 0; t < scene_.triangle_count(); ++t) {
    const std::uint32_t front = oriented(t, scene_.front_side[t]);
    const std::uint32_t back = oriented(t, 1 - scene_.front_side[t]);
    for (const std::uint32_t side : {oriented(t, 0), oriented(t, 1)}) {
      const bool shows = open[side] != 0 || (side == front && open[back] == 0);
      if (shows && bake::is_drawn(scene_, charts_, side)) sides.push_back(side);
    }
  }
  return sides;
}

/// Those that take most of the picture first.
std::vector<std::uint32_t> LiveLight::parts_in_view(const Camera& camera) const {
  const PrimaryHitParameters film{rays_across, rays_down, 1};
  const PrimaryHitBatch seen = trace_primary_hits(rays_, camera, film, 0, rays_down);
  std::map<std::uint32_t, std::size_t> hits;
  for (const std::uint32_t face : seen.hits.oriented_face) {
    const std::uint32_t chart = charts_.chart_of()[face];
    if (chart != none && part_of_chart_[chart] != none) ++hits[part_of_chart_[chart]];
  }
  std::vector<std::uint32_t> parts;
  for (const auto& [part, count] : hits) parts.push_back(part);
  std::stable_sort(parts.begin(), parts.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return hits[a] > hits[b]; });
  return parts;
}

void LiveLight::take(const Camera& camera, const view::MapGeneration& maps,
                     const DrawnFrame& drawn) {
  const bool too_soon = since_taken_.seconds() < (seldom - 1) * cost_ ||
                        (version() == 0 && drawn.unlit_fraction > most_unlit);
  if (drawn.lacking > 0 && too_soon) return;
  const Stopwatch watch;
  // What other maps gave is not final, but for those of a first picture.
  if (maps_ && maps_ != &maps && maps_ != maps.coarser.get()) {
    std::fill(parts_.begin(), parts_.end(), Part());
  }
  maps_ = &maps;
  std::vector<std::uint32_t> chosen;
  std::size_t texels = 0;
  const auto choose = [&](std::uint32_t i) {
    Part& part = parts_[i];
    if (!std::exchange(part.known, true)) {
      charts_.prepare(atlas_.chart(i));
      atlas_.add_points(i, part.points);
    }
    if (part.points.texels.empty()) return;
    chosen.push_back(i);
    texels += part.points.texels.size();
    part.taken = true;
  };
  for (const std::uint32_t part : parts_in_view(camera)) choose(part);
  // Nothing delays the first light.
  const std::size_t most = version() == 0 && texels > 0 ? 0 : texels + texels_beside;
  for (std::uint32_t i = 0; i < parts_.size() && texels < most; ++i) {
    if (!parts_[i].taken) choose(i);
  }
  if (texels == 0) return;
  PrimaryHits points;
  std::vector<std::size_t> texel_of;
  for (const std::uint32_t i : chosen) {
    const auto& [places, hits] = parts_[i].points;
    texel_of.insert(texel_of.end(), places.begin(), places.end());
    points.position.insert(points.position.end(), hits.position.begin(), hits.position.end());
    points.oriented_face.insert(points.oriented_face.end(), hits.oriented_face.begin(),
                                hits.oriented_face.end());
  }
  const std::uint32_t across = tiles_across(atlas_);
  std::vector<std::uint8_t> changed(tiles_.size());
  const std::vector<std::uint8_t> is_final = maps.renderer->frames().light_at(
      points, !maps.whole,
      [&](std::size_t layer, std::span<const glm::vec3> found) {
        for (std::size_t i = 0; i < found.size(); ++i) {
          const std::size_t texel = texel_of[i];
          if (light_[layer][texel] == found[i]) continue;
          light_[layer][texel] = found[i];
          changed[texel / atlas_.width() / tile_side * across +
                  texel % atlas_.width() / tile_side] = 1;
        }
      },
      maps.coarser_view());
  std::size_t next = 0;
  for (const std::uint32_t i : chosen) {
    bake::LightAtlas::TexelPoints left;
    const auto& [places, hits] = parts_[i].points;
    for (std::size_t texel = 0; texel < places.size(); ++texel, ++next) {
      if (is_final[next] != 0) continue;
      left.texels.push_back(places[texel]);
      left.hits.position.push_back(hits.position[texel]);
      left.hits.oriented_face.push_back(hits.oriented_face[texel]);
    }
    parts_[i].points = std::move(left);
  }
  if (version() == 0) note_levels(texel_of);
  code(changed);
  cost_ = watch.seconds();
  since_taken_ = Stopwatch();
}

/// The brightest and the mean light of the first state. Other texels have the mean, until they are
/// taken.
void LiveLight::note_levels(std::span<const std::size_t> taken) {
  std::vector<std::uint8_t> is_taken(atlas_.area());
  for (const std::size_t texel : taken) is_taken[texel] = 1;
  const std::lock_guard lock(mutex_);
  for (std::vector<glm::vec3>& light : light_) {
    double brightest = 0;
    glm::dvec3 sum(0.0);
    for (const std::size_t texel : taken) {
      brightest = std::max(brightest, luminance(glm::dvec3(light[texel])));
      sum += glm::dvec3(light[texel]);
    }
    brightest_.push_back(brightest > 0 ? brightest : 1.0);
    const glm::vec3 mean(sum / static_cast<double>(std::max<std::size_t>(1, taken.size())));
    mean_.push_back(mean / static_cast<float>(brightest_.back()));
    for (std::size_t texel = 0; texel < light.size(); ++texel) {
      if (is_taken[texel] == 0) light[texel] = mean;
    }
  }
}

void LiveLight::code(const std::vector<std::uint8_t>& changed) {
  const std::uint32_t across = tiles_across(atlas_);
  std::vector<Tile> coded(tiles_.size());
  tbb::parallel_for(std::size_t{0}, coded.size(), [&](std::size_t tile) {
    if (changed[tile] == 0) return;
    const std::uint32_t left = static_cast<std::uint32_t>(tile % across) * tile_side;
    const std::uint32_t top = static_cast<std::uint32_t>(tile / across) * tile_side;
    std::vector<glm::vec3> texels(layers_ * tile_side * tile_side, glm::vec3(0.0f));
    for (std::size_t layer = 0; layer < layers_; ++layer) {
      for (std::uint32_t y = top; y < std::min(top + tile_side, atlas_.height()); ++y) {
        for (std::uint32_t x = left; x < std::min(left + tile_side, atlas_.width()); ++x) {
          texels[(layer * tile_side + y - top) * tile_side + x - left] =
              light_[layer][std::size_t{y} * atlas_.width() + x] /
              static_cast<float>(brightest_[layer]);
        }
      }
    }
    publish::Sections sections(quickest_packing);
    coded[tile].brightest = sections.add_light("light", texels, tile_side);
    coded[tile].bytes = sections.bytes();
  });
  {
    const std::lock_guard lock(mutex_);
    ++version_;
    for (std::size_t tile = 0; tile < coded.size(); ++tile) {
      if (changed[tile] == 0) continue;
      coded[tile].version = version_;
      tiles_[tile] = std::move(coded[tile]);
    }
  }
  changed_();
}

std::uint64_t LiveLight::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

std::string LiveLight::since(std::uint64_t version) const {
  const std::lock_guard lock(mutex_);
  nlohmann::json header{{"version", version_}, {"side", tile_side}, {"brightest", brightest_}};
  for (const glm::vec3& mean : mean_) header["mean"].push_back({mean.x, mean.y, mean.z});
  std::string bytes;
  header["tiles"] = nlohmann::json::array();
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const Tile& tile = tiles_[i];
    if (tile.version <= version) continue;
    const std::size_t across = tiles_across(atlas_);
    header["tiles"].push_back({{"x", i % across * tile_side},
                               {"y", i / across * tile_side},
                               {"at", bytes.size()},
                               {"packed", tile.bytes.size()},
                               {"brightest", tile.brightest}});
    bytes += tile.bytes;
  }
  const std::string text = header.dump();
  return fmt::format("{:08x}", text.size()) + text + bytes;
}

}  // namespace photile::serve
