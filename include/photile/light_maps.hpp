// Light maps, as a rendering is asked for them, and as they are saved.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "photile/light_table.hpp"

namespace photile {

/// Whether the light of matt surfaces is read from light maps.
enum class LightMapMode {
  off,       ///< an estimate at each hit: the method of the paper
  on,        ///< nodes, which rays value or the photon estimate (light_map_rays)
  automatic  ///< on for pictures, but with naive maps and with several passes
};

/// "off", "on", "auto".
std::string_view name_of(LightMapMode mode);
inline constexpr std::array all_light_map_modes = {LightMapMode::off, LightMapMode::on,
                                                   LightMapMode::automatic};

/// The contents of light maps, without what follows from the scene and the parameters.
struct LightMapContents {
  struct Coordinates {
    std::uint32_t chart, x, y;  ///< in cells of the finest level
  };
  struct Tile {
    std::uint64_t known, split;  ///< cells, bit y * 8 + x: whose corners are valued; refined
    std::uint32_t chart, level, x, y;
  };
  std::string settings;  ///< in words: what the light depends on beside the scene and the photons
  std::vector<Coordinates> nodes;
  LightTable values;  ///< of the nodes
  std::vector<float> error,
      distance;             ///< of the nodes: standard error, and metres to what lights them
  std::vector<Tile> tiles;  ///< each after the one that it refines
};

}  // namespace photile
