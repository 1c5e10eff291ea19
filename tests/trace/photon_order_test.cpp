// The order and the size of stored photons.
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <type_traits>

#include "photile/photons.hpp"
#include "trace/photon_tracer.hpp"

namespace photile::test {
namespace {

/// Photons on random sided triangles; the x of each position is its index.
Photons random_photons(std::size_t count, std::uint32_t sided_triangles, bool full) {
  std::mt19937 generator(99);
  Photons photons;
  for (std::size_t i = 0; i < count; ++i) {
    photons.position.emplace_back(i, 1, 2);
    photons.flux.emplace_back(3 * i, 4, 5);
    photons.sided_triangle.push_back(generator() % sided_triangles);
    if (full) photons.incoming.emplace_back(5 * i, 0, 1);
    if (full) photons.light.push_back(static_cast<std::uint16_t>(i % 7));
  }
  return photons;
}

}  // namespace

TEST_CASE("Photons sorted by sided triangle agree with std::stable_sort in every array") {
  for (const std::size_t count : {0, 1, 1000, 300'000})
    for (const bool full : {false, true}) {
      constexpr std::uint32_t sided_triangles = 1001;
      const Photons given = random_photons(count, sided_triangles, full);
      std::vector<std::size_t> order(count);
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return given.sided_triangle[a] < given.sided_triangle[b];
      });
      const Photons sorted = sort_by_sided_triangle(given, sided_triangles);
      REQUIRE(sorted.size() == count);
      REQUIRE(sorted.incoming.size() == (full ? count : 0));
      REQUIRE(sorted.light.size() == (full ? count : 0));
      bool same = true;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = order[i];
        same &= sorted.position[i] == given.position[from] && sorted.flux[i] == given.flux[from] &&
                sorted.sided_triangle[i] == given.sided_triangle[from];
        if (full)
          same &=
              sorted.incoming[i] == given.incoming[from] && sorted.light[i] == given.light[from];
      }
      CHECK(same);
    }
}

TEST_CASE("Photons of runs are those of all runs in a row, sorted, and the runs are emptied") {
  for (const std::size_t count : {0, 1, 1000, 300'000})
    for (const bool full : {false, true}) {
      // Many sided triangles: too many for a table of counts for each thread.
      const std::uint32_t sided_triangles = count == 1000 ? 4000 : 501;
      Photons given = random_photons(count, sided_triangles, full);
      constexpr std::size_t run_size = 333;
      std::vector<trace::PhotonRun> parts(count / run_size + 2);  // the last is empty
      std::vector<trace::LayerRun> runs;
      given.light.clear();
      for (std::size_t r = 0; r < parts.size(); ++r) {
        const std::size_t first = std::min(count, r * run_size);
        const std::size_t last = std::min(count, first + run_size);
        const auto part_of = [&](const auto& all) {
          const auto begin = all.begin();
          return all.empty() ? all : std::decay_t<decltype(all)>(begin + first, begin + last);
        };
        parts[r] = {part_of(given.position), part_of(given.flux), part_of(given.incoming),
                    part_of(given.sided_triangle)};
        runs.push_back({&parts[r], static_cast<std::uint16_t>(r % 5)});
        if (full) given.light.insert(given.light.end(), last - first, runs.back().layer);
      }
      const Photons expected = sort_by_sided_triangle(given, sided_triangles);
      const Photons sorted = trace::sorted_photons(runs, full, sided_triangles);
      CHECK(sorted.position == expected.position);
      CHECK(sorted.flux == expected.flux);
      CHECK(sorted.incoming == expected.incoming);
      CHECK(sorted.light == expected.light);
      CHECK(sorted.sided_triangle == expected.sided_triangle);
      CHECK(sorted.first_of == expected.first_of);
      for (const trace::PhotonRun& run : parts)
        CHECK((run.size() == 0 && run.sided_triangle.empty()));
    }
}

TEST_CASE("first_of delimits the photons of each sided triangle, also of empty ones") {
  Photons photons;
  for (const std::uint32_t s : {3u, 1u, 3u, 3u}) {
    photons.sided_triangle.push_back(s);
    photons.position.emplace_back(0.0f);
    photons.flux.emplace_back(0.0f);
  }
  CHECK(sort_by_sided_triangle(photons, 5).first_of ==
        std::vector<std::uint32_t>{0, 0, 1, 1, 4, 4});
  CHECK(sort_by_sided_triangle({}, 2).first_of == std::vector<std::uint32_t>{0, 0, 0});
}

TEST_CASE("A photon takes 28 bytes, 12 more where surfaces are glossy and 2 with several lights") {
  CHECK(random_photons(1000, 10, false).bytes() == 28'000);
  CHECK(random_photons(1000, 10, true).bytes() == 42'000);
  CHECK(sort_by_sided_triangle(random_photons(1000, 10, false), 10).bytes() == 28'000 + 11 * 4);
}

}  // namespace photile::test
