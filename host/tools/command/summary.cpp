#include "tools/command/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/command/number_format.hpp"

namespace photile::app {
namespace {

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
