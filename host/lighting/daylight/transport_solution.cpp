// The system of light_transport.hpp, solved by Gauss and Seidel's sweeps.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "daylight/light_transport.hpp"
#include "photile/errors.hpp"
#include "photile/scene.hpp"
#include "trace/ray_query.hpp"

namespace photile::daylight {
namespace {

/// Columns that are solved together: the light of some thousand cells under them fits a cache.
constexpr std::size_t columns_at_once = 64;
constexpr int most_sweeps = 2048;
constexpr double left_at_end = 5e-4;  ///< of the sum of all cells

/// Of the cells in one sweep, summed.
struct Change {
  double of = 0, all = 0;
};

/// Sweeps until all that further ones would change is little, if each changes as much less as the
/// last one did. Errors: InputError where that is not reached.
template <class Sweep>
void sweep_until_settled(const Sweep& sweep) {
  double before = 0;
  for (int i = 0; i < most_sweeps; ++i) {
    const Change change = sweep();
    const double fades = change.of / before;
    if (change.of == 0 || change.of * fades <= left_at_end * (1 - fades) * change.all) return;
    before = change.of;
  }
  throw InputError(
      fmt::format("reflected light does not fade within {} reflections: a daylight study needs "
                  "reflectances below 1; set lower values with --reflectance",
                  most_sweeps));
}

/// Rows of one channel, without their batches.
struct SparseRows {
  std::vector<std::size_t> first{0};
  std::vector<std::uint32_t> column;
  std::vector<float> weight;
};

SparseRows cells_of(const std::vector<TransportRow>& rows, int channel) {
  SparseRows sparse;
  for (const TransportRow& row : rows) {
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      if (i > 0 && row.cells[i].cell == row.cells[i - 1].cell) {
        sparse.weight.back() += row.cells[i].weight[channel];
      } else {
        sparse.column.push_back(row.cells[i].cell);
        sparse.weight.push_back(row.cells[i].weight[channel]);
      }
    }
    sparse.first.push_back(sparse.column.size());
  }
  return sparse;
}

double from_cells(const SparseRows& rows, std::size_t row, const std::vector<double>& cells) {
  double sum = 0;
  for (std::size_t i = rows.first[row]; i < rows.first[row + 1]; ++i)
    sum += double{rows.weight[i]} * cells[rows.column[i]];
  return sum;
}

/// For each patch its column among those that give any light, or `none`.
std::vector<std::uint32_t> columns_of(const LightTransport& transport, std::size_t& count) {
  std::vector<std::uint32_t> column(transport.patches, none);
  for (const auto* rows : {&transport.sensors, &transport.cells}) {
    for (const TransportRow& row : *rows) {
      for (const auto& entry : row.patches) column[entry.patch] = 0;
    }
  }
  count = 0;
  for (std::uint32_t& place : column) {
    if (place != none) place = static_cast<std::uint32_t>(count++);
  }
  return column;
}

/// Adds what a row has from cells to its block of columns.
void add_cells(const SparseRows& rows, std::size_t row, const float* cells, float* sum) {
  constexpr std::size_t lanes = 32;  // that stay in registers
  for (std::size_t first = 0; first < columns_at_once; first += lanes) {
    std::array<float, lanes> part{};
    for (std::size_t i = rows.first[row]; i < rows.first[row + 1]; ++i) {
      const float* const from = cells + rows.column[i] * columns_at_once + first;
      const float weight = rows.weight[i];
      for (std::size_t lane = 0; lane < lanes; ++lane) part[lane] += weight * from[lane];
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) sum[first + lane] += part[lane];
  }
}

/// One block of columns, from `first` on.
class BlockSolver {
 public:
  BlockSolver(const LightTransport& transport, const std::vector<std::uint32_t>& column,
              int channel, std::size_t first)
      : transport_(transport), column_(column), channel_(channel), first_(first) {}

  void solve(const SparseRows& among_cells) {
    const std::size_t count = transport_.cells.size();
    cells_.assign(count * columns_at_once, 0.0f);
    for (std::size_t cell = 0; cell < count; ++cell)
      add_patches(transport_.cells[cell], &cells_[cell * columns_at_once]);
    const std::vector<float> straight = cells_;
    sweep_until_settled([&] {
      Change change;
      for (std::size_t cell = 0; cell < count; ++cell) {
        float sum[columns_at_once];
        std::copy_n(&straight[cell * columns_at_once], columns_at_once, sum);
        add_cells(among_cells, cell, cells_.data(), sum);
        float* const now = &cells_[cell * columns_at_once];
        float changed = 0, total = 0;
        for (std::size_t c = 0; c < columns_at_once; ++c) {
          changed += std::abs(sum[c] - now[c]);
          total += sum[c];
          now[c] = sum[c];
        }
        change.of += double{changed};
        change.all += double{total};
      }
      return change;
    });
  }

