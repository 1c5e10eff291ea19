#include "support/bench_record.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <thread>
#include <vector>

#include "photile/errors.hpp"

namespace photile::bench {
namespace {

/// "model name" of /proc/cpuinfo; "unknown" on systems without it.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

/// Today in UTC, as 2012-12-31.
std::string date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday);
}

/// The commit of the sources that the bench was built from; "unknown" without git.
std::string commit() {
  std::string text;
  if (FILE* const git =
          popen("git -C '" PHOTILE_SOURCE_DIR "' describe --always --dirty 2>/dev/null", "r")) {
    for (int c = std::fgetc(git); c != EOF && c != '\n'; c = std::fgetc(git))
      text += static_cast<char>(c);
    pclose(git);
  }
  return text.empty() ? "unknown" : text;
}

/// The arguments of the process, without its name; empty on systems without /proc.
std::vector<std::string> command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  if (!words.empty()) words.erase(words.begin());
  return words;
}

double load_average() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

}  // namespace

void add_options(CLI::App& command, BenchOptions& options, Repeating repeating) {
  command.add_flag("--quick", options.quick,
                   "tiny sizes, and one repeat without --repeats: a smoke test");
  options.repeats_cases = repeating == Repeating::yes;
  CLI::Option* repeats = nullptr;
  if (repeating == Repeating::yes) {
    repeats = command.add_option("--repeats", options.repeats.most, "timed repeats of each case")
                  ->check(CLI::Range(1, 1000))
                  ->capture_default_str();
    command
        .add_option("--seconds-per-case", options.repeats.seconds_per_case,
                    "a case that took longer ends after three repeats, unless --repeats says how "
                    "many; knn asks fewer queries then")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
  }
  command.add_option("--device", options.device, "OpenCL device, as for photile --device");
  command
      .add_option("--kernel", options.kernels,
                  "folder of kernel files, as kernels/: those that it has are compiled in place of "
                  "the built-in ones")
      ->type_name("DIR");
  command.add_option("-o,--output", options.output, "JSON file");
  command.callback([&options, repeats] {
    options.repeats.all = repeats && !repeats->empty();
    if (options.quick && !options.repeats.all) options.repeats.most = 1;
    if (!options.kernels.empty()) setenv("PHOTILE_KERNEL_DIR", options.kernels.c_str(), 1);
  });
}

nlohmann::json to_json(const Timing& timing) {
  return {{"median", timing.median()},
          {"min", timing.smallest()},
          {"max", timing.largest()},
          {"samples", timing.seconds}};
}

BenchRecord::BenchRecord(const std::string& bench, const BenchOptions& options)
    : output_(options.output) {
  json_["schema version"] = schema_version;
  json_["bench"] = bench;
  json_["date"] = date();
  json_["commit"] = commit();
  json_["command line"] = command_line();
  json_["machine"] = {{"processor", processor()},
                      {"hardware threads", std::thread::hardware_concurrency()},
                      {"load average at start", load_average()}};
  json_["versions"] = {{"photile", PHOTILE_VERSION}, {"compiler", __VERSION__}};
  json_["settings"] = {{"quick", options.quick}, {"kernels", options.kernels}};
  if (options.repeats_cases) {
    json_["settings"]["repeats"] = options.repeats.most;
    json_["settings"]["seconds per case"] = options.repeats.seconds_per_case;
  }
  json_["results"] = nlohmann::json::array();
}

void BenchRecord::set_device(const DeviceInfo& info) {
  json_["device"] = {{"name", info.name},
                     {"type", name_of(info.type)},
                     {"platform", info.platform},
                     {"driver", info.driver_version},
                     {"compute units", info.compute_units}};
}

void BenchRecord::set_version(const std::string& library, const std::string& version) {
  json_["versions"][library] = version;
}

void BenchRecord::add(nlohmann::json row) {
  nlohmann::json line = row;
  for (auto& [key, value] : line.items()) {
    if (value.is_object() && value.contains("median")) value = value["median"];
  }
  std::cout << line.dump() << std::endl;
  json_["results"].push_back(std::move(row));
}

void BenchRecord::write() const {
  if (output_.empty()) return;
  std::filesystem::path temporary = output_;
  temporary += ".tmp";
  {
    std::ofstream file(temporary);
    file << json_.dump(1) << '\n';
    file.close();
    if (!file) throw OutputError(temporary.string() + ": cannot be written");
  }
  std::filesystem::rename(temporary, output_);
}

int run_bench(CLI::App& command, int argument_count, char** arguments,
              const std::function<bool()>& run) {
  try {
    command.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    return command.exit(error);
  }
  try {
    return run() ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << command.get_name() << ": error: " << error.what() << '\n';
    return EXIT_FAILURE;
  }
}

}  // namespace photile::bench
