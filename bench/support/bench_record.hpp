// What every bench shares: its options and the JSON file that it writes.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "photile/device.hpp"
#include "support/timing.hpp"

namespace photile::bench {

/// The version of the JSON files (docs/kernels/points.md) is raised when a name changes its meaning
/// or goes, not when one comes.
inline constexpr int schema_version = 2;

struct BenchOptions {
  bool quick = false;  ///< tiny sizes: shows that the bench works, times nothing
  Repeats repeats;
  bool repeats_cases = true;     ///< whether `repeats` counts: not for every bench
  std::filesystem::path output;  ///< JSON file; empty = none
  std::string device;   ///< selector as for `photile --device`; "" = PHOTILE_DEVICE or best
  std::string kernels;  ///< folder of kernel files in place of the built-in ones; "" = none
};

/// Whether a bench repeats its cases: one that does not refuses --repeats.
enum class Repeating { yes, no };

/// Adds the options that every bench has. With --quick there is one repeat, unless --repeats says
/// otherwise; as many as that are made, however long they take.
void add_options(CLI::App& command, BenchOptions& options, Repeating repeating = Repeating::yes);

/// Times as {"median", "min", "max", "samples"}, in seconds.
nlohmann::json to_json(const Timing& timing);

/// The results of a bench with the date, the machine, the device and the versions that they belong
/// to.
class BenchRecord {
 public:
  /// Takes the load of the machine now, before the bench adds to it.
  BenchRecord(const std::string& bench, const BenchOptions& options);

  void set_device(const DeviceInfo& info);
  void set_version(const std::string& library, const std::string& version);
  void set(const std::string& setting, nlohmann::json value) { json_["settings"][setting] = value; }
  /// Keeps a row and prints it as one line.
  void add(nlohmann::json row);
  /// Writes the file that the options ask for, through a temporary name. Errors: OutputError.
  void write() const;

 private:
  std::filesystem::path output_;
  nlohmann::json json_;
};

/// Runs a bench: parses the command line with the given options added, prints any photile::Error as
/// one line. Returns the exit code.
///   run   returns false when a check of the results failed
int run_bench(CLI::App& command, int argument_count, char** arguments,
              const std::function<bool()>& run);

}  // namespace photile::bench