  /// Adds `share` of what a sensor has to its row of all patches.
  void add_sensor(const SparseRows& from_cells, std::size_t sensor, float share,
                  const std::vector<std::uint32_t>& patch_of, float* row) const {
    float sum[columns_at_once]{};
    add_patches(transport_.sensors[sensor], sum);
    add_cells(from_cells, sensor, cells_.data(), sum);
    for (std::size_t c = 0; c < columns_at_once && first_ + c < patch_of.size(); ++c)
      row[patch_of[first_ + c]] += share * sum[c];
  }

 private:
  void add_patches(const TransportRow& row, float* sum) const {
    for (const auto& entry : row.patches) {
      const std::size_t column = column_[entry.patch];
      if (column >= first_ && column < first_ + columns_at_once)
        sum[column - first_] += entry.all[channel_];
    }
  }

  const LightTransport& transport_;
  const std::vector<std::uint32_t>& column_;
  int channel_;
  std::size_t first_;
  std::vector<float> cells_;
};

/// What cells have that get `straight` light and light each other.
std::vector<double> lit_cells(const SparseRows& among_cells, const std::vector<double>& straight) {
  std::vector<double> cells = straight;
  sweep_until_settled([&] {
    Change change;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const double now = straight[cell] + from_cells(among_cells, cell, cells);
      change.of += std::abs(now - cells[cell]);
      change.all += std::abs(now);
      cells[cell] = now;
    }
    return change;
  });
  return cells;
}

/// Lux of a row under the mean sky by the rays of one batch, where cells are known.
double lux_of_batch(const LightTransport& transport, const TransportRow& row, std::uint32_t batch,
                    int channel, const std::vector<double>& cells) {
  double sum = double{row.mean_sky[batch][channel]};
  for (const auto& entry : row.cells) {
    if (entry.batch == batch) sum += double{entry.weight[channel]} * cells[entry.cell];
  }
  return transport.batches * sum;
}

/// The weight of a channel in the luminance; 1 where channels are alike.
double channel_fraction(const LightTransport& transport, int channel) {
  if (!transport.coloured) return 1;
  glm::dvec3 one(0.0);
  one[channel] = 1;
  return luminance(one);
}

}  // namespace

std::vector<float> lux_of_patches(const LightTransport& transport) {
  std::vector<float> lux(transport.sensors.size() * transport.patches, 0.0f);
  std::size_t columns = 0;
  const std::vector<std::uint32_t> column = columns_of(transport, columns);
  std::vector<std::uint32_t> patch_of(columns);
  for (std::uint32_t patch = 0; patch < column.size(); ++patch) {
    if (column[patch] != none) patch_of[column[patch]] = patch;
  }
  for (int channel = 0; channel < (transport.coloured ? 3 : 1); ++channel) {
    const SparseRows among_cells = cells_of(transport.cells, channel);
    const SparseRows from_cells = cells_of(transport.sensors, channel);
    const auto share = static_cast<float>(channel_fraction(transport, channel));
    tbb::parallel_for(std::size_t{0}, (columns + columns_at_once - 1) / columns_at_once,
                      [&](std::size_t part) {
                        const trace::FlushDenormals flush_denormals;
                        BlockSolver solver(transport, column, channel, part * columns_at_once);
                        solver.solve(among_cells);
                        for (std::size_t sensor = 0; sensor < transport.sensors.size(); ++sensor) {
                          solver.add_sensor(from_cells, sensor, share, patch_of,
                                            lux.data() + sensor * transport.patches);
                        }
                      });
  }
  return lux;
}

std::vector<std::vector<double>> lux_of_batches(const LightTransport& transport) {
  std::vector<std::vector<double>> lux(static_cast<std::size_t>(transport.batches),
                                       std::vector<double>(transport.sensors.size(), 0.0));
  for (int channel = 0; channel < (transport.coloured ? 3 : 1); ++channel) {
    const double share = channel_fraction(transport, channel);
    const SparseRows among_cells = cells_of(transport.cells, channel);
    const SparseRows to_sensors = cells_of(transport.sensors, channel);
    std::vector<double> straight;
    for (const TransportRow& row : transport.cells) {
      double sum = 0;
      for (const glm::vec3& sky : row.mean_sky) sum += double{sky[channel]};
      straight.push_back(sum);
    }
    const std::vector<double> cells = lit_cells(among_cells, straight);
    tbb::parallel_for(std::size_t{0}, lux.size(), [&](std::size_t i) {
      const auto batch = static_cast<std::uint32_t>(i);
      std::vector<double> beyond;
      for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const TransportRow& row = transport.cells[cell];
        beyond.push_back(lux_of_batch(transport, row, batch, channel, cells) - cells[cell]);
      }
      beyond = lit_cells(among_cells, beyond);
      for (std::size_t sensor = 0; sensor < transport.sensors.size(); ++sensor) {
        const TransportRow& row = transport.sensors[sensor];
        lux[i][sensor] += share * (lux_of_batch(transport, row, batch, channel, cells) +
                                   from_cells(to_sensors, sensor, beyond));
      }
    });
  }
  return lux;
}

}  // namespace photile::daylight
