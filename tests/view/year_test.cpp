// Figures that a thread of the live page refines: told as they come, stopped, begun anew.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "view/year_worker.hpp"

namespace photile::test {
namespace {

using view::YearWorker;

/// Until it holds, a minute at most.
template <class Condition>
bool waits_for(Condition holds) {
  for (int i = 0; i < 6000 && !holds(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return holds();
}

}  // namespace

TEST_CASE("a year is measured when it is asked for, and its newest lines are shown") {
  std::atomic<int> begun = 0, stopped = 0;
  std::atomic<bool> go_on = false;
  {
    YearWorker year([&](const auto& tell, Progress& progress) {
      ++begun;
      tell({"one round"});
      while (!go_on && !progress.cancelled()) std::this_thread::yield();
      stopped += progress.cancelled();
      progress.throw_if_cancelled();
      tell({"two rounds", "certain"});
    });
    CHECK(year.possible());
    CHECK(begun == 0);
    CHECK(year.lines().empty());
    year.start();
    CHECK(waits_for([&] { return year.lines() == YearWorker::Lines{"one round"}; }));
    CHECK(year.running());
    year.start();  // again: what is under way ends first
    CHECK(stopped == 1);
    CHECK(waits_for([&] { return begun == 2; }));
    go_on = true;
    CHECK(waits_for([&] { return !year.running(); }));
    CHECK(year.lines() == YearWorker::Lines{"two rounds", "certain"});
    go_on = false;
    year.start();
    CHECK(waits_for([&] { return begun == 3; }));
  }
  CHECK(stopped == 2);  // a page that is closed waits for nothing
}

TEST_CASE("a year that cannot be measured says why") {
  YearWorker year([](const auto&, Progress&) { throw std::runtime_error("no floor found"); });
  year.start();
  CHECK(waits_for([&] { return !year.running(); }));
  CHECK(year.lines() == YearWorker::Lines{"no floor found"});
  CHECK_FALSE(YearWorker(nullptr).possible());
}

}  // namespace photile::test
