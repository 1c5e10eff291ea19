#include "photile/light_table.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "common/touched_memory.hpp"
#include "light/light_at_points.hpp"
#include "light/row_sum.hpp"
#include "light/table_bytes.hpp"
#include "photile/defaults.hpp"
#include "photile/light_layers.hpp"

namespace photile {
namespace {

void append_entries(LightTable& to, const LightTable& from, LightTable::Entries entries) {
  tbb::task_group columns;
  light::for_each_column(to, from, [&](auto& column, const auto& values, std::size_t width) {
    if (values.empty()) return;
    columns.run([&column, &values, first = entries.first * width, last = entries.last * width] {
      column.insert(column.end(), values.data() + first, values.data() + last);
    });
  });
  columns.wait();
}

/// The variance of the mean of independent values.
template <class T>
double squared_error_of_mean(std::span<const T> values) {
  const auto count = static_cast<double>(values.size());
  if (values.size() < 2) return 0;
  double mean = 0, squares = 0;
  for (const T value : values) mean += static_cast<double>(value) / count;
  for (const T value : values) {
    const double difference = static_cast<double>(value) - mean;
    squares += difference * difference;
  }
  return squares / (count * (count - 1));
}

double error_of(const LightTable& table, std::size_t entry, double of_shared) {
  const auto count = static_cast<std::size_t>(table.batches);
  const double shared = table.shared_variance.empty() ? 0.0 : double{table.shared_variance[entry]};
  return std::sqrt(squared_error_of_mean(std::span(table.batch).subspan(entry * count, count)) +
                   of_shared * of_shared * shared);
}

}  // namespace

LightTable::LightTable(const SceneNeeds& needs)
    : LightTable(needs.light_count, needs.many_lights()) {}

LightTable::LightTable(std::size_t of_scene, bool is_sparse) : lights(of_scene) {
  if (is_sparse) first.push_back(0);
}

std::size_t LightTable::rows() const {
  if (sparse()) return first.size() - 1;
  return lights == 0 ? 0 : irradiance.size() / lights;
}

void LightTable::append(LightTable more) {
  if (rows() == 0) {
    if (more.rows() > 0) *this = std::move(more);
    return;
  }
  const std::uint64_t before = irradiance.size();
  append_entries(*this, more, {0, more.irradiance.size()});
  for (std::size_t row = 1; row < more.first.size(); ++row) {
    first.push_back(before + more.first[row]);
  }
}

LightTable light::joined(LightTable none, std::vector<LightTable> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  LightTable all = std::move(none);
  std::vector<std::size_t> rows{0}, entries{0};
  for (const LightTable& part : parts) {
    rows.push_back(rows.back() + part.rows());
    entries.push_back(entries.back() + part.irradiance.size());
  }
  for (const LightTable& part : parts) {
    for_each_column(all, part, [&](auto& column, const auto& values, std::size_t width) {
      if (values.empty() || !column.empty()) return;
      using Value = typename std::decay_t<decltype(column)>::value_type;
      column = touched_vector<Value>(entries.back() * width);
    });
  }
  if (all.sparse()) all.first.resize(rows.back() + 1);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    const LightTable part = std::move(parts[i]);
    for_each_column(all, part, [&](auto& column, const auto& values, std::size_t width) {
      if (!values.empty())
        std::copy(values.begin(), values.end(), column.data() + entries[i] * width);
    });
    for (std::size_t row = 1; row < part.first.size(); ++row)
      all.first[rows[i] + row] = entries[i] + part.first[row];
  });
  return all;
}

LightTable LightTable::gathered(std::span<const std::uint32_t> at) const {
  LightTable result(lights, sparse());
  result.batches = batches;
  std::size_t entries = at.size() * lights;
  if (sparse()) {
    result.first.reserve(at.size() + 1);
    for (const std::uint32_t from : at) {
      result.first.push_back(result.first.back() + first[from + 1] - first[from]);
    }
    entries = result.first.back();
  }
  light::for_each_column(result, *this, [&](auto& column, const auto& values, std::size_t width) {
    if (values.empty()) return;
    column.resize(entries * width);
    tbb::parallel_for(std::size_t{0}, at.size(), [&](std::size_t i) {
      const Entries from = row(at[i]);
      std::copy(values.begin() + static_cast<std::ptrdiff_t>(from.first * width),
                values.begin() + static_cast<std::ptrdiff_t>(from.last * width),
                column.begin() + static_cast<std::ptrdiff_t>(result.row(i).first * width));
    });
  });
  return result;
}

