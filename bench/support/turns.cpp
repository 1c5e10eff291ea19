#include "support/turns.hpp"

#include "photile/statistics.hpp"
#include "support/bench_record.hpp"
#include "support/estimate_check.hpp"
#include "support/kernel_seconds.hpp"
#include "support/least_work.hpp"

namespace photile::bench {

std::uint64_t take_turns(std::vector<Contestant>& contestants, const Repeats& repeats) {
  struct Counted {
    RunTimes times;
    Timing kernels;
  };
  std::vector<Counted> counted(contestants.size());
  for (const Contestant& one : contestants) one.run();
  const Stopwatch stopwatch;
  const double affordable = repeats.seconds_per_case * static_cast<double>(contestants.size());
  for (int round = 0; round < repeats.most; ++round) {
    if (!repeats.all && round >= 3 && stopwatch.seconds() > affordable) break;
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      const Contestant& one = contestants[i];
      if (!one.device) {
        counted[i].times.count(one.run);
        continue;
      }
      counted[i].kernels.seconds.push_back(
          kernel_seconds_of(*one.device, [&] { counted[i].times.count(one.run); }));
    }
  }
  std::uint64_t faults = 0;
  for (std::size_t i = 0; i < contestants.size(); ++i) {
    nlohmann::json& row = contestants[i].row;
    const RunTimes& times = counted[i].times;
    row["seconds"] = to_json(times.wall);
    row["processor seconds"] = to_json(times.processor);
    row["system seconds"] = to_json(times.system);
    if (contestants[i].device) row["kernel seconds"] = to_json(counted[i].kernels);
    LeastWork(row["queries"].get<std::size_t>(), row["k"].get<int>())
        .add_to(row, times.wall.median());
    const std::uint64_t wrong = contestants[i].finish(row);
    if (wrong > 0) print_fault(row.value("structure", ""), wrong);
    faults += wrong;
  }
  return faults;
}

}  // namespace photile::bench
