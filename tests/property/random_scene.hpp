// Small scenes at random: most are sound, some are extreme, some are broken.
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

namespace photile::test {

/// Random choices that are the same on every machine.
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

struct RandomScene {
  std::filesystem::path file;
  std::vector<std::filesystem::path> inputs;  ///< it and the files that it names
  std::vector<std::string> lights;            ///< names that are likely to be there
  double size = 1;                            ///< metres, about
  bool sound = true;                          ///< lit, of usual size and powers, and not damaged
  bool opaque_room = true;                    ///< its walls are neither glass nor mirrors
};

/// Writes a scene into the folder: a room with up to four lamps and a few things in it, as OBJ or
/// as glTF.
RandomScene write_random_scene(const std::filesystem::path& folder, Dice& dice);

}  // namespace photile::test
