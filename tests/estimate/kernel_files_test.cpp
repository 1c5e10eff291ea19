// Each kernel file compiles as it lies in kernels/, without photile: by a C compiler with OpenCL,
// for every specialisation that the host makes of it.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>

#include "estimate/query.hpp"
#include "estimate/specialisation.hpp"
#include "file_bytes.hpp"
#include "maps/map_page.hpp"
#include "maps/map_store.hpp"
#include "source_folder.hpp"
#include "temporary_folder.hpp"

namespace photile::test {
namespace {

constexpr SceneNeeds one_light{.light_count = 1};
constexpr SceneNeeds several_lights{.light_count = 5};
constexpr SceneNeeds many_lights{.light_count = 300};
constexpr SceneNeeds glossy{.glossy = true, .light_count = 5};
constexpr SceneNeeds glossy_many{.glossy = true, .normal_maps = true, .light_count = 300};
constexpr std::array all_needs{one_light, several_lights, many_lights, glossy, glossy_many};

std::filesystem::path kernel_root() { return std::filesystem::path(source_folder()) / "kernels"; }

/// What shuffles are: instructions of NVIDIA's processors, and functions of Intel's runtimes.
constexpr std::array shuffling_targets{
    "-target nvptx64-nvidia-nvcl ",
    "-cl-no-stdinc -include opencl-c.h -Dcl_intel_subgroups -Dcl_intel_required_subgroup_size "};

/// The compiler's call but for its output: `mode` says what it is to do.
std::string clang_command(const std::string& mode, const std::string& options,
                          const std::string& file, const char* target = "") {
  return fmt::format(
      "'{}' -x cl -cl-std=CL1.2 {}{} -Wall -Werror -Wno-unused-function -I '{}' -I '{}' {} '{}'",
      PHOTILE_CLANG, target, mode, kernel_root().string(),
      (std::filesystem::path(source_folder()) / "include").string(), options,
      (kernel_root() / file).string());
}

/// "" where the file compiles, else what the compiler says.
std::string errors_of(const std::string& file, const std::string& options,
                      const char* target = "") {
  const TemporaryFolder folder;
  const auto log = folder.path / "log";
  const std::string command = fmt::format(
      "{} 2> '{}'", clang_command("-fsyntax-only", options, file, target), log.string());
  if (std::system(command.c_str()) == 0) return {};
  return file + " " + options + ": " + bytes_of(log);
}

using estimate::Specialisation;

std::vector<EstimateTuning> all_tunings() {
  std::vector<EstimateTuning> tunings;
  for (const int width : estimate::vector_widths)
    tunings.push_back({.strategy = EstimateStrategy::select, .vector_width = width});
  for (const int width : estimate::lane_widths) {
    tunings.push_back({.strategy = EstimateStrategy::lanes, .vector_width = width});
  }
  for (const int width : {16, 32}) {
    tunings.push_back(
        {.strategy = EstimateStrategy::lanes, .vector_width = width, .shuffles = true});
  }
  return tunings;
}

/// The defines with the least and the most that a query may have of maps and areas, for each
/// kernel.
std::vector<device::Defines> with_queries(const device::Defines& defines) {
  std::vector<device::Defines> all;
  for (const bool clipped : {false, true}) {
    for (const DensityKernel kernel : all_density_kernels) {
      device::Defines one = defines;
      estimate::set_density_defines(one, clipped, kernel);
      if (clipped) one.set("NORMALS");
      all.push_back(one);
    }
  }
  return all;
}

/// What the host builds from each kernel file of its own: options, by file.
std::multimap<std::string, std::string> host_programs() {
  std::multimap<std::string, std::string> programs;
  for (const EstimateTuning& tuning : all_tunings()) {
    for (const SceneNeeds& needs : all_needs) {
      const Specialisation choice = estimate::specialise(tuning, needs, 50);
      for (const device::Defines& defines : with_queries(choice.defines())) {
        programs.emplace("estimate/estimate.cl", defines.options());
      }
      programs.emplace("estimate/nearest.cl", choice.defines().options());
    }
  }
  for (const DeviceType type : {DeviceType::cpu, DeviceType::gpu}) {
    DeviceInfo device;
    device.type = type;
    device.max_work_group_size = 1024;
    const device::Defines groups = maps::group_defines(device);
    programs.emplace("shared/scan.cl", groups.options());
    for (const SceneNeeds& needs : all_needs) {
      device::Defines entries = groups;
      maps::set_record_defines(entries, needs);
      programs.emplace("grid/build.cl", entries.options());
      programs.emplace("grid/build.cl", device::Defines(entries).set("PATCHES").options());
      estimate::LightSums(needs, 50).set_defines(entries);
      if (needs.many_lights()) programs.emplace("estimate/pack_estimates.cl", entries.options());
    }
  }
  return programs;
}

std::set<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::set<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
    found.insert((*match)[1]);
  }
  return found;
}

