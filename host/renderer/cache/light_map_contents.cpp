// Contents of light maps: saved, taken in again, and dropped in part.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include "cache/light_maps.hpp"
#include "cache/node_batch.hpp"
#include "maps/check_photons.hpp"
#include "photile/errors.hpp"

namespace photile::cache {
namespace {

/// Whether these are the light of `nodes` nodes, which the content of a file may not be.
bool are_values_of(const LightTable& values, std::size_t nodes, const SceneNeeds& needs) {
  if (!values.radiance.empty()) return false;
  for (const glm::vec3& light : values.irradiance) {
    if (!std::isfinite(light.x + light.y + light.z)) return false;
  }
  if (!needs.many_lights()) {
    return values.first.empty() && values.light.empty() &&
           values.irradiance.size() == nodes * needs.light_count;
  }
  return values.light.size() == values.irradiance.size() &&
         maps::are_rows(values.first, nodes, values.light.size()) &&
         maps::all_below(values.light, needs.light_count);
}

/// Whether the values hold light by the normal exactly where rays found it and the scene needs it.
bool tell_by_normal(const LightTable& values, bool requested) {
  return values.by_normal.size() == (requested ? values.irradiance.size() : 0) &&
         std::all_of(values.by_normal.begin(), values.by_normal.end(), [](const glm::vec4& light) {
           return std::isfinite(light.x + light.y + light.z + light.w);
         });
}

/// Whether these are errors and distances of `nodes` nodes, or empty.
bool are_errors_of(const std::vector<float>& error, const std::vector<float>& distance,
                   std::size_t nodes) {
  const auto sensible = [](float value) { return value >= 0; };  // infinite: nothing is near
  return (error.empty() || error.size() == nodes) && distance.size() == error.size() &&
         std::all_of(error.begin(), error.end(), sensible) &&
         std::all_of(distance.begin(), distance.end(), sensible);
}

/// Per tile: the cells whose first corner is to be kept, and those above such a cell.
std::vector<std::uint64_t> kept_cells(const Tiles& tiles, std::span<const std::uint8_t> keep) {
  std::vector<std::uint64_t> kept(tiles.size(), 0);
  for (auto index = static_cast<std::uint32_t>(tiles.size()); index-- > 0;) {  // the finest first
    const Tile& tile = tiles[index];
    for (std::uint32_t cell = 0; cell < 64; ++cell) {
      if ((tile.known >> cell & 1) == 0) continue;
      bool stays = keep[tile.corners(cell)[0]] != 0;
      if ((tile.split >> cell & 1) != 0) {
        const std::uint32_t x = cell & 7, y = cell >> 3;
        const std::uint64_t quarter = std::uint64_t{0b11'0000'0011} << ((y & 3) * 16 + (x & 3) * 2);
        stays = stays || (kept[tile.child[(y >> 2) * 2 + (x >> 2)]] & quarter) != 0;
      }
      if (stays) kept[index] |= std::uint64_t{1} << cell;
    }
  }
  return kept;
}

/// Per node of `nodes`: whether it is a corner of one of these cells.
std::vector<std::uint8_t> corners_of(const Tiles& tiles, std::span<const std::uint64_t> cells,
                                     std::size_t nodes) {
  std::vector<std::uint8_t> requested(nodes, 0);
  for (std::uint32_t index = 0; index < cells.size(); ++index) {
    for (std::uint32_t cell = 0; cell < 64; ++cell) {
      if ((cells[index] >> cell & 1) == 0) continue;
      for (const std::uint32_t node : tiles[index].corners(cell)) requested[node] = 1;
    }
  }
  return requested;
}

}  // namespace

LightMapContents LightMaps::contents() const {
  LightMapContents contents;
  for (const NodeCoordinates& at : coordinates_) {
    contents.nodes.push_back({at.chart, at.x, at.y});
  }
  contents.values = values_;
  contents.error = error_;
  contents.distance = distance_;
  for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
    const Tile& tile = tiles_[i];
    contents.tiles.push_back({tile.known, tile.split, tile.chart, tile.level, tile.x, tile.y});
  }
  return contents;
}

