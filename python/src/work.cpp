#include "work.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "parts.hpp"
#include "photile/errors.hpp"

namespace py = pybind11;

namespace photile::python {
namespace {

/// The work of the process. Never destroyed: threads may outlive the interpreter.
struct Work {
  std::mutex mutex;
  std::condition_variable finished;
  std::size_t under_way = 0;
  std::atomic<pid_t> process{0};  ///< the first that worked
  std::atomic<bool> ending{false};
};

Work& all_work() {
  static Work& work = *new Work;
  return work;
}

/// Stops what is under way and waits for it: a thread that then asks an interpreter that has ended
/// for its lock ends, and takes the process with it.
void end_work() {
  Work& work = all_work();
  const py::gil_scoped_release release;
  if (work.process != getpid()) return;  // a fork may have left the mutex locked
  std::unique_lock lock(work.mutex);
  work.ending = true;
  work.finished.wait(lock, [&] { return work.under_way == 0; });
}

/// What the thread at work has told, until the waiting one passes it on.
class Mailbox : public Progress {
 public:
  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override {
    const std::lock_guard lock(mutex_);
    stage_ = {std::string(stage), total, std::string(unit)};
    done_ = 0;
    news_ = true;
  }
  void advance(std::uint64_t count) override {
    done_ += count;
    news_ = true;
  }
  void end() override {
    const std::lock_guard lock(mutex_);
    if (stage_.total > 0) done_ = stage_.total;
    news_ = true;
  }
  void note(const std::string& line) override {
    const std::lock_guard lock(mutex_);
    notes_.push_back(line);
  }
  bool cancelled() const override { return stop_ || all_work().ending; }

  void stop() { stop_ = true; }

  /// Called with the interpreter's lock.
  void pass_on(const py::object& callback) {
    std::vector<std::string> notes;
    Stage stage;
    {
      const std::lock_guard lock(mutex_);
      notes.swap(notes_);
      stage = stage_;
    }
    for (const std::string& line : notes) {
      py::module_::import("logging").attr("getLogger")("photile").attr("info")("%s", line);
    }
    if (callback.is_none() || !news_.exchange(false)) return;
    callback(stage.name, done_.load(), stage.total, stage.unit);
  }

 private:
  struct Stage {
    std::string name;
    std::uint64_t total = 0;
    std::string unit;
  };
  std::mutex mutex_;
  Stage stage_;
  std::vector<std::string> notes_;
  std::atomic<std::uint64_t> done_{0};
  std::atomic<bool> news_{false}, stop_{false};
};

/// A flag that a thread waits for.
class Flag {
 public:
  void raise() {
    const std::lock_guard lock(mutex_);
    raised_ = true;
    changed_.notify_all();
  }
  bool wait(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, [this] { return raised_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool raised_ = false;
};

}  // namespace

bool is_forked() {
  const pid_t process = all_work().process;
  return process != 0 && process != getpid();
}

Working::Working() {
  Work& work = all_work();
  if (is_forked()) {
    throw UsageError(
        "this process was forked from one that has used photile, and lacks its threads; start it "
        "with multiprocessing.get_context('spawn')");
  }
  const std::lock_guard lock(work.mutex);
  if (work.ending) throw UsageError("the interpreter is shutting down");
  work.process = getpid();
  ++work.under_way;
}

Working::~Working() {
  Work& work = all_work();
  const std::lock_guard lock(work.mutex);
  --work.under_way;
  work.finished.notify_all();
}

void define_work(py::module_&) {
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_work));
}

void run_in_thread(const py::object& callback, const std::function<void(Progress&)>& work) {
  const Working working;
  Mailbox mailbox;
  Flag finished;
  std::exception_ptr error;
  std::thread worker([&] {
    try {
      work(mailbox);
    } catch (...) {
      error = std::current_exception();
    }
    finished.raise();
  });
  std::optional<py::error_already_set> raised;
  const auto hear = [&] {
    if (raised) return;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      mailbox.pass_on(callback);
    } catch (py::error_already_set& exception) {
      raised.emplace(std::move(exception));
      mailbox.stop();
    }
  };
  {
    const py::gil_scoped_release release;
    while (!finished.wait(std::chrono::milliseconds(50))) {
      const py::gil_scoped_acquire acquire;
      hear();
    }
    worker.join();
  }
  hear();
  if (raised) throw std::move(*raised);
  if (error) std::rethrow_exception(error);
}

}  // namespace photile::python
