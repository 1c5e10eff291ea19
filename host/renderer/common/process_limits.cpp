#include "common/process_limits.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <latch>
#include <limits>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile {

int core_count() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

void require_threads(int count) {
  std::latch tried(1);
  std::vector<std::thread> threads;
  std::string problem;
  try {
    while (static_cast<int>(threads.size()) < count) {
      threads.emplace_back([&tried] { tried.wait(); });
    }
  } catch (const std::system_error& error) {
    problem = error.what();
  }
  tried.count_down();
  for (std::thread& thread : threads) thread.join();
  if (problem.empty()) return;
  throw Error(
      fmt::format("only {} of {} threads can be created: {}; raise the limit of processes (ulimit "
                  "-u, or pids of the container)",
                  threads.size(), count, problem));
}

void require_stack() {
  constexpr rlim_t least = 1 << 20;  // the compilers of devices use half of it
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= least) return;
  throw Error(fmt::format("the stack limit is {} kB, but {} are needed; raise it (ulimit -s 8192)",
                          limit.rlim_cur >> 10, least >> 10));
}

void lower_priority() {
  constexpr int niceness = 10;
  std::error_code missing;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", missing)) {
    const auto id = parse_number<id_t>(thread.path().filename().string());
    if (id) setpriority(PRIO_PROCESS, *id, niceness);
  }
}

std::uint64_t address_bytes_left() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return std::numeric_limits<std::uint64_t>::max();
  }
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const std::uint64_t used = pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  return limit.rlim_cur - std::min<std::uint64_t>(limit.rlim_cur, used);
}

}  // namespace photile
