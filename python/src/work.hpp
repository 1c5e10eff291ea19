// Long work of the library, called from Python.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include "photile/progress.hpp"

namespace photile::python {

/// Whether this process was forked off one that has used the library, whose threads and devices it
/// lacks.
bool is_forked();

/// Counts as work of the library while it lives: the interpreter ends when none is left, and asks
/// what is under way to stop. Made and destroyed with the interpreter's lock.
/// Errors: UsageError in a child forked off a process that has worked, whose threads it lacks, and
/// once the interpreter ends.
class Working {
 public:
  Working();
  ~Working();
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;
};

/// Work without the interpreter's lock, for as long as this lives.
class Unlocked {
  Working working_;
  pybind11::gil_scoped_release release_;
};

/// Runs `work` in a thread of its own without the interpreter's lock. The calling thread waits,
/// hears Ctrl-C and tells `callback` (stage, done, total, unit) what is done, a few times a second;
/// notes go to the logger "photile". `callback` may be None.
/// Errors: what `work` throws; what the callback or a signal handler raises, once the work has
/// stopped.
void run_in_thread(const pybind11::object& callback, const std::function<void(Progress&)>& work);

/// Runs work that has a result.
template <class Work>
auto run(const pybind11::object& callback, const Work& work) {
  using Result = decltype(work(std::declval<Progress&>()));
  std::optional<Result> result;
  run_in_thread(callback, [&](Progress& progress) { result.emplace(work(progress)); });
  return std::move(*result);
}

}  // namespace photile::python