std::vector<std::uint32_t> LightMaps::forget(std::span<const std::uint8_t> keep) {
  const std::vector<std::uint64_t> kept = kept_cells(tiles_, keep);
  const std::vector<std::uint8_t> needed = corners_of(tiles_, kept, keep.size());
  std::vector<std::uint32_t> former, number(keep.size(), none);
  for (std::uint32_t node = 0; node < needed.size(); ++node) {
    if (needed[node] == 0) continue;
    number[node] = static_cast<std::uint32_t>(former.size());
    former.push_back(node);
  }
  const auto keep_needed = [&](auto& of_nodes) {
    if (of_nodes.empty()) return;
    for (std::size_t node = 0; node < former.size(); ++node)
      of_nodes[node] = of_nodes[former[node]];
    of_nodes.resize(former.size());
  };
  keep_needed(coordinates_);
  keep_needed(together_);
  keep_needed(error_);
  keep_needed(distance_);
  keep_needed(points_);
  keep_needed(seen_by_middle_);
  values_ = values_.gathered(former);
  tiles_.keep(kept, number);
  node_at_.clear();
  for (std::uint32_t node = 0; node < coordinates_.size(); ++node) {
    node_at_.insert({coordinates_[node], node});
  }
  cells_ = 0;
  for (const std::uint64_t cells : kept) cells_ += static_cast<std::uint64_t>(std::popcount(cells));
  return former;
}

void LightMaps::restore(LightMapContents contents) {
  const auto fit = [](bool fits) {
    if (!fits) throw InputError("saved light maps do not fit the scene; save them again");
  };
  const std::size_t count = contents.nodes.size();
  contents.values.lights = rays_.needs().light_count;
  fit(are_values_of(contents.values, count, rays_.needs()));
  fit(tell_by_normal(contents.values, rays_.needs().smooth_shading && !contents.error.empty()));
  fit(are_errors_of(contents.error, contents.distance, count));
  for (std::uint32_t node = 0; node < count; ++node) {
    const auto& [chart, x, y] = contents.nodes[node];
    fit(node_at_.insert({NodeCoordinates{chart, x, y}, node}).second);
  }
  std::vector<NodeCoordinates> coordinates;
  for (const auto& [chart, x, y] : contents.nodes) {
    fit(chart < charts_.size());
    coordinates.push_back({chart, x, y});
  }
  const PrimaryHits points = node_points(scene_, charts_, coordinates, levels_, false);
  append(std::move(contents.values), points, coordinates);
  error_ = std::move(contents.error);
  distance_ = std::move(contents.distance);
  const auto key_of = [](std::uint32_t chart, std::uint32_t level, std::uint32_t x,
                         std::uint32_t y) {
    return std::array{chart, level, x, y};
  };
  std::map<std::array<std::uint32_t, 4>, std::uint32_t> tile_at;
  for (const LightMapContents::Tile& saved : contents.tiles) {
    const auto& [known, split, chart, level, x, y] = saved;
    fit(chart < charts_.size() && static_cast<int>(level) < levels_ && (x & 7) == 0 &&
        (y & 7) == 0 && (split & ~known) == 0);
    std::uint32_t index = none;
    if (level == 0) {
      const Chart& lattice = charts_[chart];
      fit(x / 8 < lattice.root_columns() && y / 8 < lattice.root_rows());
      index =
          tiles_.tile_of({lattice.first_root + y / 8 * lattice.root_columns() + x / 8, 0, false});
    } else {
      const auto parent = tile_at.find(key_of(chart, level - 1, x / 16 * 8, y / 16 * 8));
      fit(parent != tile_at.end());
      index = tiles_[parent->second].child[(y / 8 & 1) * 2 + (x / 8 & 1)];
      fit(index != none);
    }
    fit(tile_at.emplace(key_of(chart, level, x, y), index).second);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;
    for (std::uint32_t cell = 0; cell < 64; ++cell) {
      if ((known >> cell & 1) != 0) cells.emplace_back(index, cell);
    }
    std::vector<NodeCoordinates> added;
    number_corners(cells, added);
    fit(added.empty());
    tiles_[index].known = known;
    cells_ += cells.size();
    for (std::uint32_t cell = 0; cell < 64; ++cell) {
      if ((split >> cell & 1) == 0) continue;
      fit(static_cast<int>(level) + 1 < levels_);
      tiles_.split(index, cell);
    }
  }
}

}  // namespace photile::cache
