// Whatever is asked for on whatever scene: one of the exit codes, one line that says what is wrong,
// whole files of finite numbers, inputs as they were, and the same bits on a second run.
//
// PHOTILE_PROPERTIES is how many commands are tried, PHOTILE_PROPERTIES_SEED the first; a failure
// tells its command and its number, by which it can be tried alone.

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string_view>

#include "command_run.hpp"
#include "file_bytes.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "random_command.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

namespace fs = std::filesystem;

constexpr int quick_commands = 200;
/// One of so many quick commands runs twice.
constexpr std::uint64_t quick_repeats = 5;
/// One of so many other commands asks for kernels that take seconds to compile.
constexpr std::uint64_t any_kernels = 200;
/// By as many each kind of command has surely succeeded, by the quick ones from the first seed on.
constexpr std::uint64_t many_commands = 5'000;

std::map<fs::path, std::string> contents(const std::vector<fs::path>& files) {
  std::map<fs::path, std::string> result;
  for (const fs::path& file : files) result[file] = bytes_of(file);
  return result;
}

std::string text_of(const std::vector<std::string>& arguments) {
  std::string text = "photile";
  for (const std::string& argument : arguments) text += " '" + argument + "'";
  return text;
}

/// What is wrong with a picture, or "". Each pixel of the root is the float sum of the layers, but
/// for standard errors.
std::string problem_of_picture(const fs::path& file) {
  const Image image = read_image(file);
  for (const std::vector<float>& plane : image.channels) {
    if (!std::all_of(plane.begin(), plane.end(), [](float v) { return std::isfinite(v); })) {
      return "a pixel is not finite";
    }
  }
  const bool layered =
      std::any_of(image.channel_names.begin(), image.channel_names.end(),
                  [](const std::string& name) { return name.starts_with("Combined_"); });
  const LightMix mix = layered ? read_light_mix(file) : LightMix();  // in the order of the sum
  for (const char* component : {"R", "G", "B"}) {
    const std::vector<float>* root = image.find(component);
    if (root == nullptr) return std::string("lacks ") + component;
    std::vector<float> sums(image.pixels());
    for (const MixedLight& light : mix.lights) {
      const std::vector<float>* layer = image.find("Combined_" + light.name + "." + component);
      if (layer == nullptr) continue;
      for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += (*layer)[p];
    }
    if (!layered || file.filename() == "errors.exr") continue;
    for (std::size_t p = 0; p < sums.size(); ++p) {
      const float sum = std::min(sums[p], std::numeric_limits<float>::max());
      if (std::bit_cast<std::uint32_t>((*root)[p]) != std::bit_cast<std::uint32_t>(sum)) {
        return "the root is not the sum of the layers";
      }
      if (sum < 0) return "a pixel is negative";
    }
  }
  return {};
}

bool has_null(const nlohmann::json& value) {
  if (value.is_structured()) return std::any_of(value.begin(), value.end(), has_null);
  return value.is_null();
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// What is wrong with a file, or those of a folder, that a command has written, or "".
std::string problem_of(const fs::path& file) {
  if (fs::is_directory(file)) {
    for (const fs::path& inner : files_in(file)) {
      if (const std::string problem = problem_of(inner); !problem.empty()) return problem;
    }
    return {};
  }
  const std::string ending = file.extension().string();
  if (ending == ".exr") return problem_of_picture(file);
  if (ending == ".png" || ending == ".hdr") {
    check_pixels(file);
    return {};
  }
  const std::string bytes = bytes_of(file);
  if (bytes.empty()) return "is empty";
  if (ending == ".json") {
    const auto json = nlohmann::json::parse(bytes, nullptr, false);
    if (json.is_discarded()) return "is no JSON";
    // A signal-to-noise ratio of equal pictures is none, nor is glare where nothing glares.
    const bool may = file.filename() == "errors.json" || file.filename() == "glare.json";
    return has_null(json) && !may ? "holds a number that is none" : "";
  }
  if (ending == ".csv" || ending == ".svg" || ending == ".html" || ending == ".ill" ||
      ending == ".res") {
    for (const char* none : {"nan", "inf"}) {
      // Lines of points that are left out, as docs/reference/measurements.md says.
      if (ending == ".res" && std::string_view(none) == "nan") continue;
      const std::size_t place = bytes.find(none);
      if (place != std::string::npos &&
          !std::isalpha(static_cast<unsigned char>(place == 0 ? ' ' : bytes[place - 1])) &&
          !std::isalpha(static_cast<unsigned char>(bytes[place + 3]))) {
        return std::string("holds ") + none;
      }
    }
  }
  return {};
}

/// What of a file has to be the same on a second run: EXRs and records tell times, too.
std::string result_in(const fs::path& file) {
  if (fs::is_directory(file)) {
    std::string all;
    for (const fs::path& inner : files_in(file)) all += result_in(inner);
    return all;
  }
  if (file.extension() == ".exr") {
    std::string bits;
    for (const std::vector<float>& plane : read_image(file).channels) {
      bits.append(reinterpret_cast<const char*>(plane.data()), plane.size() * sizeof plane[0]);
    }
    return bits;
  }
  return file.filename() == "stats.json" ? std::string() : bytes_of(file);
}

/// A trial of one command. Catch reports errors.
class Trial {
 public:
  explicit Trial(const RandomCommand& command)
      : command_(command), before_(contents(command.inputs)) {}

  void check(const CommandRun& run) const {
    CAPTURE(run.errors);
    CHECK(contents(command_.inputs) == before_);
    check_end(run);
    for (const fs::path& output : command_.outputs) {
      CAPTURE(output);
      if (run.exit_code == 0) CHECK(fs::exists(output));
      if (fs::exists(output)) CHECK(problem_of(output) == "");
    }
  }

  static void check_end(const CommandRun& run) {
    CHECK((run.exit_code >= 0 && run.exit_code <= 4));
    const std::string prefix = "photile: error: ";
    const std::vector<std::string> lines = run.error_lines();
    const auto errors = std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.starts_with(prefix);
    });
    CHECK(errors == (run.exit_code == 0 ? 0 : 1));
    if (run.exit_code != 0 && !lines.empty()) {
      CHECK(lines.back().starts_with(prefix));
      CHECK(lines.back().size() < 1'000);
      for (const char* inner : {"internal error", "exception", "std::", "terminate"}) {
        CHECK(lines.back().find(inner) == std::string::npos);
      }
    }
    for (const std::string& line : lines) {
      CHECK(line.find(" nan") == std::string::npos);
      CHECK(line.find(" inf ") == std::string::npos);
    }
  }

 private:
  const RandomCommand& command_;
  const std::map<fs::path, std::string> before_;
};

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* const value = std::getenv(variable);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

