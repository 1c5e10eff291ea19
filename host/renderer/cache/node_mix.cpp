#include "cache/node_mix.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "photile/scene.hpp"

namespace photile::cache {

namespace {

/// Large enough to make a task's cost vanish, small enough to share work.
constexpr std::size_t nodes_per_mix_task = 4096;

static_assert(sizeof(glm::vec3) == 3 * sizeof(float));

/// Four numbers that processors add and multiply at once: a vector of GCC's and Clang's.
struct Four {
  float four __attribute__((vector_size(4 * sizeof(float))));
};

/// Sums three floats at a time as four: the fourth, that of the next value, counts for nothing.
class Sum {
 public:
  void add(const glm::vec3& value, const Four& power) {
    Four values;
    std::memcpy(&values, &value, sizeof values);
    sum_.four += power.four * values.four;
  }
  /// Adds the last value, which has no next one.
  void add_last(const glm::vec3& value, const Four& power) {
    sum_.four += power.four * Four{{value.x, value.y, value.z, 0.0f}}.four;
  }
  glm::vec4 get() const { return {sum_.four[0], sum_.four[1], sum_.four[2], 0.0f}; }

 private:
  Four sum_{{0, 0, 0, 0}};
};

/// The sum of values [first, last), in this order.
///   power   of value i
template <class Power>
glm::vec4 summed(const LightTable& values, std::size_t first, std::size_t last,
                 const Power& power) {
  const std::size_t followed = std::min(last, values.irradiance.size() - 1);
  Sum sum;
  for (std::size_t i = first; i < followed; ++i) sum.add(values.irradiance[i], power(i));
  for (std::size_t i = std::max(first, followed); i < last; ++i) {
    sum.add_last(values.irradiance[i], power(i));
  }
  return sum.get();
}

/// Nodes [begin, end) where each holds all `lights` lights: a number that is known at compile time
/// lets processors work on several nodes at once.
template <std::size_t lights>
void mix_dense(const LightTable& values, std::size_t begin, std::size_t end,
               std::span<const Four> all_powers, std::vector<glm::vec4>& mixed) {
  std::array<Four, lights> powers;  // where nothing that is written can lie
  std::copy_n(all_powers.begin(), lights, powers.begin());
  const bool last = end * lights == values.irradiance.size();
  for (std::size_t node = begin; node < end - (last ? 1 : 0); ++node) {
    const glm::vec3* value = &values.irradiance[node * lights];
    Sum sum;
    for (std::size_t i = 0; i < lights; ++i) sum.add(value[i], powers[i]);
    mixed[node] = sum.get();
  }
  if (!last) return;
  const std::size_t first = (end - 1) * lights;
  mixed[end - 1] =
      summed(values, first, first + lights, [&](std::size_t i) { return powers[i - first]; });
}

using MixDense = void (*)(const LightTable&, std::size_t, std::size_t, std::span<const Four>,
                          std::vector<glm::vec4>&);

/// By number of lights, from one on.
template <std::size_t... less_one>
constexpr auto dense_mixes(std::index_sequence<less_one...>) {
  return std::array<MixDense, sizeof...(less_one)>{mix_dense<less_one + 1>...};
}

/// Mixes light by the normal, which is in proportion to the luminance of the lights.
///   layer   of value i
template <class Layer>
glm::vec4 summed_by_normal(const LightTable& values, std::size_t first, std::size_t last,
                           std::span<const glm::vec3> powers, const Layer& layer) {
  glm::vec4 sum(0.0f);
  for (std::size_t i = first; i < last; ++i) {
    const glm::dvec3 light(values.irradiance[i]);
    const double own = luminance(light);
    if (!(own > 0)) continue;
    sum += static_cast<float>(luminance(glm::dvec3(powers[layer(i)]) * light) / own) *
           values.by_normal[i];
  }
  return sum;
}

/// Whether a node holds a light, where nodes hold those alone that reach them.
bool holds(const LightTable& values, std::size_t node, std::uint16_t light) {
  unsigned found = 0;
  for (std::size_t i = values.first[node]; i < values.first[node + 1]; ++i) {
    found |= values.light[i] == light ? 1u : 0u;
  }
  return found != 0;
}

}  // namespace

void NodeMix::mix(const LightTable& values, std::size_t nodes, std::span<const glm::vec3> powers) {
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
  const bool smooth = !values.by_normal.empty();
  light_.resize(nodes);
  by_normal_.resize(smooth ? nodes : 0);
  powers_.assign(powers.begin(), powers.end());
  std::vector<Four> padded;
  for (const glm::vec3& power : powers) {
    padded.push_back(Four{{power.x, power.y, power.z, 0.0f}});
  }
  const std::size_t tasks = (nodes - first + nodes_per_mix_task - 1) / nodes_per_mix_task;
  tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t task) {
    const std::size_t begin = first + task * nodes_per_mix_task;
    const std::size_t end = std::min(nodes, begin + nodes_per_mix_task);
    if (dense) {
      constexpr auto mixes = dense_mixes(std::make_index_sequence<max_dense_lights>());
      mixes[powers.size() - 1](values, begin, end, padded, light_);
      if (!smooth) return;
    }
    for (std::size_t node = begin; node < end; ++node) {
      if (one_of_many && node < known &&
          !holds(values, node, static_cast<std::uint16_t>(changed.front()))) {
        continue;
      }
      const LightTable::Entries row = values.row(node);
      const auto layer = [&](std::size_t i) {
        return dense ? i - row.first : std::size_t{values.light[i]};
      };
      if (!dense) {
        light_[node] =
            summed(values, row.first, row.last, [&](std::size_t i) { return padded[layer(i)]; });
      }
      if (smooth) {
        by_normal_[node] = summed_by_normal(values, row.first, row.last, powers, layer);
      }
    }
  });
}

}  // namespace photile::cache
