#include "trace/photon_quota.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "photile/errors.hpp"

namespace photile {

namespace trace {

std::vector<double> light_shares(const std::vector<Light>& lights, PhotonQuota quota) {
  const double count = static_cast<double>(lights.size());
  double power = 0;
  for (const Light& light : lights) power += light.power;
  // Lights that are all off can still be turned up by relighting.
  if (!(power > 0)) quota = PhotonQuota::equal;
  const double by_power = quota == PhotonQuota::power      ? 1.0
                          : quota == PhotonQuota::balanced ? 0.5
                                                           : 0.0;
  std::vector<double> share;
  for (const Light& light : lights)
    share.push_back((by_power > 0 ? by_power * (light.power / power) : 0.0) +
                    (1.0 - by_power) / count);
  return share;
}

}  // namespace trace

std::string_view name_of(PhotonQuota quota) {
  switch (quota) {
    case PhotonQuota::balanced:
      return "balanced";
    case PhotonQuota::power:
      return "power";
    case PhotonQuota::equal:
      return "equal";
  }
  return "unknown";
}

namespace {

/// Adds what rounding down left over, one path each, by the largest remainder first.
void give_remainder(std::vector<std::uint64_t>& paths, const std::vector<double>& wanted,
                    std::uint64_t remainder) {
  std::vector<std::size_t> order(paths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return wanted[a] - std::floor(wanted[a]) > wanted[b] - std::floor(wanted[b]);
  });
  for (std::uint64_t i = 0; i < remainder; ++i) ++paths[order[i % order.size()]];
}

}  // namespace

std::vector<std::uint64_t> photons_per_light(const Scene& scene, std::uint64_t total,
                                             PhotonQuota quota) {
  const std::size_t count = scene.lights.size();
  if (count == 0)
    throw InputError(scene.source.string() +
                     ": the scene has no lights; add a light or an emissive material");
  // Each light is given its first path, and shares decide about the paths beyond it.
  total = std::max<std::uint64_t>(total, count);
  const std::vector<double> share = trace::light_shares(scene.lights, quota);
  std::vector<double> wanted(count);
  std::vector<std::uint64_t> paths(count);
  for (std::size_t l = 0; l < count; ++l)
    wanted[l] = std::max(0.0, share[l] * static_cast<double>(total) - 1.0);
  // What the smallest lights are given beyond their share is taken from the others in proportion.
  const double beyond = std::accumulate(wanted.begin(), wanted.end(), 0.0);
  const double available = static_cast<double>(total - count);
  for (std::size_t l = 0; l < count; ++l) {
    if (beyond > 0) wanted[l] *= available / beyond;
    paths[l] = 1 + static_cast<std::uint64_t>(wanted[l]);
  }
  const std::uint64_t given = std::accumulate(paths.begin(), paths.end(), std::uint64_t{0});
  give_remainder(paths, wanted, total - given);
  return paths;
}

}  // namespace photile
