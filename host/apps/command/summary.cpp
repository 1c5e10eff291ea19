#include "command/summary.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>

#include "command/scene_report.hpp"
#include "command/terminal_progress.hpp"

namespace photile::app {

namespace {

constexpr std::size_t shown_warnings = 20;  // a broken file may have thousands

}  // namespace

void tell_device(const DeviceInfo& device, Progress& progress) {
  progress.note(fmt::format("device: {} {} ({}, {}), {} compute units, {}", device.id, device.name,
                            device.platform, device.driver_version, device.compute_units,
                            format_bytes(device.global_memory_bytes)));
}

void tell_scene(const Scene& scene, const LightMix& mix, const SceneLoadOptions& load,
                Progress& progress) {
  for (const auto& line : scene_summary(scene, mix)) progress.note(line);
  for (const auto& line : sky_lines(load)) progress.note(line);
  const std::vector<std::string>& warnings = scene.report.warnings;
  for (std::size_t i = 0; i < std::min(warnings.size(), shown_warnings); ++i) {
    progress.warn(warnings[i]);
  }
  if (warnings.size() > shown_warnings) {
    progress.warn(fmt::format("{} more; photile info shows all", warnings.size() - shown_warnings));
  }
}

std::vector<Device> devices_for(const RenderOptions& options, Progress& progress) {
  if (options.integrator == Integrator::path) return {};
  std::vector<Device> devices = open_devices(options.device);
  for (const Device& device : devices) tell_device(device.info(), progress);
  return devices;
}

namespace {

/// Seconds from the system's start to the process's; negative where they cannot be read.
double process_start() {
  std::ifstream file("/proc/self/stat");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  // Fields are counted after the program's name, which may hold blanks and parentheses.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return -1;
  std::istringstream fields(text.substr(name_end + 1));
  constexpr int start_field = 22, first_field = 3;  // of proc(5)
  std::string field;
  for (int i = first_field; i <= start_field; ++i) fields >> field;
  if (!fields) return -1;
  return std::stod(field) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::string memory(std::uint64_t bytes) { return bytes == 0 ? "-" : format_bytes(bytes); }

std::string figures_text(const StageStatistics& stage) {
  std::string text;
  for (const auto& [name, value] : stage.figures) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, format_count(value));
  }
  return text;
}

/// One row of the summary; no blanks at its end.
std::string row(const std::string& stage, const std::string& seconds, const std::string& processor,
                const std::string& host, const std::string& device, const std::string& figures) {
  std::string line = fmt::format("{:<22}{:>9}{:>11}{:>12}{:>12}  {}", stage, seconds, processor,
                                 host, device, figures);
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace

TimeTaken time_of_loading() {
  const double processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  const double start = process_start();
  const double age = start < 0 ? processor : std::max(0.0, seconds_of(CLOCK_BOOTTIME) - start);
  // A shell may replace itself by the last program that it runs: then the process is older than the
  // program, whose loading takes about as much processor time as wall time.
  constexpr double longest_wait = 5;
  return {.seconds = age > processor + longest_wait ? processor : age,
          .processor_seconds = processor};
}

std::vector<std::string> summary_table(const RunRecord& record) {
  std::vector<std::string> lines{row("stage", "seconds", "processor", "host", "device", "figures")};
  for (const StageStatistics& stage : record.stages) {
    lines.push_back(row(stage.stage, fmt::format("{:.3f}", stage.seconds),
                        fmt::format("{:.3f}", stage.processor_seconds), memory(stage.host_bytes),
                        memory(stage.device_bytes), figures_text(stage)));
  }
  lines.push_back(row("total", fmt::format("{:.3f}", record.total.seconds),
                      fmt::format("{:.3f}", record.total.processor_seconds),
                      memory(peak_host_bytes()), "", "(host: peak of the process)"));
  return lines;
}

std::vector<std::string> kernel_table(std::vector<device::KernelTime> times) {
  std::sort(times.begin(), times.end(),
            [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  std::vector<std::string> lines{
      fmt::format("{:<32}{:>10}{:>12}{:>12}", "kernel", "launches", "seconds", "mean ms")};
  for (const auto& time : times) {
    const double mean = time.launches == 0 ? 0 : time.seconds / static_cast<double>(time.launches);
    lines.push_back(fmt::format("{:<32}{:>10}{:>12.4f}{:>12.4f}", time.kernel, time.launches,
                                time.seconds, 1e3 * mean));
  }
  return lines;
}

}  // namespace photile::app
