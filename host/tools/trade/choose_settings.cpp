#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "photile/defaults.hpp"
#include "photile/limits.hpp"
#include "tools/trade/quality_target.hpp"

namespace photile {
namespace {

/// Models are aimed below what was asked for: the part of the target that settings may use.
constexpr double error_share = 0.6, time_share = 0.8;

constexpr double step = 1.189207115002721;  ///< 2^(1/4), between settings tried

/// Values from `least` to `most`, each `factor` times the one before.
std::vector<double> series(double least, double most, double factor) {
  std::vector<double> values;
  for (double value = least; value < most * 1.0001; value *= factor) {
    values.push_back(std::round(value));
  }
  return values;
}

struct Wanted {
  double relative_mse = std::numeric_limits<double>::infinity();
  double frame_seconds = std::numeric_limits<double>::infinity();
};

class Search {
 public:
  Search(const QualityTarget& target, const ErrorModel& error, const TimeModel& time)
      : error_(error), time_(time), minimise_error_(target.relative_error <= 0) {
    if (target.relative_error > 0) {
      wanted_.relative_mse = std::pow(error_share * target.relative_error, 2);
    }
    if (target.frame_seconds > 0) wanted_.frame_seconds = time_share * target.frame_seconds;
  }

  void consider(double photons, double k, double samples) {
    const double mse = error_.relative_mse(photons, k, samples);
    const double frame = time_.frame(k, samples);
    const double first = time_.first_picture(photons, k, samples);
    // How far off the target, as a factor; below 1 where it is met.
    const double excess = std::max(mse / wanted_.relative_mse, frame / wanted_.frame_seconds);
    const bool reached = excess <= 1;
    const double cost = !reached ? excess : minimise_error_ ? mse : first;
    if (choice_.reached > reached || (choice_.reached == reached && cost >= cost_)) return;
    cost_ = cost;
    choice_ = {.photons = static_cast<std::uint64_t>(photons),
               .neighbours = static_cast<int>(k),
               .samples_per_pixel = static_cast<int>(samples),
               .expected_error = std::sqrt(mse),
               .expected_frame_seconds = frame,
               .expected_first_picture_seconds = first,
               .reached = reached};
  }

  const QualityChoice& choice() const { return choice_; }

 private:
  const ErrorModel& error_;
  const TimeModel& time_;
  const bool minimise_error_;
  Wanted wanted_;
  QualityChoice choice_;
  double cost_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double TimeModel::frame(double k, double samples) const {
  return samples_per_picture * samples * (per_sample + per_sample_neighbour * k);
}

double TimeModel::first_picture(double photons, double k, double samples) const {
  return fixed + per_photon * photons + frame(k, samples);
}

QualityChoice choose_settings(const QualityTarget& target, const ErrorModel& error,
                              const TimeModel& time, std::uint64_t photons) {
  const std::vector<double> photon_counts =
      target.relative_error > 0
          ? series(defaults::least_chosen_photons, defaults::most_chosen_photons, step)
          : std::vector{static_cast<double>(photons)};
  const std::vector<double> samples = series(1, defaults::most_chosen_samples, 2);
  Search search(target, error, time);
  for (const double k :
       series(defaults::least_chosen_neighbours, defaults::most_chosen_neighbours, step)) {
    for (const double count : samples) {
      for (const double n : photon_counts) search.consider(n, k, count);
    }
  }
  return search.choice();
}

}  // namespace photile