LightTable LightTable::slice(std::size_t begin, std::size_t count) const {
  LightTable result(lights, sparse());
  result.batches = batches;
  if (count == 0) return result;
  const Entries entries{row(begin).first, row(begin + count - 1).last};
  append_entries(result, *this, entries);
  for (std::size_t i = 1; sparse() && i <= count; ++i) {
    result.first.push_back(first[begin + i] - entries.first);
  }
  return result;
}

std::uint64_t LightTable::bytes() const {
  std::uint64_t bytes = first.size() * sizeof first.front();
  light::for_each_column(*this, *this, [&](const auto& column, const auto&, std::size_t) {
    bytes += column.size() * sizeof column.front();
  });
  return bytes;
}

void LightTable::drop_batches() {
  batch = shared_variance = {};
  batches = 0;
}

double LightTable::error(std::size_t entry) const { return error_of(*this, entry, 1.0); }

double LightTable::scatter(std::size_t entry) const {
  return error_of(*this, entry, defaults::aimed_noise);
}

LightTable::Total LightTable::total(std::size_t row, std::span<const double> powers) const {
  const auto count = static_cast<std::size_t>(batches);
  std::array<double, max_batches> sums{};
  double luminance_sum = 0, shared = 0;
  for_each(row, [&](std::size_t layer, std::size_t entry) {
    const double power = powers[layer];
    luminance_sum += power * luminance(glm::dvec3(irradiance[entry]));
    for (std::size_t b = 0; b < count; ++b) sums[b] += power * double{batch[entry * count + b]};
    // Errors of photons, or of neighbours, that lights share may be the same in all of them.
    if (!shared_variance.empty()) shared += power * std::sqrt(double{shared_variance[entry]});
  });
  shared *= defaults::aimed_noise;
  return {luminance_sum,
          std::sqrt(squared_error_of_mean(std::span<const double>(sums).first(count)) +
                    shared * shared)};
}

LightTable sum_of(const LightTable& a, const LightTable& b, float share_a, float share_b) {
  constexpr std::size_t rows_per_task = 256;
  LightTable none(a.lights, a.sparse());
  none.batches = a.batches;
  const bool shared = !a.shared_variance.empty() || !b.shared_variance.empty();
  const bool smooth = !a.by_normal.empty() || !b.by_normal.empty();
  const auto count = static_cast<std::size_t>(a.batches);
  const auto write = [&](std::size_t begin, std::size_t end, LightTable& sum) {
    std::vector<std::size_t> entry_of(a.lights);
    for (std::size_t row = begin; row < end; ++row) {
      const std::size_t first = sum.irradiance.size(), of_none = first + a.lights;
      entry_of.assign(a.lights, of_none);
      const auto add = [&](const LightTable& part, float share) {
        part.for_each(row, [&](std::size_t layer, std::size_t entry) {
          if (entry_of[layer] == of_none) {
            entry_of[layer] = sum.irradiance.size();
            sum.irradiance.emplace_back(0.0f);
            if (smooth) sum.by_normal.emplace_back(0.0f);
            sum.batch.resize(sum.batch.size() + count, 0.0f);
            if (sum.sparse()) sum.light.push_back(static_cast<std::uint16_t>(layer));
            if (shared) sum.shared_variance.push_back(0);
          }
          const std::size_t to = entry_of[layer];
          sum.irradiance[to] += share * part.irradiance[entry];
          if (smooth) sum.by_normal[to] += share * part.by_normal[entry];
          for (std::size_t b = 0; b < count; ++b) {
            sum.batch[to * count + b] += share * part.batch[entry * count + b];
          }
          if (!part.shared_variance.empty()) {
            sum.shared_variance[to] += share * share * part.shared_variance[entry];
          }
        });
      };
      add(a, share_a);
      add(b, share_b);
      if (sum.sparse()) sum.first.push_back(sum.irradiance.size());
    }
  };
  return light::rows_by_tasks(a.rows(), rows_per_task, none, write);
}

std::vector<double> light::layer_powers(const Scene& scene) {
  std::vector<double> powers;
  for (const LightGroup& group : light_groups_of(scene).groups) powers.push_back(group.power);
  if (std::all_of(powers.begin(), powers.end(), [](double power) { return power == 0; })) {
    std::fill(powers.begin(), powers.end(), 1.0);
  }
  return powers;
}

}  // namespace photile
