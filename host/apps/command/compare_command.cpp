#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "command/command_line.hpp"
#include "command/option_group.hpp"
#include "command/output_files.hpp"
#include "command/processes.hpp"
#include "command/scene_options.hpp"
#include "command/setting_options.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "report/picture_comparison.hpp"
#include "report/tables.hpp"

namespace photile::app {
namespace {

struct CompareOptions {
  std::string first, second;       ///< the second may be "" where moods are compared
  std::vector<std::string> moods;  ///< of the first picture, or none
  std::string moods_file;          ///< "" = beside its scene or itself
  std::string picture;             ///< file, "" = none
  std::string json;                ///< file, "" = none
  double scale = 0;                ///< 0 = automatic
  PictureOptions display;          ///< one white: that of the first, where its lights are known
};

/// After the name of what is compared.
std::vector<std::string> words_of(const PictureError& error) {
  const auto& area = error.worst_area;
  return {
      "",
      fmt::format("{:.3g}%", 100 * error.relative_error()),
      fmt::format("{:.4f}", error.mean_ratio),
      std::isinf(error.psnr) ? "equal" : fmt::format("{:.1f} dB", error.psnr),
      fmt::format("{:.2f}%", 100 * error.worst_region),
      area.width > 0 ? fmt::format("{}x{} at {},{}", area.width, area.height, area.x, area.y) : ""};
}

void print_missing(const report::PictureComparison& comparison) {
  for (const auto& light : comparison.only_a) std::cout << light << ": only in the first\n";
  for (const auto& light : comparison.only_b) std::cout << light << ": only in the second\n";
}

void print(const report::PictureComparison& comparison) {
  std::vector<std::vector<std::string>> rows{{"", "error", "mean", "PSNR", "worst"}};
  for (const auto& part : comparison.parts) {
    rows.push_back(part.error
                       ? words_of(*part.error)
                       : std::vector<std::string>{"", "-", "-", "-", "-", "the second is black"});
    rows.back()[0] = part.light.empty() ? "picture" : part.light;
  }
  for (const std::string& line : report::aligned(rows)) std::cout << line << '\n';
  print_missing(comparison);
}

nlohmann::ordered_json part_json(const report::ComparedPart& part) {
  nlohmann::ordered_json entry{{"light", part.light}};
  if (!part.error) return entry;
  const PictureError& error = *part.error;
  entry["relative_mse"] = error.relative_mse;
  entry["relative_error"] = error.relative_error();
  entry["mean_ratio"] = error.mean_ratio;
  entry["psnr"] = error.psnr;  // null where the pictures are equal
  entry["worst_region"] = error.worst_region;
  const auto& area = error.worst_area;
  if (area.width > 0) entry["worst_area"] = {area.x, area.y, area.width, area.height};
  return entry;
}

nlohmann::ordered_json record_of(const CompareOptions& options,
                                 const report::PictureComparison& comparison) {
  nlohmann::ordered_json record{
      {"first", std::filesystem::path(options.first).filename().string()},
      {"second", std::filesystem::path(options.second).filename().string()}};
  record["picture"] = part_json(comparison.parts.front());
  record["picture"].erase("light");
  record["layers"] = nlohmann::ordered_json::array();
  for (std::size_t i = 1; i < comparison.parts.size(); ++i) {
    record["layers"].push_back(part_json(comparison.parts[i]));
  }
  record["only_in_first"] = comparison.only_a;
  record["only_in_second"] = comparison.only_b;
  return record;
}

/// A picture that is compared, under the name that tables give it.
struct Compared {
  std::string name;
  std::unique_ptr<LayeredPicture> layers;  ///< null where it has no layers of lights
  Image whole;
};

Compared in_mood(const CompareOptions& options, const std::string& mood) {
  Compared compared{
      mood,
      relit_picture(options.first, mood_of_picture({mood, options.moods_file}, options.first)),
      {}};
  compared.whole = to_image(*compared.layers);
  return compared;
}

/// Errors: InputError for pictures without colours, and for pixels that are infinite or no numbers:
/// no error of them can be computed.
void check_pixels(const std::string& file, const Image& picture) {
  for (const char* channel : {"R", "G", "B"}) {
    if (picture.find(channel)) continue;
    throw InputError(fmt::format(
        "{}: there is no channel {}; give a picture with channels R, G and B", file, channel));
  }
  std::size_t lost = 0;
  for (const std::vector<float>& plane : picture.channels) {
    lost += static_cast<std::size_t>(std::count_if(
        plane.begin(), plane.end(), [](float value) { return !std::isfinite(value); }));
  }
  if (lost == 0) return;
  throw InputError(fmt::format(
      "{}: {} of its values are infinite or not numbers; give a picture without them", file, lost));
}

Compared from_file(const std::string& file) {
  Compared compared{std::filesystem::path(file).filename().string(), nullptr, read_image(file)};
  check_pixels(file, compared.whole);
  try {
    compared.layers = relit_picture(file, {});
  } catch (const InputError&) {  // no lights: compared as a whole
  }
  return compared;
}

/// cd/m2 of the values (1, 1, 1); 0 where the picture does not state it.
double white_luminance(const Image& picture) {
  const auto white = picture.numbers.find("whiteLuminance");
  return white == picture.numbers.end() || !(white->second > 0) ? 0 : double{white->second};
}

/// Brings the colours of `second` into the unit of the first, where both say what theirs is.
void unify_units(const Image& first, Image& second) {
  const double scale = white_luminance(second) / white_luminance(first);
  if (!(scale > 0) || !std::isfinite(scale) || scale == 1.0) return;
  for (std::size_t i = 0; i < second.channels.size(); ++i) {
    const std::string& name = second.channel_names[i];
    if (name.empty() || std::string_view("RGB").find(name.back()) == std::string_view::npos)
      continue;
    for (float& value : second.channels[i]) value = static_cast<float>(value * scale);
  }
}

std::string ratio_text(double a, double b) {
  return b > 0 ? fmt::format("{:.3g}", a / b) : a > 0 ? "-" : "1";
}

void print(const report::LevelComparison& comparison, const std::string& a, const std::string& b) {
  std::vector<std::vector<std::string>> rows{{"", a, b, "ratio"}};
  for (const auto& level : comparison.levels) {
    rows.push_back({level.what, fmt::format("{:.4g} {}", level.a, level.unit),
                    fmt::format("{:.4g} {}", level.b, level.unit), ratio_text(level.a, level.b)});
  }
  for (const auto& power : comparison.powers) {
    rows.push_back({power.light, format_power(power.a, power.unit),
                    format_power(power.b, power.unit), ratio_text(power.a, power.b)});
  }
  for (const std::string& line : report::aligned(rows)) std::cout << line << '\n';
}

nlohmann::ordered_json levels_json(const report::LevelComparison& comparison) {
  nlohmann::ordered_json json{{"levels", nlohmann::ordered_json::array()},
                              {"powers", nlohmann::ordered_json::array()}};
  for (const auto& level : comparison.levels) {
    json["levels"].push_back(
        {{"what", level.what}, {"unit", level.unit}, {"first", level.a}, {"second", level.b}});
  }
  for (const auto& power : comparison.powers) {
    json["powers"].push_back({{"light", power.light},
                              {"unit", symbol_of(power.unit)},
                              {"first", power.a},
                              {"second", power.b}});
  }
  return json;
}

void check_moods(const CompareOptions& options) {
  if (options.moods.empty()) {
    if (options.second.empty()) {
      throw UsageError("nothing to compare with; give a second picture, or --mood twice");
    }
    return;
  }
  if (options.moods.size() != 2 || !options.second.empty()) {
    throw UsageError("two moods are compared: give one picture, and --mood twice");
  }
}

void write_record(const CompareOptions& options, const nlohmann::ordered_json& record) {
  if (options.json.empty()) return;
  write_file(options.json, json_text(record, 2));
}

void run_compare(const CompareOptions& options) {
  handle_signals();
  check_moods(options);
  std::vector<std::filesystem::path> outputs;
  if (!options.picture.empty()) outputs.emplace_back(options.picture);
  if (!options.json.empty()) outputs.emplace_back(options.json);
  note_input(options.first);
  if (!options.second.empty()) note_input(options.second);
  check_outputs(outputs);

  const bool moods = !options.moods.empty();
  const Compared first = moods ? in_mood(options, options.moods[0]) : from_file(options.first);
  Compared second = moods ? in_mood(options, options.moods[1]) : from_file(options.second);
  unify_units(first.whole, second.whole);
  throw_if_stop_requested();
  if (!options.picture.empty()) {
    const auto unit = first.whole.attributes.find("photile.units");
    write_png(options.picture,
              report::draw_comparison(
                  first.whole, second.whole,
                  {first.name, second.name,
                   unit == first.whole.attributes.end() ? "luminance" : unit->second, options.scale,
                   first.layers ? shown_as(options.display, *first.layers)
                                : shown_as(options.display, first.whole)}));
  }
  if (moods) {
    const report::LevelComparison levels =
        report::compare_levels(*first.layers, *second.layers, first.whole, second.whole);
    nlohmann::ordered_json record{{"first", first.name}, {"second", second.name}};
    record.update(levels_json(levels));
    write_record(options, record);
    print(levels, first.name, second.name);
    return;
  }
  const report::PictureComparison comparison = report::compare_pictures(first.whole, second.whole);
  nlohmann::ordered_json record = record_of(options, comparison);
  if (first.layers && second.layers && report::lights_differ(first.whole, second.whole)) {
    const report::LevelComparison levels =
        report::compare_levels(*first.layers, *second.layers, first.whole, second.whole);
    record.update(levels_json(levels));
    print(levels, first.name, second.name);
    print_missing(comparison);
  } else {
    print(comparison);
  }
  write_record(options, record);
}

}  // namespace

void add_compare_command(CLI::App& photile) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = photile.add_subcommand(
      "compare", "Compare two pictures layer by layer, or two moods of one picture");
  command->add_option("FIRST", options->first, "picture")->required()->type_name("");
  command->add_option("SECOND", options->second, "picture that the first is compared with")
      ->type_name("");
  const OptionGroup group(*command);
  group.repeat("--mood", options->moods, "NAME",
               "mood saved on the live page; give two to compare the first picture in both");
  add_moods_file_option(group, options->moods_file);
  group.add("-o,--output", options->picture, "FILE.png",
            "both pictures and their difference in false colour", file_ending_in({".png"}));
  group.add("--json", options->json, "FILE", "write the errors as JSON");
  group.add("-s,--scale", options->scale, "X",
            "largest difference on the legend; default: from the pictures", positive_number());
  add_exposure_option(group, options->display.tone_mapping.exposure);
  add_white_option(group, options->display.white);
  add_set_option(*command, {{display_view_setting(options->display.tone_mapping)}});
  command->callback([options] { run_compare(*options); });
}

}  // namespace photile::app
