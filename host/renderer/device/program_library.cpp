#include "device/program_library.hpp"

#include <nlohmann/json.hpp>
#include <numeric>

#include "device/cache_folder.hpp"
#include "device/pocl_cache.hpp"
#include "device/program.hpp"
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
    const auto& work = pocl_work_folder();
    auto store = work.empty() ? std::nullopt : kernel_store(".pocl");
    return store ? std::make_unique<PoclCache>(work, std::move(*store)) : nullptr;
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

const Program& ProgramLibrary::get(const std::string& file, const std::string& defines) {
  const auto key = std::make_pair(file, defines);
  if (const auto found = programs_.find(key); found != programs_.end()) return found->second;
  const Stopwatch stopwatch;
  auto program = load_or_build(file, options(defines));
  dump_program(file, options(defines), program.handle.get());
  times_.push_back({file, stopwatch.seconds()});
  return programs_.emplace(key, std::move(program)).first->second;
}

std::string ProgramLibrary::options(const std::string& defines) const {
  return defines.empty() ? base_options_ : base_options_ + " " + defines;
}

double ProgramLibrary::compile_seconds() const {
  return std::accumulate(times_.begin(), times_.end(), 0.0,
                         [](double sum, const ProgramTime& time) { return sum + time.seconds; });
}

Program ProgramLibrary::load_or_build(const std::string& file, const std::string& options) {
  const auto source = assemble_source(file);
  const auto key = program_key(*target_.info, options, source);
  if (pocl_cache_ != nullptr) {
    Program program;
    const bool found = pocl_cache_->build(
        key, [&] { program.handle = build_from_source(target_, file, source, options); });
    ++(found ? from_cache_ : built_);
    return program;
  }
  if (cache_) {
    if (Program program = load(key, options); program.handle) {
      ++from_cache_;
      return program;
    }
  }
  Program program{build_from_source(target_, file, source, options), {}};
  ++built_;
  if (cache_) {
    auto binary = program_binary(program.handle.get());
    auto arguments = argument_names(program.handle.get());
    if (binary && arguments) {
      const nlohmann::json::binary_t bytes({binary->begin(), binary->end()});
      const auto text = nlohmann::json::to_cbor({{"arguments", *arguments}, {"binary", bytes}});
      cache_->store(key, {reinterpret_cast<const char*>(text.data()), text.size()});
    }
  }
  return program;
}

Program ProgramLibrary::load(const CacheKey& key, const std::string& options) {
  const auto stored = cache_->load(key);
  if (!stored) return {};
  const auto program = nlohmann::json::from_cbor(*stored);
  const std::vector<std::uint8_t>& binary = program.at("binary").get_binary();
  if (auto handle = build_from_binary(target_, binary, options)) {
    return {std::move(handle), program.at("arguments").get<ArgumentNames>()};
  }
  warn("the device refuses '" + cache_->file(key).string() + "'; compiling again");
  return {};
}

}  // namespace photile::device
