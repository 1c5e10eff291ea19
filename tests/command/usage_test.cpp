// What the command line takes and says. What it refuses is in tests/transcript.
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "box_scene.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "command/validators.hpp"
#include "photile/image.hpp"
#include "photile/renderer.hpp"
#include "report/tables.hpp"
#include "source_folder.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using namespace app;

TEST_CASE("columns are as wide as their widest text") {
  CHECK(report::aligned({{"", "first"}, {"a lamp of a long name", "2 lm"}, {"\u00e9", "10 lm"}}) ==
        std::vector<std::string>{"                       first", "a lamp of a long name   2 lm",
                                 "\u00e9                      10 lm"});
}

TEST_CASE("the version names photile and what it was built with") {
  const Outcome outcome = succeed({"--version"});
  CHECK_THAT(outcome.output, Contains("photile 1.") && Contains("Embree          3.") &&
                                 Contains("OpenEXR         3.") && Contains("TBB") &&
                                 Contains("OpenCL headers"));
}

TEST_CASE("the help of a command shows the settings of its usual quality") {
  const std::string command = GENERATE("render", "view");
  RenderParameters parameters;
  set_quality(parameters, Quality::good);
  const Outcome outcome = succeed({command, "--help"});
  const auto shows = [&](auto number) { return Contains("N=" + std::to_string(number)); };
  CHECK_THAT(outcome.output,
             shows(parameters.photons.emitted_photons) && shows(parameters.neighbours));
}

TEST_CASE("a full disk behind standard output is a failure") {
  const Run run{.arguments = {"--version"}, .standard_output = "/dev/full"};
  CHECK_THAT(only_error(run_photile(run), 1), Contains("standard output"));
}

// Every setting of the table is an option or reached by --set, in the records of a run, and in the
// documentation.

TEST_CASE("the documentation holds the tables of settings as the command prints them") {
  const Outcome tables = succeed({"settings", "--markdown"});
  const std::size_t blank = tables.output.find("\n\n");
  const std::string all = tables.output.substr(0, blank), qualities = tables.output.substr(blank);
  REQUIRE(std::count(all.begin(), all.end(), '\n') > 10);
  REQUIRE(std::count(qualities.begin(), qualities.end(), '\n') > 5);
  CHECK_THAT(bytes_of(source_folder() / "docs/reference/settings.md"), Contains(all));
  CHECK_THAT(bytes_of(source_folder() / "docs/reference/options.md"), Contains(qualities));
}

TEST_CASE("every setting is an option of render, or one that --set reaches") {
  const Outcome help = run_photile({"render", "--help"}), list = run_photile({"settings"});
  for (const Setting& setting : settings()) {
    CAPTURE(setting.name);
    if (setting.option.empty()) {
      CHECK_THAT(list.output, Contains("  " + std::string(setting.name) + " "));
    } else {
      CHECK_THAT(help.output, Contains(app::option_of(setting) + " "));
    }
  }
}

TEST_CASE("the help of render has at most 45 options") {
  std::istringstream help(run_photile({"render", "--help"}).output);
  int options = 0;
  for (std::string line; std::getline(help, line);) options += line.starts_with("  -") ? 1 : 0;
  CHECK(options > 30);
  CHECK(options <= 45);
}

TEST_CASE("the memory of a device is set in GiB") {
  DeviceOptions options;
  assign_named(device_settings(options), "device_memory=1.5");
  CHECK(options.memory_bytes == std::uint64_t{3} << 29);
}

TEST_CASE("settings of scenes and devices are set by name, too") {
  const FileFolder folder;
  const std::string scene = write_box(folder);
  const auto radiance = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), {"render", scene, "--size", "8x6", "--photons", "5k", "--quality",
                               "draft", "-o", folder / name, "-q"});
    succeed(more);
    return *read_image(folder / name).find("R");
  };
  const auto usual = radiance("a.exr", {});
  const auto twice = radiance("b.exr", {"--set", "emissive_scale=2", "--set", "device_memory=1",
                                        "--set", "program_cache=off"});
  for (std::size_t i = 0; i < usual.size(); ++i) CHECK(twice[i] == Approx(2 * usual[i]));
}

TEST_CASE("a picture and its statistics tell every setting that it was made with") {
  const FileFolder folder;
  succeed(typed("render", write_box(folder), "-o", folder / "a.exr",
                "--size 16x12 --photons 5k --quality draft --set quota=equal",
                "--set photons_per_cell=0.1 --set passes=3 --stats", folder / "a.json"));
  const Image picture = read_image(folder / "a.exr");
  const auto recorded = folder.json("a.json")["parameters"];
  for (const Setting& setting : settings()) {
    const std::string name(setting.name);
    CAPTURE(name);
    CHECK(recorded.contains(name));
    CHECK(picture.attributes.count("photile." + name) == 1);
  }
  CHECK(picture.attributes.at("photile.quality") == "draft");
  CHECK(picture.attributes.at("photile.quota") == "equal");
  CHECK(picture.attributes.at("photile.photons_per_cell") == "0.1");
  CHECK(recorded["photons_emitted"] == 5000);
  CHECK(recorded["samples_per_pixel"] == 9);  // a multiple of the passes
  CHECK(recorded["passes"] == 3);
  CHECK(recorded["radius"] > 0);  // the one used
}

