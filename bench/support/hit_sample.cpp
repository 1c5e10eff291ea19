#include "support/hit_sample.hpp"

#include <utility>

namespace photile::bench {

HitSample hits_at(const PrimaryHits& hits, std::vector<std::uint32_t> index) {
  HitSample sample;
  for (const std::uint32_t i : index) {
    sample.hits.position.push_back(hits.position[i]);
    sample.hits.oriented_face.push_back(hits.oriented_face[i]);
    sample.hits.pixel.push_back(hits.pixel[i]);
    sample.hits.throughput.push_back(hits.throughput[i]);
    sample.hits.diffuse_albedo.push_back(hits.diffuse_albedo[i]);
  }
  sample.index = std::move(index);
  return sample;
}

HitSample block_sample(const PrimaryHits& hits, std::size_t stride) {
  constexpr std::size_t block = 256;
  std::vector<std::uint32_t> index;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (i / block % stride == 0) index.push_back(static_cast<std::uint32_t>(i));
  }
  return hits_at(hits, std::move(index));
}

HitSample thinned(const HitSample& sample, std::size_t requested) {
  const std::size_t step = (sample.index.size() + requested - 1) / requested;
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < sample.index.size(); i += step) {
    chosen.push_back(static_cast<std::uint32_t>(i));
  }
  HitSample result = hits_at(sample.hits, chosen);
  for (std::uint32_t& i : result.index) i = sample.index[i];
  return result;
}

}  // namespace photile::bench
