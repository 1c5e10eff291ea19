#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/output_file.hpp"
#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/output_files.hpp"
#include "tools/command/signals.hpp"
#include "tools/command/tone_mapping_options.hpp"
#include "tools/command/validators.hpp"
#include "tools/report/picture_comparison.hpp"

namespace photile::app {
namespace {

struct CompareOptions {
  std::string first, second;
  std::string picture;  ///< file, "" = none
  std::string json;     ///< file, "" = none
  double scale = 0;     ///< 0 = automatic
  ToneMapping tone_mapping;
};

std::string words_of(const PictureError& error) {
  const std::string psnr = std::isinf(error.psnr) ? "equal" : fmt::format("{:.1f} dB", error.psnr);
  std::string line = fmt::format("{:>10.3g}%{:>10.4f}{:>11}{:>9.2f}%", 100 * error.relative_error(),
                                 error.mean_ratio, psnr, 100 * error.worst_region);
  const auto& place = error.worst_place;
  if (place.width > 0) {
    line += fmt::format("  {}x{} at {},{}", place.width, place.height, place.x, place.y);
  }
  return line;
}

void print(const image::PictureComparison& comparison) {
  std::cout << fmt::format("{:<24}{:>11}{:>10}{:>11}{:>10}\n", "", "error", "mean", "PSNR",
                           "worst");
  for (const auto& part : comparison.parts) {
    std::cout << fmt::format("{:<24}{}\n", part.light.empty() ? "picture" : part.light,
                             part.error ? words_of(*part.error) : "  the second is black");
  }
  for (const auto& light : comparison.only_a) std::cout << light << ": only in the first\n";
  for (const auto& light : comparison.only_b) std::cout << light << ": only in the second\n";
}

nlohmann::ordered_json part_json(const image::ComparedPart& part) {
  nlohmann::ordered_json entry{{"light", part.light}};
  if (!part.error) return entry;
  const PictureError& error = *part.error;
  entry["relative_mse"] = error.relative_mse;
  entry["relative_error"] = error.relative_error();
  entry["mean_ratio"] = error.mean_ratio;
  entry["psnr"] = error.psnr;  // null where the pictures are equal
  entry["worst_region"] = error.worst_region;
  const auto& place = error.worst_place;
  if (place.width > 0) entry["worst_place"] = {place.x, place.y, place.width, place.height};
  return entry;
}

nlohmann::ordered_json record_of(const CompareOptions& options,
                                 const image::PictureComparison& comparison) {
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

void run_compare(const CompareOptions& options) {
  handle_signals();
  std::vector<std::filesystem::path> outputs;
  if (!options.picture.empty()) outputs.emplace_back(options.picture);
  if (!options.json.empty()) outputs.emplace_back(options.json);
  note_input(options.first);
  note_input(options.second);
  check_outputs(outputs);

  const Image first = read_image(options.first), second = read_image(options.second);
  const image::PictureComparison comparison = image::compare_pictures(first, second);
  throw_if_stop_requested();
  if (!options.picture.empty()) {
    const auto unit = first.attributes.find("photile.units");
    write_png(options.picture,
              image::draw_comparison(first, second,
                                     {std::filesystem::path(options.first).filename().string(),
                                      std::filesystem::path(options.second).filename().string(),
                                      unit == first.attributes.end() ? "luminance" : unit->second,
                                      options.scale, options.tone_mapping}));
  }
  if (!options.json.empty()) {
    write_file(options.json,
               record_of(options, comparison)
                       .dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                   "\n");
  }
  print(comparison);
}

}  // namespace

void add_compare_command(CLI::App& photile) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = photile.add_subcommand(
      "compare", "Two pictures side by side: difference and error, layer by layer");
  command->add_option("FIRST", options->first, "picture")->required()->type_name("");
  command->add_option("SECOND", options->second, "picture that the first is compared with")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", options->picture, "both and their difference in false colour")
      ->type_name("FILE.png")
      ->check(file_ending_in({".png"}));
  command->add_option("--json", options->json, "write the errors as JSON")->type_name("FILE");
  command
      ->add_option("-s,--scale", options->scale,
                   "largest difference of the legend; default: from the pictures")
      ->type_name("X")
      ->transform(positive_number());
  add_tone_mapping_options(*command, options->tone_mapping, "Options");
  command->callback([options] { run_compare(*options); });
}

}  // namespace photile::app
