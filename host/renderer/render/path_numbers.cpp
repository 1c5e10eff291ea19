#include "render/path_numbers.hpp"

#include <cstddef>

namespace photile {

std::vector<std::uint64_t> path_numbers(const PrimaryHits& hits, const PrimaryHitParameters& film,
                                        int first_row, int last_row) {
  const std::uint32_t first_pixel = static_cast<std::uint32_t>(first_row * film.width);
  std::vector<std::uint32_t> sample(
      static_cast<std::size_t>(last_row - first_row) * static_cast<std::size_t>(film.width),
      static_cast<std::uint32_t>(film.pass));
  std::vector<std::uint64_t> number;
  number.reserve(hits.size());
  for (const std::uint32_t pixel : hits.pixel) {
    std::uint32_t& next = sample[pixel - first_pixel];
    number.push_back(std::uint64_t{pixel} * static_cast<std::uint64_t>(film.samples_per_pixel) +
                     next);
    next += static_cast<std::uint32_t>(film.passes);
  }
  return number;
}

}  // namespace photile
