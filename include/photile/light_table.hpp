// The light of every light at points of surfaces: a table with a row for each point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "photile/scene.hpp"

namespace photile {

/// Light at points, each light at power 1. A row has an entry for each light of the scene, in their
/// order; with more than max_dense_lights lights, for those alone that were found at its point,
/// each once. Columns have a value for each entry; columns that are not known are empty.
struct LightTable {
  static constexpr int max_batches = 64;

  /// No rows; takes the form of what is first appended.
  LightTable() = default;
  /// No rows, in the form that the light of such a scene has.
  explicit LightTable(const SceneNeeds& needs);
  LightTable(std::size_t lights, bool sparse);

  std::vector<glm::vec3> irradiance;  ///< W/m2 or lm/m2, linear RGB
  /// Reflected radiance towards the eye, W/(m2 sr) or cd/m2. Where it is empty, as photon maps
  /// leave it unless the scene is glossy, radiance is albedo / pi x irradiance.
  std::vector<glm::vec3> radiance;
  /// Luminance of irradiance by the normal, to first order: a plane of unit normal n there gets
  /// dot(xyz, n) + w. Only for nodes whose light rays find, in scenes with smooth shading.
  std::vector<glm::vec4> by_normal;
  /// Luminance found by each of several independent batches of rays, row-major [entry][batch]:
  /// irradiance is their mean, and their scatter is its error, also for any mix of lights.
  std::vector<float> batch;
  int batches = 0;
  /// Variance of the luminance of caustics, which all batches share.
  std::vector<float> shared_variance;

  std::size_t lights = 0;  ///< of the scene: entries of a row, where rows are dense
  // Of sparse tables, else empty:
  std::vector<std::uint64_t> first;  ///< row r has entries [first[r], first[r + 1])
  std::vector<std::uint16_t> light;  ///< of each entry

  bool sparse() const { return !first.empty(); }
  std::size_t rows() const;

  struct Entries {
    std::size_t first, last;
  };
  Entries row(std::size_t row) const {
    return sparse() ? Entries{first[row], first[row + 1]}
                    : Entries{row * lights, (row + 1) * lights};
  }
  /// Calls visit(light, entry) for each entry of a row.
  template <class Visit>
  void for_each(std::size_t at, const Visit& visit) const {
    const Entries entries = row(at);
    for (std::size_t entry = entries.first; entry < entries.last; ++entry) {
      visit(sparse() ? std::size_t{light[entry]} : entry - entries.first, entry);
    }
  }

  /// Appends the rows of a table of the same form.
  void append(LightTable rows);
  /// Row i of the result is row at[i]. Work is shared by TBB.
  LightTable gathered(std::span<const std::uint32_t> at) const;
  /// Rows [begin, begin + count).
  LightTable slice(std::size_t begin, std::size_t count) const;

  std::uint64_t bytes() const;
  /// Keeps only the means.
  void drop_batches();

  /// Standard error of the luminance of an entry, by its batches.
  double error(std::size_t entry) const;
  /// Standard error by which it may differ from a point beside it that sees the same light: of the
  /// error that batches share, only the fraction `defaults::aimed_noise` counts.
  double scatter(std::size_t entry) const;

  /// Luminance of all lights together, and the error by which it may differ from a point beside it.
  struct Total {
    double luminance = 0, error = 0;
  };
  /// Of a row, with these powers of the lights.
  Total total(std::size_t row, std::span<const double> powers) const;
};

/// The sum of light of two kinds, or of light found twice, at the same points and with the same
/// number of batches.
///   share_a, share_b   their weights
LightTable sum_of(const LightTable& a, const LightTable& b, float share_a = 1, float share_b = 1);

}  // namespace photile