/// Waiting for a disk takes longer than most commands do.
void keep_files_in_memory() {
  if (fs::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 1);
}

/// Makes a command load the maps that an equal one has saved, rather than save them.
void load_maps_of(const RandomCommand& first, RandomCommand& second) {
  const auto option = std::find(second.arguments.begin(), second.arguments.end(), "--save-maps");
  if (option == second.arguments.end()) return;
  *option = "--load-maps";
  for (const fs::path& file : first.outputs) {
    if (file.extension() == ".maps") *std::next(option) = file.string();
  }
  std::erase_if(second.outputs, [](const fs::path& file) { return file.extension() == ".maps"; });
}

/// For each light the mean illuminance of a picture's pixels, by the names of its channels.
std::map<std::string, double> mean_illuminances(const fs::path& file) {
  const Image image = read_image(file);
  std::map<std::string, double> means;
  for (std::size_t i = 0; i < image.channels.size(); ++i) {
    if (!image.channel_names[i].starts_with("Illuminance_")) continue;
    const std::vector<float>& plane = image.channels[i];
    means[image.channel_names[i]] =
        std::accumulate(plane.begin(), plane.end(), 0.0) / static_cast<double>(plane.size());
  }
  return means;
}

/// Mean of some values, and its standard error.
struct Mean {
  double value = 0, error = 0;
  explicit Mean(const std::vector<double>& values) {
    const auto count = static_cast<double>(values.size());
    value = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double squares = 0;
    for (const double v : values) squares += (v - value) * (v - value);
    error = std::sqrt(squares / (count * (count - 1)));
  }
};

/// A picture of two layers, to relight and compare.
void write_layers(const fs::path& file) {
  const TemporaryFolder folder;
  Image image;
  image.width = 6;
  image.height = 5;
  float value = 0;
  for (const char* light : {"lamp 0", "lamp 1"}) {
    for (const char* component : {".R", ".G", ".B"}) {
      for (float& pixel : image.add("Combined_" + std::string(light) + component)) {
        pixel = value += 0.25f;
      }
    }
  }
  for (const char* component : {"R", "G", "B"}) image.add(component);
  write_exr(folder.path / "layers.exr", image);
  write_exr(file, relight(read_image(folder.path / "layers.exr"), {}));
}

}  // namespace