TEST_CASE("--quality sets settings that go together, and those given beside it count") {
  const FileFolder folder;
  const auto made_with = [&](const std::vector<std::string>& more) {
    succeed(typed("render", write_box(folder), "-o", folder / "a.exr",
                  "--size 8x6 --photons 5k --stats", folder / "a.json", more));
    const auto record = folder.json("a.json");
    CHECK(record["asked"]["quality"] == (more.front() == "--quality" ? more[1] : "good"));
    return record["parameters"];
  };
  const nlohmann::json draft = made_with({"--quality", "draft"});
  // Photons come before the quality on the line, samples after it.
  const nlohmann::json good = made_with({"--quality", "good", "--samples", "2"});
  CHECK(good["photons_emitted"] == 5000);
  CHECK(good["samples_per_pixel"] == 2);
  CHECK(good["light_maps"] == "on");
  CHECK(good == made_with({"--samples", "2"}));  // the usual quality
  CHECK(draft["light_map_rays"] > 0);
  CHECK(good["light_map_rays"] > draft["light_map_rays"]);
}

TEST_CASE("nodes gather in pictures unless another method is asked for") {
  const FileFolder folder;
  const auto [option, value, gather] =
      GENERATE(table<std::string, std::string, bool>({{"--set", "direct_rays=1", false},
                                                      {"--set", "maps=naive", false},
                                                      {"--set", "light_maps=off", false},
                                                      {"--set", "passes=2", false}}));
  CAPTURE(option);
  succeed(typed("render", write_box(folder), "-o", folder / "a.exr",
                "--size 8x6 --photons 5k -k 50 --samples 2", option, value, "--stats",
                folder / "a.json"));
  const auto used = folder.json("a.json")["parameters"];
  CHECK((used["light_map_rays"] > 0) == gather);
}

// Counts and sizes as typed.

TEST_CASE("counts are read with exponents and suffixes, and of 64 bits every digit") {
  CHECK(parse_count("0") == 0u);
  CHECK(parse_count("500000") == 500'000u);
  CHECK(parse_count("1e6") == 1'000'000u);
  CHECK(parse_count("4M") == 4'000'000u);
  CHECK(parse_count("1.1M") == 1'100'000u);
  CHECK(parse_count("200k") == 200'000u);
  CHECK(parse_count("2G") == 2'000'000'000u);
  CHECK(parse_count("18446744073709551615") == std::numeric_limits<std::uint64_t>::max());
  CHECK(parse_count("9007199254740993") == 9'007'199'254'740'993u);
  const std::string text = GENERATE("", "k", "-1", "1.5", "1e-3", "1e-6", "5.0001", "nan", "inf",
                                    "1e30", "12x", " 12", "0x10", "1kk", "18446744073709551616");
  INFO(text);
  CHECK_FALSE(parse_count(text).has_value());
}

TEST_CASE("sizes are read as width x height") {
  CHECK(parse_size("640x480").value().width == 640);
  CHECK(parse_size("640x480").value().height == 480);
  const std::string text = GENERATE("", "x", "640", "640x", "x480", "6.4x3", "1x2x3", "640X480");
  INFO(text);
  CHECK_FALSE(parse_size(text).has_value());
}

TEST_CASE("shares are read as percentages and as numbers") {
  CHECK(*parse_share("2%") == Approx(0.02));
  CHECK(*parse_share("0.02") == Approx(0.02));
  CHECK(*parse_share("12.5%") == Approx(0.125));
  const std::string text = GENERATE("", "%", "0", "0%", "-1%", "nan", "inf%", "2 %", "2%%");
  INFO(text);
  CHECK_FALSE(parse_share(text).has_value());
}

TEST_CASE("times are read with their units") {
  CHECK(*parse_duration("33ms") == Approx(0.033));
  CHECK(*parse_duration("1.5s") == Approx(1.5));
  CHECK(*parse_duration("2min") == Approx(120));
  const std::string text = GENERATE("", "s", "33", "-1s", "0ms", "nan s", "1h", "1s1");
  INFO(text);
  CHECK_FALSE(parse_duration(text).has_value());
}

TEST_CASE("numbers are printed as people read them, at the borders between units") {
  CHECK(format_count(0) == "0");
  CHECK(format_count(999) == "999");
  CHECK(format_count(1000) == "1.0k");
  CHECK(format_count(999.4) == "999");
  CHECK(format_count(999.6) == "1.0k");
  CHECK(format_count(0.5) == "0.5");
  CHECK(format_count(999'960) == "1.0M");
  CHECK(format_count(1.94e6) == "1.9M");
  CHECK(format_count(2.5e9) == "2.5G");
  CHECK(format_bytes(0) == "0 B");
  CHECK(format_bytes(1023) == "1023 B");
  CHECK(format_bytes(1024) == "1.0 KiB");
  CHECK(format_bytes(3ull << 29) == "1.5 GiB");
  CHECK(format_seconds(0.123) == "0.12 s");
  CHECK(format_seconds(9.999) == "10.0 s");
  CHECK(format_seconds(59.99) == "1 min 00 s");
  CHECK(format_seconds(125) == "2 min 05 s");
  CHECK(format_seconds(3720) == "1 h 02 min");
  CHECK(format_seconds(std::numeric_limits<double>::infinity()) == "?");
}

TEST_CASE("numbers of five digits and more are grouped, not powers of ten") {
  CHECK(report::grouped(0.58571, 4) == "0.5857");
  CHECK(report::grouped(9999, 4) == "9999");
  CHECK(report::grouped(11'990, 4) == "11,990");
  CHECK(report::grouped(-702'234.4, 4) == "-702,234");
  CHECK(report::grouped(1'000'000, 4) == "1,000,000");
  CHECK(report::grouped(1e12, 4) == "1e+12");
  CHECK(report::grouped(-1234.5, 4) == "-1234");
  CHECK(format_power_in_lumens(683, PowerUnit::lumen, 683) == "683 lm");
  CHECK(format_power_in_lumens(2, PowerUnit::watt, 179) == "2 W (358 lm)");
}

}  // namespace
}  // namespace photile::test
