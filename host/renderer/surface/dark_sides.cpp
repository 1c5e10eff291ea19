#include "surface/dark_sides.hpp"

#include "surface/disjoint_sets.hpp"

namespace photile::surface {
namespace {

constexpr double least_on_a_piece = 40;    ///< photons, of what is judged together
constexpr double least_of_a_triangle = 5;  ///< of them: e^-5 of such are empty by chance

}  // namespace

std::vector<std::uint8_t> find_dark_sides(const SurfaceMesh& mesh,
                                          std::span<const Connection> connections,
                                          const Sheets& sheets,
                                          std::span<const std::uint32_t> landed) {
  const std::size_t sides = mesh.original.size();
  std::vector<std::uint64_t> found(sides, 0);  // of originals, with what coincides with them
  for (std::size_t s = 0; s < sides; ++s) found[mesh.original[s]] += landed[s];
  std::vector<double> area(sides / 2), area_of_sheet(sheets.count, 0.0);
  std::vector<std::uint64_t> found_on_sheet(sheets.count, 0);
  for (std::uint32_t t = 0; t < area.size(); ++t) {
    if (!mesh.counts(t)) continue;
    area[t] = triangle_area(mesh.scene, t);
    for (const std::uint32_t s : {sided(t, 0), sided(t, 1)}) {
      area_of_sheet[sheets.of[s]] += area[t];
      found_on_sheet[sheets.of[s]] += found[s];
    }
  }
  const auto expected = [&](std::uint32_t s) {
    const std::uint32_t sheet = sheets.of[s];
    return static_cast<double>(found_on_sheet[sheet]) * area[triangle_of(s)] / area_of_sheet[sheet];
  };
  const auto nearly_empty = [](std::uint64_t count, double of) {
    return static_cast<double>(count) <= most_found_in_the_dark * of;
  };

  std::vector<std::uint8_t> dark(sides, 0);
  for (std::uint32_t s = 0; s < sides; ++s) {
    if (mesh.original[s] != s) continue;
    const double photons = expected(s);
    dark[s] = photons >= least_of_a_triangle && nearly_empty(found[s], photons) ? 1 : 0;
  }
  DisjointSets pieces(sides);
  for_each_pair_of_sides(connections, [&](std::uint32_t a, std::uint32_t b) {
    if (dark[a] != 0 && dark[b] != 0) pieces.join(a, b);
  });
  std::vector<double> expected_on_piece(sides, 0.0);
  for (std::uint32_t s = 0; s < sides; ++s) {
    if (dark[s] != 0) expected_on_piece[pieces.find(s)] += expected(s);
  }
  for (std::uint32_t s = 0; s < sides; ++s) {
    const std::uint32_t original = mesh.original[s];
    dark[s] = dark[original] != 0 && expected_on_piece[pieces.find(original)] >= least_on_a_piece;
  }
  return dark;
}

}  // namespace photile::surface