TEST_CASE("commands at random keep what every command promises") {
  const std::uint64_t count = number_from("PHOTILE_PROPERTIES", quick_commands),
                      first = number_from("PHOTILE_PROPERTIES_SEED", 1);
  const bool quick = std::getenv("PHOTILE_PROPERTIES") == nullptr;
  keep_files_in_memory();
  std::map<int, std::uint64_t> codes;
  std::map<std::string, std::uint64_t> successes;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Dice dice(seed);
    const TemporaryFolder inputs, outputs, again;
    Workplace place{write_random_scene(inputs.path, dice), outputs.path, inputs.path / "layers.exr",
                    !quick && seed % any_kernels == 0};
    write_layers(place.picture);
    Dice same = dice;
    const RandomCommand command = random_command(place, dice);
    CAPTURE(seed, text_of(command.arguments));
    const Trial trial(command);
    const CommandRun run = run_command(command.arguments);
    trial.check(run);
    // Files that it makes beside those named are those of bake.
    std::set<fs::path> named(command.outputs.begin(), command.outputs.end());
    named.insert(command.inputs.begin(), command.inputs.end());
    for (const auto& entry : fs::directory_iterator(outputs.path)) {
      CAPTURE(entry.path());
      CHECK((named.contains(entry.path()) || command.arguments[0] == "bake"));
      CHECK(entry.path().filename().string()[0] != '.');
    }
    ++codes[run.exit_code];
    if (run.exit_code != 0 || command.outputs.empty()) continue;
    ++successes[command.arguments[0]];
    if (command.timed || (quick && seed % quick_repeats != 0)) continue;
    place.folder = again.path;
    RandomCommand second = random_command(place, same);
    load_maps_of(command, second);
    const CommandRun once_more = run_command(second.arguments);
    CAPTURE(text_of(second.arguments), once_more.errors);
    CHECK(once_more.exit_code == 0);
    for (const fs::path& output : second.outputs) {
      CAPTURE(output);
      CHECK(result_in(output) == result_in(outputs.path / output.filename()));
    }
  }
  if (count < many_commands && (count < quick_commands || first != 1)) return;
  // Neither all refused nor none: of few commands, some kind is all refused by some seeds.
  CHECK(4 * codes[0] > count);
  CHECK(codes[2] > 0);
  CHECK(codes[3] > 0);
  for (const char* command :
       {"render", "relight", "measure", "walk", "compare", "ies", "trace", "glare"}) {
    CAPTURE(command);
    CHECK(successes[command] > 0);
  }
}

TEST_CASE("whatever a sound scene holds, it is rendered") {
  const std::uint64_t count = number_from("PHOTILE_PROPERTIES", quick_commands) / 25,
                      first = number_from("PHOTILE_PROPERTIES_SEED", 1);
  keep_files_in_memory();
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Dice dice(seed);
    const TemporaryFolder folder;
    const RandomScene scene = write_random_scene(folder.path, dice);
    if (!scene.sound) continue;
    const std::string picture = folder.path / "picture.exr";
    std::vector<std::string> arguments{"render", scene.file, "-o",    picture,     "--photons",
                                       "2k",     "--size",   "16x12", "--samples", "1"};
    if (dice.chance(0.5)) arguments.insert(arguments.end(), {"--quality", "draft"});
    CAPTURE(seed, text_of(arguments));
    const CommandRun run = run_command(arguments);
    CAPTURE(run.errors);
    CHECK(run.exit_code == 0);
    if (run.exit_code == 0) CHECK(problem_of_picture(picture) == "");
  }
}

// Energy, of everything on the way from the file to the picture: a light that is lost or counted
// twice, a factor or a unit.
TEST_CASE("maps and paths see the same light in rooms at random", "[slow]") {
  const std::uint64_t count = number_from("PHOTILE_PROPERTIES", quick_commands) / 25,
                      first = number_from("PHOTILE_PROPERTIES_SEED", 1);
  constexpr int seeds = 8;
  // Edges of what few photons reach, and facets of lamps a tenth of a radius wide: the price of
  // estimates, whichever way they lean.
  constexpr double bias = 0.1, t = 7.06;  // Student t, 7 degrees of freedom, 1e-4 on each side
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Dice dice(seed);
    const TemporaryFolder folder;
    const RandomScene scene = write_random_scene(folder.path, dice);
    // Lamps without size throw no caustics by paths: rooms of lamps that have one. And in a room of
    // glass caustics are all there is, of which the scatter of few paths does not tell the error.
    if (!scene.sound || scene.file.extension() != ".obj" || !scene.opaque_room) continue;
    CAPTURE(seed, scene.file);
    std::map<std::string, std::vector<double>> maps, paths;
    for (int i = 0; i < seeds; ++i) {
      const auto add = [&](std::vector<std::string> options, auto& means) {
        const std::string picture = folder.path / "picture.exr";
        std::vector<std::string> arguments{"render", scene.file, "-o", picture,
                                           "--size", "16x12",    "-q", "--seed"};
        arguments.push_back(std::to_string(i + 1));
        arguments.insert(arguments.end(), options.begin(), options.end());
        const CommandRun run = run_command(arguments);
        INFO(run.errors);
        REQUIRE(run.exit_code == 0);
        for (const auto& [light, mean] : mean_illuminances(picture)) means[light].push_back(mean);
      };
      add({"--photons", "20k", "--samples", "4"}, maps);
      add({"--integrator", "path", "--samples", "64"}, paths);
    }
    REQUIRE(maps.size() == paths.size());
    for (const auto& [light, values] : maps) {
      const Mean by_maps(values), by_paths(paths[light]);
      CAPTURE(light, by_maps.value, by_paths.value, by_maps.error, by_paths.error);
      CHECK(std::abs(by_maps.value - by_paths.value) <=
            bias * by_paths.value + t * std::hypot(by_maps.error, by_paths.error));
    }
  }
}

}  // namespace photile::test
