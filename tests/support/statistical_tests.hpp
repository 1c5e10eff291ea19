// Statistical comparisons with the truth. Seeds are fixed, so none of them can flake; their error
// probabilities say how unlikely a correct program would have been to fail when the seed was drawn.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace photile::test {

/// Result of a comparison; convertible so that REQUIRE prints the message.
struct Verdict {
  bool passed;
  std::string message;
};

/// What `value_of` gives of the seeds 1 to 16.
template <class Value>
std::vector<double> of_seeds(Value&& value_of) {
  std::vector<double> values;
  for (std::uint64_t seed = 1; seed <= 16; ++seed) values.push_back(value_of(seed));
  return values;
}

/// Whether the mean of 16 independent values is `truth`: two-sided Student t test with error
/// probability 1e-6. Throws when the values scatter too much for a deviation of `delta` to be found
/// with probability 99.9%: such a test would prove nothing.
inline Verdict mean_is(const std::vector<double>& values, double truth, double delta) {
  constexpr std::size_t seeds = 16;
  constexpr double t_critical = 7.90;  // Student t, 15 degrees of freedom, 1 - 5e-7
  constexpr double t_power = 3.1;      // normal, 99.9%
  if (values.size() != seeds) throw std::logic_error("mean_is takes 16 values");
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / seeds;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double error = std::sqrt(squares / (seeds - 1) / seeds);
  const std::string numbers = "mean " + std::to_string(mean) + " +- " + std::to_string(error) +
                              ", truth " + std::to_string(truth);
  if ((t_critical + t_power) * error > delta)
    throw std::logic_error("too noisy to see " + std::to_string(delta) + ": " + numbers);
  return {std::abs(mean - truth) <= t_critical * error + 1e-12, numbers};
}

/// Pearson's chi-square test of counts against expected counts, error probability 1e-6. All bins
/// must expect at least 5. Both must count every trial, so that bins - 1 is the number of degrees
/// of freedom.
inline Verdict counts_agree(const std::vector<double>& counts,
                            const std::vector<double>& expected) {
  if (counts.size() != expected.size() || counts.size() < 2)
    throw std::logic_error("counts_agree takes two lists of the same length, at least 2");
  const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
  const double total_expected = std::accumulate(expected.begin(), expected.end(), 0.0);
  if (std::abs(total - total_expected) > 1e-3 * total)
    throw std::logic_error("expected counts sum to " + std::to_string(total_expected) + ", not " +
                           std::to_string(total));
  double chi2 = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] < 5) throw std::logic_error("a bin expects fewer than 5");
    chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  }
  // Wilson and Hilferty's approximation of the quantile at 1 - 1e-6.
  const double degrees = static_cast<double>(counts.size() - 1);
  const double cube = 1 - 2 / (9 * degrees) + 4.753 * std::sqrt(2 / (9 * degrees));
  const double critical = degrees * cube * cube * cube;
  return {chi2 <= critical,
          "chi2 " + std::to_string(chi2) + ", critical " + std::to_string(critical)};
}

}  // namespace photile::test

/// CHECK of a Verdict that prints its numbers on failure.
#define CHECK_VERDICT(...)                                \
  do {                                                    \
    const ::photile::test::Verdict verdict = __VA_ARGS__; \
    INFO(verdict.message);                                \
    CHECK(verdict.passed);                                \
  } while (false)
