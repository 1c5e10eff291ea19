#include "cache/frame_view.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <tuple>
#include <unordered_map>

#include "cache/charts.hpp"
#include "photile/limits.hpp"
#include "photile/scene.hpp"
#include "photile/statistics.hpp"
#include "trace/surface.hpp"

namespace photile::cache {
namespace {

/// Seconds of filling a position, before they are known: by photons, and by rays at it and around
/// it.
constexpr double seconds_of_photons = 20e-6, seconds_of_rays = 10e-3;
/// Seconds that the first batch of a frame takes, and that any takes at most: after each, it is
/// asked whether the frame is to end.
constexpr double first_batch = 0.015, largest_batch = 0.1;

/// Light in space is gathered anew when the number of filled nodes has grown by this factor.
constexpr double more_nodes = 1.1;

/// A corner of a cell may be this many times as bright as all others.
constexpr double most_over_others = 3;

/// Where every corner of a cell weighs less, as on a moulding whose nodes lie in its grooves, the
/// light around the cell replaces theirs by as much.
constexpr float enclosed_weight = 0.25f;

double luminance_of(const glm::vec4& light) { return luminance(glm::dvec3(light)); }

/// By how much the luminance of nodes differs.
double difference(std::span<const glm::vec4> light, const BilinearWeights& bilinear) {
  const auto at = [&](std::size_t corner) { return luminance_of(light[bilinear.node[corner]]); };
  const auto [least, most] = std::minmax({at(0), at(1), at(2), at(3)});
  return most - least;
}

/// Of the 64 cells of a tile, y * 8 + x.
constexpr std::uint64_t first_column = 0x0101010101010101, first_row = 0xff;

std::uint64_t undivided(const Tile& tile) { return tile.known & ~tile.split; }

/// Cells of a tile beside which, on one side, there is a cell of their level that is not split.
struct Beside {
  std::uint64_t left = 0, right = 0, below = 0, above = 0;
};

Beside undivided_beside(const Tiles& tiles, const Tile& tile) {
  const auto beyond = [&](std::uint32_t columns, std::uint32_t rows) {
    const std::uint32_t index =
        tiles.tile_at(tile.chart, tile.level, tile.x + columns, tile.y + rows);
    return index == none ? 0 : undivided(tiles[index]);
  };
  const std::uint64_t own = undivided(tile);
  return {.left = (own & ~(first_column << 7)) << 1 | (beyond(-8u, 0) >> 7 & first_column),
          .right = (own & ~first_column) >> 1 | (beyond(8, 0) & first_column) << 7,
          .below = own << 8 | beyond(0, -8u) >> 56,
          .above = own >> 8 | (beyond(0, 8) & first_row) << 56};
}

}  // namespace

class FrameView::Softening {
 public:
  explicit Softening(FrameView& view)
      : view_(view),
        tiles_(view.maps_.tiles()),
        brightest_other_(view.weight_.size()),
        is_mean_(view.weight_.size()) {}

  /// A cell that was lacking: what is still lacking within it.
  void add(std::uint32_t tile_index, std::uint32_t cell) {
    const Tile& tile = tiles_[tile_index];
    const std::uint32_t column = cell & 7, row = cell >> 3;
    if ((tile.known >> cell & 1) != 0) {
      if ((tile.split >> cell & 1) == 0) return;
      const std::uint32_t child = tile.child[(row >> 2) * 2 + (column >> 2)];
      const std::uint32_t first = (row & 3) * 16 + (column & 3) * 2;
      for (const std::uint32_t part : {first, first + 1, first + 8, first + 9}) add(child, part);
      return;
    }
    if (tile.level == 0) return;  // there is no larger cell to be seen
    const std::uint32_t x = tile.x + column, y = tile.y + row;
    std::array<std::uint32_t, 4> shown;
    for (std::uint32_t i = 0; i < 4; ++i) {
      shown[i] = tiles_.node(tile.chart, tile.level - 1, (x >> 1) + (i & 1), (y >> 1) + (i >> 1));
      view_.lacks_beside_[shown[i]] = 1;
    }
    add_shown(shown, tile.level - 1);
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t at_x = x + (corner & 1), at_y = y + (corner >> 1);
      if (((at_x | at_y) & 1) == 0) continue;  // a corner of the larger cell, too
      const std::uint32_t node = tiles_.node(tile.chart, tile.level, at_x, at_y);
      if (node != none) is_mean_[node] = view_.lacks_beside_[node] = 1;
    }
  }

