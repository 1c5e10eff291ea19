#include "command/processes.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "common/module.hpp"
#include "mpi_communicator.hpp"
#include "photile/errors.hpp"

namespace photile::app {

namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

void request_stop(int) { stop.store(true, std::memory_order_relaxed); }

}  // namespace

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = request_stop;
  // SA_RESETHAND: the second signal has its default action, for a stage that takes too long to
  // stop.
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool stop_requested() { return stop.load(std::memory_order_relaxed); }

void throw_if_stop_requested() {
  if (stop_requested()) throw Interrupted();
}

struct ThreadLimit::Impl {
  explicit Impl(int count)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)) {}

  /// Made in its place: TBB knows it by its address, and a copy would limit nothing.
  const tbb::global_control control;
};

ThreadLimit::ThreadLimit(int count) {
  if (count == 0) return;
  impl_ = std::make_unique<Impl>(count);
  // What the user set in the environment stays. PoCL before 4 knows the first name, later ones the
  // second.
  for (const char* variable : {"POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT"}) {
    setenv(variable, std::to_string(count).c_str(), 0);
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
/// with PMI. 0: none did. Some tell it to MPI alone: then 1.
int launched_with_mpi() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const int count = number_in(variable); count > 0) return count;
  }
  return std::getenv("PMIX_RANK") != nullptr ? 1 : 0;
}

/// Whether each process has a part of its own, so that several do not write the same file.
bool names_its_part(std::span<const char* const> arguments) {
  for (const char* argument : arguments) {
    for (const std::string_view option : {"--shard", "--frames"}) {
      if (std::string_view(argument).starts_with(option)) return true;
    }
  }
  return false;
}

}  // namespace

void join_processes(std::span<const char* const> arguments) {
  communicator = nullptr;
  const int launched = launched_with_mpi();
  if (launched == 0) {
    const int tasks = std::getenv("SLURM_STEP_ID") ? number_in("SLURM_STEP_NUM_TASKS") : 0;
    if (tasks > 1 && !names_its_part(arguments)) {
      throw UsageError(fmt::format(
          "srun has started {} tasks without MPI; use srun --mpi=pmix or mpirun, or give each task "
          "its --shard",
          tasks));
    }
    return;
  }
  // Global: MPI libraries load parts of their own, which look for the rest. It is never unloaded.
  static const Module& module = *new Module("photile_mpi.so", Module::Symbols::global);
  auto* const found = module.find<decltype(photile_mpi_communicator)>("photile_mpi_communicator");
  if (!found) {
    if (launched == 1) return;
    throw UsageError(fmt::format(
        "mpirun has started {} processes, and photile's part for MPI is not here: {}; install the "
        "package photile-mpi, or start one process",
        launched, module.error()));
  }
  other_failed_of_module =
      module.find<decltype(photile_mpi_other_failed)>("photile_mpi_other_failed");
  communicator = found();
  if (!communicator) throw UsageError("MPI cannot be initialised; see what mpirun says");
}

Communicator* processes() { return communicator; }

bool other_failed() { return communicator != nullptr && other_failed_of_module(); }

bool leads() { return communicator == nullptr || communicator->rank() == 0; }

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
  throw UsageError(fmt::format("{} is of one process, and {} share the work; {}", what,
                               communicator->size(), remedy));
}

}  // namespace photile::app
