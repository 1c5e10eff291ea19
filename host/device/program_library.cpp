#include "device/program_library.hpp"

#include <numeric>

#include "device/cache_folder.hpp"
#include "device/pocl_work_folder.hpp"
#include "device/program_source.hpp"
#include "photile/statistics.hpp"

namespace photile::device {
namespace {

/// Where compiled kernels are kept between runs; none where nothing can be.
std::optional<KernelStore> kernel_store(const char* ending) {
  const auto folder = persistent_cache_folder();
  if (!folder) return std::nullopt;
  return KernelStore(*folder / "kernels", installed_kernel_folders(), ending);
}

/// The cache over this process's work folder; null where PoCL keeps its files elsewhere or nothing
/// can be kept.
PoclCache* shared_pocl_cache() {
  static const auto cache = []() -> std::unique_ptr<PoclCache> {
    const auto work = pocl_work_folder();
    if (!work) return nullptr;
    auto store = kernel_store(".pack");
    return store ? std::make_unique<PoclCache>(*work, std::move(*store)) : nullptr;
  }();
  return cache.get();
}

}  // namespace

ProgramLibrary::ProgramLibrary(const BuildTarget& target, bool use_cache)
    : target_(target), base_options_(base_options(target.device)) {
  if (!use_cache) return;
  if (target.info->is_pocl) {
    pocl_cache_ = shared_pocl_cache();
  } else {
    cache_ = kernel_store(".program");
  }
}

ProgramLibrary::~ProgramLibrary() {
  if (pocl_cache_ != nullptr) pocl_cache_->publish();
}

cl_program ProgramLibrary::get(const std::string& file, const std::string& defines) {
  const auto key = std::make_pair(file, defines);
  if (const auto found = programs_.find(key); found != programs_.end()) return found->second.get();
  const Stopwatch stopwatch;
  auto program = load_or_build(file, options(defines));
  times_.push_back({file, stopwatch.seconds()});
  return programs_.emplace(key, std::move(program)).first->second.get();
}

cl_program ProgramLibrary::get_compiled(const std::string& file, const std::string& defines) {
  const Stopwatch stopwatch;
  auto program = build_from_source(target_, file, assemble_source(file), options(defines));
  ++built_;
  times_.push_back({file, stopwatch.seconds()});
  auto& kept = programs_[{file, defines}];
  kept = std::move(program);
  return kept.get();
}

std::string ProgramLibrary::options(const std::string& defines) const {
  return defines.empty() ? base_options_ : base_options_ + " " + defines;
}

double ProgramLibrary::compile_seconds() const {
  return std::accumulate(times_.begin(), times_.end(), 0.0,
                         [](double sum, const ProgramTime& time) { return sum + time.seconds; });
}

ProgramHandle ProgramLibrary::load_or_build(const std::string& file, const std::string& options) {
  const auto source = assemble_source(file);
  const auto key = program_key(*target_.info, options, source);
  if (pocl_cache_ != nullptr) {
    ProgramHandle program;
    const bool found = pocl_cache_->build(
        key, [&] { program = build_from_source(target_, file, source, options); });
    ++(found ? from_cache_ : built_);
    return program;
  }
  if (cache_) {
    if (const auto binary = cache_->load(key)) {
      if (auto program = build_from_binary(target_, *binary, options)) {
        ++from_cache_;
        return program;
      }
      warn("the device refuses '" + cache_->file(key).string() + "'; compiling again");
    }
  }
  auto program = build_from_source(target_, file, source, options);
  ++built_;
  if (cache_) {
    if (const auto binary = program_binary(program.get())) cache_->store(key, *binary);
  }
  return program;
}

}  // namespace photile::device