  /// All cells that show their own nodes.
  void add_all_undivided() {
    borders_ = true;
    for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
      const Tile& tile = tiles_[i];
      for (std::uint64_t cells = undivided(tile); cells != 0; cells &= cells - 1) {
        add_shown(tile.corners(static_cast<std::uint32_t>(std::countr_zero(cells))), tile.level);
      }
    }
  }

  void apply() {
    for (std::size_t node = 0; node < brightest_other_.size(); ++node) {
      const double own = luminance_of(view_.light_[node]);
      const double most = most_over_others * brightest_other_[node];
      if (own <= most || most == 0) continue;
      const auto fraction = static_cast<float>(most / own);
      view_.light_[node] *= fraction;
      if (!view_.by_normal_.empty()) view_.by_normal_[node] *= fraction;
    }
    // A tile comes after the one that it refines: nodes are known before those between them.
    for (std::uint32_t i = 0; i < tiles_.size(); ++i) {
      const Tile& tile = tiles_[i];
      const std::uint64_t refined = tile.known & tile.split;
      if (refined == 0) continue;
      const Beside beside = borders_ ? undivided_beside(tiles_, tile) : Beside{};
      for (std::uint64_t cells = refined; cells != 0; cells &= cells - 1) {
        take_means(tile, static_cast<std::uint32_t>(std::countr_zero(cells)), beside);
      }
    }
  }

 private:
  /// The corners of a cell that a picture reads.
  void add_shown(const std::array<std::uint32_t, 4>& nodes, std::uint32_t level) {
    const auto spacing =
        static_cast<float>(std::ldexp(view_.maps_.charts().spacing(), -static_cast<int>(level)));
    const std::span<const glm::vec4> light = view_.mix_.light();
    for (const std::uint32_t node : nodes) {
      view_.weight_[node] = std::min(
          view_.weight_[node], std::max(least_node_weight, view_.maps_.distance(node) / spacing));
      for (const std::uint32_t other : nodes) {
        if (other == node) continue;
        brightest_other_[node] = std::max(brightest_other_[node], luminance_of(light[other]));
      }
    }
  }

  /// Gives nodes within a cell the mean of the corners between which they lie, where they are on
  /// the border of a larger cell, or one of those corners is.
  void take_means(const Tile& tile, std::uint32_t cell, const Beside& beside) {
    const std::uint32_t column = cell & 7, row = cell >> 3;
    const Tile& child = tiles_[tile.child[(row >> 2) * 2 + (column >> 2)]];
    const std::array<std::uint32_t, 4> corners = tile.corners(cell);
    const std::uint32_t* nodes = &child.node[(row & 3) * 18 + (column & 3) * 2];
    take_mean(nodes[1], beside.below >> cell & 1, {corners[0], corners[1]});
    take_mean(nodes[9], beside.left >> cell & 1, {corners[0], corners[2]});
    take_mean(nodes[10], false, {corners[0], corners[1], corners[2], corners[3]});
    take_mean(nodes[11], beside.right >> cell & 1, {corners[1], corners[3]});
    take_mean(nodes[19], beside.above >> cell & 1, {corners[2], corners[3]});
  }

  void take_mean(std::uint32_t node, bool on_border, std::initializer_list<std::uint32_t> corners) {
    if (node == none) return;
    const auto is_one_of = [&](std::span<const std::uint8_t> those) {
      return std::any_of(corners.begin(), corners.end(),
                         [&](std::uint32_t corner) { return those[corner] != 0; });
    };
    if (!on_border && is_mean_[node] == 0 && !is_one_of(is_mean_)) return;
    is_mean_[node] = 1;
    if (is_one_of(view_.lacks_beside_)) view_.lacks_beside_[node] = 1;
    float sum = 0;
    glm::vec4 light(0.0f), by_normal(0.0f);
    for (const std::uint32_t corner : corners) {
      const float weight = view_.weight_[corner];
      sum += weight;
      light += weight * view_.light_[corner];
      if (!view_.by_normal_.empty()) by_normal += weight * view_.by_normal_[corner];
    }
    view_.weight_[node] = sum / static_cast<float>(corners.size());
    view_.light_[node] = light / sum;
    if (!view_.by_normal_.empty()) view_.by_normal_[node] = by_normal / sum;
  }

  FrameView& view_;
  const Tiles& tiles_;
  bool borders_ = false;                 ///< also of cells that lack nothing
  std::vector<double> brightest_other_;  ///< per node: of the cells that it is a corner of
  std::vector<std::uint8_t> is_mean_;    ///< per node: of the nodes between which it lies
};