/// The symbols of kernels/shared/symbols.clh.
std::set<std::string> symbols() {
  return matches(bytes_of(kernel_root() / "shared/symbols.clh"),
                 std::regex("#ifndef ([A-Z0-9_]+)"));
}

}  // namespace

TEST_CASE("every kernel file compiles as it lies there") {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kernel_root())) {
    if (entry.path().extension() != ".cl") continue;
    ++files;
    CHECK(errors_of(std::filesystem::relative(entry.path(), kernel_root()).string(), "").empty());
  }
  CHECK(files > 10);
}

TEST_CASE("every specialisation that the host makes of a kernel compiles", "[slow]") {
  for (const auto& [file, options] : host_programs()) {
    const bool shuffles = options.find("SHUFFLES") != std::string::npos;
    for (const char* target : shuffling_targets) {
      const std::string errors = errors_of(file, options, shuffles ? target : "");
      INFO(errors);
      CHECK(errors.empty());
      if (!shuffles) break;
    }
  }
}

TEST_CASE("the host sets the symbols that kernels know, all of them and no others") {
  std::set<std::string> set_by_host;
  for (const auto& [file, options] : host_programs()) {
    set_by_host.merge(matches(options, std::regex("-D ([A-Z0-9_]+)=")));
  }
  CHECK(set_by_host == symbols());
}

TEST_CASE("kernels read nothing of lobes or lights that the scene does not have") {
  // With all of its functions inlined, a kernel names an argument that it does not use just once.
  const auto unread = [](const Specialisation& choice) {
    const TemporaryFolder folder;
    const auto code = folder.path / "kernel.ll";
    const std::string command = fmt::format(
        "{} -o '{}'",
        clang_command("-O3 -mllvm -inline-threshold=1000000 -S -emit-llvm -fno-discard-value-names "
                      "-target spir64",
                      choice.defines().options(), "estimate/estimate.cl"),
        code.string());
    REQUIRE(std::system(command.c_str()) == 0);
    const std::string text = bytes_of(code);
    const auto begin = text.find("@estimate_by_selection(");
    REQUIRE(begin != std::string::npos);
    const std::string body = text.substr(begin, text.find("\n}", begin) - begin);
    std::set<std::string> arguments;
    for (const char* argument : {"hit_lobes", "record_incoming", "radiance", "record_light",
                                 "slot_light", "slots_taken"}) {
      const std::regex use(fmt::format("%{}\\b", argument));
      const auto count = std::distance(std::sregex_iterator(body.begin(), body.end(), use),
                                       std::sregex_iterator());
      REQUIRE(count > 0);
      if (count == 1) arguments.insert(argument);
    }
    return arguments;
  };
  const std::set<std::string> of_gloss{"hit_lobes", "record_incoming", "radiance"};
  const std::set<std::string> of_slots{"slot_light", "slots_taken"};
  for (const bool lanes : {false, true}) {
    const EstimateTuning tuning{
        .strategy = lanes ? EstimateStrategy::lanes : EstimateStrategy::select,
        .vector_width = lanes ? 32 : 1};
    for (const SceneNeeds& needs : all_needs) {
      CAPTURE(lanes, needs.glossy, needs.light_count);
      std::set<std::string> expected;
      if (!needs.glossy) expected = of_gloss;
      if (!needs.several_lights()) expected.insert("record_light");
      if (!needs.many_lights()) expected.insert(of_slots.begin(), of_slots.end());
      CHECK(unread(estimate::specialise(tuning, needs, 50)) == expected);
    }
  }
}

}  // namespace photile::test
