#include "common/threads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <latch>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

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
      fmt::format("only {} of {} threads can be made: {}; raise the limit of processes "
                  "(ulimit -u, or pids of the container)",
                  threads.size(), count, problem));
}

}  // namespace photile