FrameView::FrameView(const Scene& scene, LightMaps& maps)
    : scene_(scene),
      maps_(maps),
      state_(maps.charts().size(), hidden),
      seconds_per_sample_(maps.source().surroundings().rounds > 0 ? seconds_of_rays
                                                                  : seconds_of_photons) {}

/// The latest frame is the one before.
void FrameView::begin_frame() {
  if (bound_ == 0) return;
  ++frame_;
  const std::size_t nodes = maps_.statistics().nodes;
  const std::uint64_t own = maps_.bytes();
  if (own + maps_.source().bytes() <= bound_ || nodes == 0) return;
  maps_.source().forget();
  if (own <= bound_ / 2) return;
  seen_.resize(nodes, 0);
  // The oldest frame whose cells stay: the nodes that are kept take half of the memory.
  const auto staying = static_cast<std::size_t>(
      static_cast<double>(bound_) / 2 / static_cast<double>(own) * static_cast<double>(nodes));
  std::vector<std::uint32_t> newest_first = seen_;
  const auto nth = newest_first.begin() + static_cast<std::ptrdiff_t>(std::min(staying, nodes - 1));
  std::nth_element(newest_first.begin(), nth, newest_first.end(), std::greater<>());
  const std::uint32_t oldest = std::min(*nth + 1, frame_ - 1);
  std::vector<std::uint8_t> keep(nodes);
  for (std::size_t node = 0; node < nodes; ++node) keep[node] = seen_[node] >= oldest ? 1 : 0;
  // A view that needs more memory than allowed keeps its nodes; a few nodes are not worth the work.
  const auto stay = std::count(keep.begin(), keep.end(), std::uint8_t{1});
  if (static_cast<std::size_t>(stay) > nodes - nodes / 4) return;
  const std::vector<std::uint32_t> former = maps_.forget(keep);
  // Nodes and tiles have other numbers now.
  mix_ = NodeMix();
  softened_.clear();
  for (std::size_t i = 0; i < former.size(); ++i) seen_[i] = seen_[former[i]];
  seen_.resize(former.size());
}

