#include "light_maps/node_mix.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace photile::light_maps {
namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t nodes_per_mix_task = 4096;

static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

/// Sums three floats at a time as four, which processors have vectors of: the fourth, that of the
/// next value, counts for nothing.
class Sum {
 public:
  void add(const glm::vec3& value, const glm::vec4& power) {
    const float* four = &value.x;
    for (int i = 0; i < 4; ++i) sum_[i] += power[i] * four[i];
  }
  /// Of the last value, which has no next one.
  void add_last(const glm::vec3& value, const glm::vec4& power) {
    for (int i = 0; i < 3; ++i) sum_[i] += power[i] * value[i];
  }
  glm::vec4 get() const { return {sum_[0], sum_[1], sum_[2], 0.0f}; }

 private:
  alignas(16) float sum_[4] = {};
};

/// The sum over the lights of a node, always in the order in which it holds them. Nodes are `dense`
/// where each holds all lights.
template <bool dense>
glm::vec4 mixed(const Estimates& values, std::size_t node, std::span<const glm::vec4> powers) {
  const std::size_t first = dense ? node * powers.size() : values.first[node];
  const std::size_t last = dense ? first + powers.size() : values.first[node + 1];
  const std::size_t followed = std::min(last, values.irradiance.size() - 1);
  const auto power = [&](std::size_t i) {
    if constexpr (dense)
      return powers[i - first];
    else
      return powers[values.light[i]];
  };
  Sum sum;
  for (std::size_t i = first; i < followed; ++i) sum.add(values.irradiance[i], power(i));
  for (std::size_t i = std::max(first, followed); i < last; ++i) {
    sum.add_last(values.irradiance[i], power(i));
  }
  return sum.get();
}

/// Whether a node holds light of a lamp, where nodes hold those alone that reach them.
bool holds(const Estimates& values, std::size_t node, std::uint16_t light) {
  unsigned found = 0;
  for (std::size_t i = values.first[node]; i < values.first[node + 1]; ++i) {
    found |= values.light[i] == light ? 1u : 0u;
  }
  return found != 0;
}

}  // namespace

void NodeMix::mix(const Estimates& values, std::size_t nodes, std::span<const glm::vec3> powers) {
  std::vector<std::size_t> changed;
  for (std::size_t light = 0; light < powers.size(); ++light) {
    if (powers_.size() != powers.size() || powers[light] != powers_[light]) {
      changed.push_back(light);
    }
  }
  const std::size_t known = light_.size();
  const std::size_t first = changed.empty() ? known : 0;
  const bool dense = values.first.empty();
  const bool one_of_many = changed.size() == 1 && !dense;
  light_.resize(nodes);
  powers_.assign(powers.begin(), powers.end());
  std::vector<glm::vec4> padded;
  for (const glm::vec3& power : powers) padded.emplace_back(power, 0.0f);
  const std::size_t tasks = (nodes - first + nodes_per_mix_task - 1) / nodes_per_mix_task;
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    const std::size_t begin = first + task * nodes_per_mix_task;
    const std::size_t end = std::min(nodes, begin + nodes_per_mix_task);
    for (std::size_t node = begin; node < end; ++node) {
      if (one_of_many && node < known &&
          !holds(values, node, static_cast<std::uint16_t>(changed.front()))) {
        continue;
      }
      light_[node] = dense ? mixed<true>(values, node, padded) : mixed<false>(values, node, padded);
    }
  });
}

}  // namespace photile::light_maps
