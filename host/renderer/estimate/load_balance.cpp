#include "estimate/load_balance.hpp"

#include <algorithm>
#include <cmath>

namespace photile::estimate {
namespace {

/// Hits of the first rounds, for each device: launches that cost more than what they launch, but
/// little beside a picture; then enough to tell devices apart.
constexpr std::size_t warm_up_hits = 1024;
constexpr std::size_t probe_hits = 16'384;

}  // namespace

LoadBalance::LoadBalance(std::size_t devices) : work_(devices) {}

std::size_t LoadBalance::round(std::size_t left) const {
  if (work_.size() == 1 || rounds_ >= 2) return left;
  return std::min(left, work_.size() * (rounds_ == 0 ? warm_up_hits : probe_hits));
}

double LoadBalance::throughput(const Work& work) const {
  return work.seconds > 0 ? static_cast<double>(work.measured_hits) / work.seconds : 0;
}

std::vector<std::size_t> LoadBalance::cuts(std::size_t count) const {
  std::vector<double> weights;
  double sum = 0;
  for (const Work& work : work_) sum += weights.emplace_back(throughput(work));
  // Until every device has been measured, and if a clock stood still, all count the same.
  const bool even = !std::all_of(weights.begin(), weights.end(), [](double w) { return w > 0; });
  std::vector<std::size_t> cuts{0};
  double below = 0;
  for (std::size_t i = 0; i + 1 < work_.size(); ++i) {
    below += even ? 1.0 / static_cast<double>(work_.size()) : weights[i] / sum;
    const auto cut = static_cast<std::size_t>(std::llround(below * static_cast<double>(count)));
    cuts.push_back(std::clamp(cut, cuts.back(), count));
  }
  cuts.push_back(count);
  return cuts;
}

void LoadBalance::record(std::size_t device, std::size_t hits, double seconds) {
  Work& work = work_[device];
  work.hits += hits;
  if (rounds_ == 0 && work_.size() > 1) return;
  work.measured_hits += hits;
  work.seconds += seconds;
}

std::vector<double> LoadBalance::shares() const {
  std::size_t all = 0;
  for (const Work& work : work_) all += work.hits;
  std::vector<double> shares;
  for (const Work& work : work_) {
    shares.push_back(all == 0 ? 0 : static_cast<double>(work.hits) / static_cast<double>(all));
  }
  return shares;
}

}  // namespace photile::estimate