void FrameView::mix(std::span<const glm::vec3> powers, bool soft) {
  const std::size_t nodes = maps_.statistics().nodes;
  if (bound_ > 0) seen_.resize(nodes, 0);
  soft_ = soft;
  const std::span<const glm::vec3> former = mix_.powers();
  const bool relit = !std::equal(powers.begin(), powers.end(), former.begin(), former.end());
  const std::size_t weights = soft || !softened_.empty() ? nodes : 0;
  const bool is_known = light_.size() == nodes && weight_.size() == weights;
  if (!relit && is_known && softened_.empty()) return;
  mix_.mix(maps_.values(), nodes, powers);
  light_.assign(mix_.light().begin(), mix_.light().end());
  by_normal_.assign(mix_.by_normal().begin(), mix_.by_normal().end());
  weight_.assign(weights, 1.0f);
  lacks_beside_.assign(weights, 0);
  if (weights > 0) {
    Softening softening(*this);
    for (const MissingCell& cell : softened_) softening.add(cell.tile, cell.cell);
    if (soft) softening.add_all_undivided();
    softening.apply();
  }
  const auto known = static_cast<double>(ambient_nodes_);
  if (!relit && static_cast<double>(nodes) <= more_nodes * known) return;
  ambient_.gather(maps_, scene_, mix_.light());
  ambient_nodes_ = nodes;
}

std::optional<glm::vec3> FrameView::irradiance(std::uint32_t oriented_face,
                                               const glm::vec3& position, std::uint32_t packet,
                                               bool& lacks, bool& softened) const {
  BilinearWeights bilinear{};
  const std::uint32_t chart = maps_.charts().chart_of()[oriented_face];
  if (const auto cell = maps_.tiles().find(chart, position, bilinear)) {
    const bool empty = bilinear.node[0] == none;
    lacks = true;
    std::vector<MissingSample>& samples = found_.local();
    if (samples.empty() || samples.back().cell != *cell || samples.back().packet != packet) {
      samples.push_back({*cell, empty, chart, packet, 0, position, oriented_face});
    }
    samples.back().gain += empty ? 1 : difference(mix_.light(), bilinear);
    if (empty) return std::nullopt;
  }
  const std::atomic_ref<std::uint8_t> state(state_[chart]);
  if (state.load(std::memory_order_relaxed) != shown) {
    state.store(waits, std::memory_order_relaxed);
    return std::nullopt;
  }
  if (bound_ > 0) {
    const std::atomic_ref<std::uint32_t> seen(seen_[bilinear.node[0]]);
    if (seen.load(std::memory_order_relaxed) != frame_) {
      seen.store(frame_, std::memory_order_relaxed);
    }
  }
  softened |= weigh(bilinear);
  return between(bilinear, oriented_face, position);
}

bool FrameView::weigh(BilinearWeights& bilinear) const {
  if (weight_.empty()) return false;
  bool softened = false;
  float sum = 0, most = 0;
  for (std::size_t i = 0; i < bilinear.node.size(); ++i) {
    const float weight = weight_[bilinear.node[i]];
    softened |= lacks_beside_[bilinear.node[i]] != 0;
    sum += bilinear.weight[i] *= weight;
    most = std::max(most, weight);
  }
  const float share = std::min(1.0f, most / enclosed_weight);
  for (float& weight : bilinear.weight) weight *= share / sum;
  return softened;
}

glm::vec3 FrameView::between(const BilinearWeights& bilinear, std::uint32_t oriented_face,
                             const glm::vec3& position) const {
  const auto interpolated = [&](std::span<const glm::vec4> of) {
    return (bilinear.weight[0] * of[bilinear.node[0]] + bilinear.weight[1] * of[bilinear.node[1]]) +
           (bilinear.weight[2] * of[bilinear.node[2]] + bilinear.weight[3] * of[bilinear.node[3]]);
  };
  glm::vec3 light(interpolated(light_));
  if (!by_normal_.empty()) {
    light = turned(light, interpolated(by_normal_),
                   trace::shading_normal(scene_, oriented_face, position));
  }
  const float of_nodes =
      (bilinear.weight[0] + bilinear.weight[1]) + (bilinear.weight[2] + bilinear.weight[3]);
  if (weight_.empty() || of_nodes > 1 - 1e-5f) return light;  // the rest is rounding
  return light + (1 - of_nodes) * ambient(oriented_face, position);
}

