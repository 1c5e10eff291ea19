// The system of light_transport.hpp, solved by Gauss and Seidel's sweeps.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "daylight/light_transport.hpp"
#include "photile/scene.hpp"
#include "trace/ray_query.hpp"

namespace photile::daylight {
namespace {

/// Columns that are solved together: the light of some thousand cells under them fits a cache.
constexpr std::size_t columns_at_once = 64;
constexpr int most_sweeps = 256;
constexpr double change_at_end = 5e-4;  ///< of the sum of all cells

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
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      double change = 0, all = 0;
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
        change += double{changed};
        all += double{total};
      }
      if (change <= change_at_end * all) return;
    }
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

/// Lux of the sensors under the mean sky by the rays of one batch, in one channel.
std::vector<double> of_batch(const LightTransport& transport, std::uint32_t batch, int channel) {
  const double batches = transport.batches;
  std::vector<double> cells(transport.cells.size(), 0.0);
  const auto lux = [&](const TransportRow& row) {
    double sum = double{row.mean_sky[batch][channel]};
    for (const auto& entry : row.cells) {
      if (entry.batch == batch) sum += double{entry.weight[channel]} * cells[entry.cell];
    }
    return batches * sum;
  };
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double change = 0, all = 0;
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const double now = lux(transport.cells[cell]);
      change += std::abs(now - cells[cell]);
      all += now;
      cells[cell] = now;
    }
    if (change <= change_at_end * all) break;
  }
  std::vector<double> sensors;
  for (const TransportRow& row : transport.sensors) sensors.push_back(lux(row));
  return sensors;
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
  tbb::parallel_for(std::size_t{0}, lux.size(), [&](std::size_t batch) {
    for (int channel = 0; channel < (transport.coloured ? 3 : 1); ++channel) {
      const double share = channel_fraction(transport, channel);
      const auto found = of_batch(transport, static_cast<std::uint32_t>(batch), channel);
      for (std::size_t i = 0; i < found.size(); ++i) lux[batch][i] += share * found[i];
    }
  });
  return lux;
}

}  // namespace photile::daylight
