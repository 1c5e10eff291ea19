#include "command/processes.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <thread>

#include "command/command_line.hpp"
#include "common/content_hash.hpp"
#include "common/module.hpp"
#include "common/process_limits.hpp"
#include "mpi_communicator.hpp"
#include "photile/errors.hpp"
#include "render/exchange.hpp"

namespace photile::app {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

void request_stop(int) { stop.store(true, std::memory_order_relaxed); }

/// Takes the first signal, and leaves the next one its default action: a stage may take too long to
/// stop.
void take_signals(const sigset_t& signals) {
  int signal = 0;
  if (sigwait(&signals, &signal) != 0) return;
  request_stop(signal);
  for (const int next : {SIGINT, SIGTERM}) std::signal(next, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  for (;;) pause();
}

}  // namespace

void handle_signals() {
  // For signals that reach threads which were started earlier: those of MPI.
  struct sigaction action {};
  action.sa_handler = request_stop;
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A thread takes the signals, and all others block them: PoCL's compiler puts a handler of its
  // own before ours, which removes the files that are being written.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  require_threads(1);
  std::thread(take_signals, signals).detach();
  std::signal(SIGXFSZ, SIG_IGN);
}

bool stop_requested() { return stop.load(std::memory_order_relaxed); }

void throw_if_stop_requested() {
  if (stop_requested()) throw Interrupted();
}

struct ThreadLimit::Impl {
  explicit Impl(int count)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)) {}

  /// Constructed in place: TBB knows it by its address, and a copy would limit nothing.
  const tbb::global_control control;
};

ThreadLimit::ThreadLimit(int count) {
  const int used = count == 0 ? core_count() : std::min(count, core_count());
  constexpr int own = 4;  // the progress bar, the next picture's kernels and the like
  require_threads(2 * used + own);
  if (count == 0) return;
  impl_ = std::make_unique<Impl>(count);
  // Variables that the user set in the environment stay.
  for (const char* variable : pocl_thread_variables) {
    setenv(variable, std::to_string(used).c_str(), 0);
  }
}

ThreadLimit::~ThreadLimit() = default;

namespace {

Communicator* communicator = nullptr;
decltype(&photile_mpi_other_failed) other_failed_of_module = nullptr;

int number_in(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atoi(text);
}

/// Processes that a launcher with MPI has started: mpirun of OpenMPI, of MPICH and its kin, srun
/// with PMI. 0: none did. Some launchers tell the number to MPI alone: then 1.
int launched_with_mpi() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const int count = number_in(variable); count > 0) return count;
  }
  return std::getenv("PMIX_RANK") != nullptr ? 1 : 0;
}

/// Whether each process has separate frames, so that several do not write the same file.
bool names_its_frames(std::span<const char* const> arguments) {
  return std::any_of(arguments.begin(), arguments.end(), [](const char* argument) {
    return std::string_view(argument).starts_with("--frames");
  });
}

/// Adds the words of the command, without those of what each process may have its own of.
void add_request(std::span<const char* const> arguments, ContentHash& request) {
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    if (word.starts_with("--device=") || word.starts_with("--threads=")) continue;
    if (word == "--device" || word == "--threads") {
      ++i;
    } else {
      request.add(std::string(word));
    }
  }
}

}  // namespace

void join_processes(std::span<const char* const> arguments) {
  communicator = nullptr;
  const int launched = launched_with_mpi();
  if (launched == 0) {
    const int tasks = std::getenv("SLURM_STEP_ID") ? number_in("SLURM_STEP_NUM_TASKS") : 0;
    if (tasks > 1 && !names_its_frames(arguments)) {
      throw UsageError(fmt::format(
          "srun has started {} tasks without MPI; use srun --mpi=pmix or mpirun, or give each task "
          "its --frames",
          tasks));
    }
    return;
  }
  // Global: MPI libraries load plug-ins, which need the symbols of the rest. It is never unloaded.
  static const Module& module = *new Module("photile_mpi.so", Module::Symbols::global);
  auto* const found = module.find<decltype(photile_mpi_communicator)>("photile_mpi_communicator");
  if (!found) {
    if (launched == 1) return;
    throw UsageError(
        fmt::format("mpirun has started {} processes, but photile's module for MPI cannot be "
                    "loaded: {}; install the package photile-mpi, or start one process",
                    launched, module.error()));
  }
  other_failed_of_module =
      module.find<decltype(photile_mpi_other_failed)>("photile_mpi_other_failed");
  communicator = found();
  if (!communicator) throw UsageError("MPI cannot be initialised; read the messages of mpirun");
  const std::string version = version_number();
  for (const Communicator::Bytes& other : communicator->gather(std::as_bytes(std::span(version)))) {
    if (std::ranges::equal(other, std::as_bytes(std::span(version)))) continue;
    throw UsageError("processes run different versions of photile; install one on all machines");
  }
  ContentHash request;
  add_request(arguments, request);
  require_same(*communicator, request, "options");
}

Communicator* processes() { return communicator; }

bool other_failed() { return communicator != nullptr && other_failed_of_module(); }

bool leads() { return communicator == nullptr || communicator->rank() == 0; }

std::filesystem::path folder_of_program(const char* installed, const char* built) {
  const auto here = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto folder = (here / installed).lexically_normal();
  return std::filesystem::exists(here / built) && !std::filesystem::exists(folder) ? here / built
                                                                                   : folder;
}

std::vector<bool> as_first_says(const std::vector<bool>& own) {
  if (!communicator) return own;
  std::vector<std::byte> bytes;
  for (const bool one : own) bytes.push_back(std::byte{one});
  if (!leads()) bytes.clear();
  const std::vector<Communicator::Bytes> all = communicator->gather(bytes);
  std::vector<bool> said;
  for (const std::byte one : all.front()) said.push_back(one != std::byte{0});
  return said;
}

void refuse_several(const std::string& what, const std::string& remedy) {
  if (communicator == nullptr || communicator->size() == 1) return;
  throw UsageError(fmt::format("{} works only with one process, and there are {}; {}", what,
                               communicator->size(), remedy));
}

}  // namespace photile::app