bool FrameView::find(std::uint32_t oriented_face, const glm::vec3& position,
                     BilinearWeights& bilinear, bool& is_final) const {
  const std::uint32_t chart = maps_.charts().chart_of()[oriented_face];
  const bool lacks = maps_.tiles().find(chart, position, bilinear).has_value();
  if (bilinear.node[0] == none || state_[chart] != shown) return false;
  is_final = !lacks && !soft_;
  if (is_final) maps_.keep_visible(oriented_face, position, bilinear);
  is_final &= !weigh(bilinear);
  return true;
}

glm::vec3 FrameView::ambient(std::uint32_t oriented_face, const glm::vec3& position) const {
  return ambient_.irradiance(position, glm::vec3(face_normal(scene_, oriented_face)));
}

void FrameView::end_picture() {
  missing_.clear();
  for (std::vector<MissingSample>& found : found_) {
    missing_.insert(missing_.end(), found.begin(), found.end());
    found.clear();
  }
  std::unordered_map<std::uint32_t, std::array<double, 2>> gain_of_chart;
  for (const MissingSample& sample : missing_)
    gain_of_chart[sample.chart][sample.empty] += sample.gain;
  for (MissingSample& sample : missing_) sample.gain = gain_of_chart[sample.chart][sample.empty];
  std::sort(missing_.begin(), missing_.end(), [](const auto& a, const auto& b) {
    return std::tie(b.empty, b.gain, a.chart, a.cell) < std::tie(a.empty, a.gain, b.chart, b.cell);
  });
  const auto is_repeated = [](const MissingSample& a, const MissingSample& b) {
    return a.empty && a.cell == b.cell;
  };
  missing_.erase(std::unique(missing_.begin(), missing_.end(), is_repeated), missing_.end());
}

std::size_t FrameView::empty() const {
  return static_cast<std::size_t>(std::count_if(
      missing_.begin(), missing_.end(), [](const MissingSample& sample) { return sample.empty; }));
}

bool FrameView::show_complete() {
  for (const MissingSample& sample : missing_) {
    if (sample.empty && state_[sample.chart] == waits) state_[sample.chart] = hidden;
  }
  const auto any = std::count(state_.begin(), state_.end(), waits);
  std::replace(state_.begin(), state_.end(), std::uint8_t{waits}, std::uint8_t{shown});
  return any > 0;
}

bool FrameView::soften() {
  const bool any_before = !softened_.empty();
  softened_.clear();
  for (const MissingSample& sample : missing_) {
    if (sample.cell.has_tile && (softened_.empty() || softened_.back() != sample.cell)) {
      softened_.push_back(sample.cell);
    }
  }
  return softened_.empty() == any_before;
}

void FrameView::fill(double seconds, const FrameFilling& filling, const Progress& progress) {
  const std::size_t without_level = empty();
  const std::size_t last = without_level > 0 ? without_level : missing_.size();
  const Stopwatch stopwatch;
  std::size_t first = 0;
  double left = seconds;
  do {
    // As many as the time allows: one batch too many makes the frame late.
    const double of_batch = std::min(
        left, first == 0 ? first_batch : std::clamp(seconds / 4, first_batch, largest_batch));
    const std::size_t count =
        std::isinf(left)
            ? last
            : std::clamp<std::size_t>(static_cast<std::size_t>(of_batch / seconds_per_sample_), 1,
                                      last - first);
    PrimaryHits hits;
    for (const MissingSample& sample : std::span(missing_).subspan(first, count)) {
      hits.position.push_back(sample.position);
      hits.oriented_face.push_back(sample.oriented_face);
    }
    const Stopwatch batch_watch;
    maps_.fill(hits, progress, without_level > 0 ? 1 : limits::max_light_map_levels);
    const double latest = batch_watch.seconds() / static_cast<double>(count);
    seconds_per_sample_ += 0.5 * (latest - seconds_per_sample_);
    first += count;
    left = filling.has_ended() ? 0 : seconds - stopwatch.seconds();
  } while (first < last && left > 0);
}

}  // namespace photile::cache
