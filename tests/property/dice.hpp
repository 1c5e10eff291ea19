// Random choices that are the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

namespace photile::test {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double unit() { return std::ldexp(static_cast<double>(engine_() >> 11), -53); }
  bool chance(double probability) { return unit() < probability; }
  /// From `least` to `most`.
  int whole(int least, int most) {
    return least + static_cast<int>(unit() * (static_cast<double>(most) - least + 1));
  }
  double between(double least, double most) { return least + unit() * (most - least); }
  /// A number of any size: its logarithm is uniform.
  double size_between(double least, double most) { return least * std::pow(most / least, unit()); }
  template <class T>
  const T& one_of(const std::vector<T>& values) {
    return values[static_cast<std::size_t>(whole(0, static_cast<int>(values.size()) - 1))];
  }
  std::string one_of(std::initializer_list<const char*> words) {
    return one_of(std::vector<std::string>(words.begin(), words.end()));
  }

 private:
  std::mt19937_64 engine_;  // whose distributions each library has its own way with
};

}  // namespace photile::test
