// What the command line refuses before anything starts: exit code 2 and one line.
#include <catch2/catch.hpp>

#include "box_scene.hpp"
#include "child_process.hpp"
#include "file_folder.hpp"
#include "photile/renderer.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// `photile render` of a good scene with one more option.
Outcome render_with(const FileFolder& folder, const std::string& option, const std::string& value) {
  return run_photile({"render", write_box(folder), "-o", folder / "out.exr", option + "=" + value});
}

}  // namespace

TEST_CASE("an unknown option is a usage error of one line that names it") {
  const std::string line = only_error(run_photile({"render", "a.obj", "--fast"}), usage);
  CHECK_THAT(line, Contains("--fast") && Contains("photile render --help"));
}

TEST_CASE("an empty value is refused, and takes no other word in its place") {
  const FileFolder folder;
  const std::string scene = write_box(folder), notes = folder.write("notes.txt", "precious");
  for (const std::string option : {"--stats", "--save-maps", "--png", "--glare", "--errors"}) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{option + "=", notes}, std::vector<std::string>{option, ""}}) {
      std::vector<std::string> arguments{"render", scene, "-o", folder / "out.exr"};
      arguments.insert(arguments.end(), words.begin(), words.end());
      CHECK_THAT(only_error(run_photile(arguments), usage), Contains(option) && Contains("empty"));
    }
  }
  CHECK(folder.read("notes.txt") == "precious");
  CHECK_THAT(only_error(run_photile({"render", ""}), usage), Contains("empty"));
}

TEST_CASE("an unknown subcommand is a usage error of one line") {
  CHECK_THAT(only_error(run_photile({"paint"}), usage), Contains("photile --help"));
}

TEST_CASE("no subcommand is a usage error of one line") {
  only_error(run_photile(std::vector<std::string>{}), usage);
}

TEST_CASE("a scene is required") {
  CHECK_THAT(only_error(run_photile({"render", "-o", "a.exr"}), usage), Contains("SCENE"));
}

TEST_CASE("an output is required") {
  const FileFolder folder;
  const Outcome outcome = run_photile({"render", write_box(folder)});
  CHECK_THAT(only_error(outcome, usage), Contains("-o"));
}

TEST_CASE("values out of range are usage errors that name the option and the value") {
  const auto [option, value] = GENERATE(table<std::string, std::string>({
      {"--neighbours", "0"},
      {"--neighbours", "-3"},
      {"--neighbours", "2000000"},
      {"--neighbours", "many"},
      {"--set", "radius=0"},
      {"--set", "radius=-1"},
      {"--set", "radius=nan"},
      {"--set", "radius=inf"},
      {"--set", "radius=1e-60"},
      {"--photons", "0"},
      {"--photons", "1e11"},
      {"--photons", "1.5"},
      {"--samples", "0"},
      {"--samples", "70000"},
      {"--set", "angle_degrees=181"},
      {"--set", "angle_degrees=-1"},
      {"--set", "photons_per_cell=0"},
      {"--seed", "-1"},
      {"--seed", "1e30"},
      {"--size", "0x10"},
      {"--size", "10"},
      {"--size", "10x20x30"},
      {"--size", "100000x10"},
      {"--set", "maps=magic"},
      {"--set", "quota=magic"},
      {"--threads", "-1"},
      {"--threads", "1000000"},
      {"--exposure", "nan"},
      {"--set", "lumen_per_watt=0"},
      {"--set", "emissive_scale=-1"},
      {"--scale", "nan"},
      {"--scale", "0"},
      {"--scale", "24x24"},
  }));
  INFO(option << "=" << value);
  const FileFolder folder;
  const std::string line = only_error(render_with(folder, option, value), usage);
  CHECK_THAT(line, Contains(option) && Contains(value));
  CHECK(line.size() < 250);  // no range of 300 digits
  CHECK_FALSE(std::filesystem::exists(folder / "out.exr"));
}

TEST_CASE("arguments too many are told as they were given") {
  const std::string line =
      only_error(run_photile({"render", "a.obj", "--turn", "20", "--frames", "2"}), usage);
  CHECK_THAT(line, Contains("--turn 20 --frames 2"));
}

TEST_CASE("the endings that a file may have are told in one sentence") {
  const std::string line = only_error(run_photile({"walk", "a.obj", "-o", "frames"}), usage);
  CHECK_THAT(line, Contains("'frames' does not end in .exr or .png; rename it"));
}

TEST_CASE("a change of a light without a value is a usage error") {
  const FileFolder folder;
  const Outcome outcome = render_with(folder, "--light", "left");
  CHECK_THAT(only_error(outcome, usage), Contains("left"));
}

TEST_CASE("an unknown light is a usage error that lists the lights") {
  const FileFolder folder;
  const Outcome outcome = render_with(folder, "--light", "middle=x2");
  CHECK_THAT(last_error(outcome, usage),
             Contains("middle") && Contains("left") && Contains("right"));
}

TEST_CASE("a sky too dark for its radiance to be a number is refused") {
  const FileFolder folder;
  for (const std::string sky : {"clear=1e-50", "perez=1,1e-300"}) {
    const Outcome outcome =
        run_photile({"render", write_box(folder), "-o", folder / "out.exr", "--sky", sky, "--site",
                     "52,13,1", "--time", "2026-06-21T12:00", "--size", "8x8"});
    CHECK_THAT(last_error(outcome, usage), Contains("lux") && Contains("at least"));
  }
}

TEST_CASE("parallel rays that span more than scenes may hold are refused") {
  const FileFolder folder;
  const Outcome outcome =
      run_photile({"render", write_box(folder), "-o", folder / "out.exr", "--projection",
                   "orthographic", "--field-of-view", "1e19", "--size", "8x8"});
  CHECK_THAT(last_error(outcome, usage), Contains("--field-of-view"));
}

TEST_CASE("an unknown camera is a usage error that lists the cameras") {
  const FileFolder folder;
  const Outcome outcome = render_with(folder, "--camera", "nobody");
  CHECK_THAT(last_error(outcome, usage), Contains("nobody"));
}

TEST_CASE("the version names photile and what it was built with") {
  const Outcome outcome = run_photile({"--version"});
  CHECK(outcome.exit_code == 0);
  CHECK_THAT(outcome.output, Contains("photile 0.") && Contains("Embree          3.") &&
                                 Contains("OpenEXR         3.") && Contains("TBB") &&
                                 Contains("OpenCL headers"));
}

TEST_CASE("the help of a command shows the settings of its usual quality") {
  const auto [command, usual] = GENERATE(table<std::string, Quality>(
      {{"render", Quality::good}, {"view", Quality::good}, {"trade", Quality::draft}}));
  RenderParameters parameters;
  set_quality(parameters, usual);
  const Outcome outcome = run_photile({command, "--help"});
  CHECK(outcome.exit_code == 0);
  const auto shows = [&](auto number) { return Contains("N=" + std::to_string(number)); };
  CHECK_THAT(outcome.output,
             shows(parameters.photons.emitted_photons) && shows(parameters.neighbours));
}

TEST_CASE("a full disk behind standard output is a failure") {
  Run run;
  run.arguments = {"--version"};
  run.standard_output = "/dev/full";
  CHECK_THAT(only_error(run_photile(run), 1), Contains("standard output"));
}

}  // namespace photile::test
