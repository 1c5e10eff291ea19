#include "tools/command/process_time.hpp"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace photile::app {
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

}  // namespace

TimeTaken time_of_loading() {
  const double processor = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  const double start = process_start();
  const double age = start < 0 ? processor : std::max(0.0, seconds_of(CLOCK_BOOTTIME) - start);
  // A shell turns into the last program that it runs: the process is then older than the program,
  // whose loading hardly waits for anything.
  constexpr double longest_wait = 5;
  return {.seconds = age > processor + longest_wait ? processor : age,
          .processor_seconds = processor};
}

}  // namespace photile::app
