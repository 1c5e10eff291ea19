#include "view/year_worker.hpp"

#include <exception>
#include <utility>

#include "common/stoppable_progress.hpp"
#include "photile/errors.hpp"

namespace photile::view {

void YearWorker::start() {
  thread_ = {};  // what is under way is stopped
  {
    const std::lock_guard lock(mutex_);
    lines_.clear();
    running_ = true;
  }
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

bool YearWorker::running() const {
  const std::lock_guard lock(mutex_);
  return running_;
}

YearWorker::Lines YearWorker::lines() const {
  const std::lock_guard lock(mutex_);
  return lines_;
}

void YearWorker::tell(Lines lines) {
  const std::lock_guard lock(mutex_);
  lines_ = std::move(lines);
}

void YearWorker::work(const std::stop_token& stop) {
  StoppableProgress progress(Progress::none(), [&] { return stop.stop_requested(); });
  try {
    measure_([this](Lines lines) { tell(std::move(lines)); }, progress);
  } catch (const Interrupted&) {
  } catch (const std::exception& error) {
    tell({error.what()});
  }
  const std::lock_guard lock(mutex_);
  running_ = false;
}

}  // namespace photile::view
