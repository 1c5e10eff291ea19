#include "command/report_contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include "command/output_files.hpp"
#include "command/terminal_progress.hpp"
#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "report/printing.hpp"
#include "view/moods.hpp"

namespace photile::app {
namespace {

/// The bytes of a PNG file, in base64.
std::string png_of(const Image& displayed) {
  const report::ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "picture.png";
  write_png(file, displayed);
  std::ifstream stream(file, std::ios::binary);
  return report::base64(std::string(std::istreambuf_iterator<char>(stream), {}));
}

bool knows_illuminance(const LayeredPicture& picture) {
  constexpr std::size_t with_illuminance = 4;  // beside R, G and B
  return picture.lights() > 0 && picture.channel_names(0).size() >= with_illuminance;
}

void add_pictures(const LayeredPicture& picture, const std::string& caption,
                  const ToneMapping& shown, const report::FalseColour& colours,
                  nlohmann::ordered_json& pictures) {
  const Image displayed = tone_map(picture.root(), shown);
  pictures.push_back({{"caption", caption}, {"png", png_of(displayed)}});
  if (!knows_illuminance(picture)) return;
  const std::vector<float> lux = report::illuminance_of(picture);
  pictures.push_back({{"caption", caption},
                      {"png", png_of(report::false_colour_picture(lux, displayed, colours))},
                      {"shows", "illuminance of the visible surfaces, lux"}});
}

}  // namespace

bool has_any(const std::vector<std::string>& files, std::initializer_list<const char*> endings) {
  return std::any_of(files.begin(), files.end(), [&](const std::string& file) {
    return std::any_of(endings.begin(), endings.end(),
                       [&](const char* ending) { return ends_in(file, ending); });
  });
}

void write_results(const std::vector<std::string>& files, const Results& results) {
  for (const std::string& file : files) {
    if (ends_in(file, ".csv")) write_file(file, results.csv());
    if (ends_in(file, ".json")) write_file(file, results.json());
  }
  if (drawn_files(files).empty()) return;
  draw_report(results.record(), results.report, files, results.plans);
}

std::size_t planes_of(const std::vector<measuring::SensorGrid>& grids) {
  return static_cast<std::size_t>(std::count_if(
      grids.begin(), grids.end(), [](const auto& grid) { return grid.layout.has_value(); }));
}

void note_plans(const std::vector<std::string>& files, std::size_t plans) {
  for (const std::string& file : files) {
    if (!is_plan(file)) continue;
    if (plans == 0) {
      throw UsageError(
          fmt::format("{}: points have no plan; give a plane, by --plane or --grid", file));
    }
    if (plans == 1) continue;
    for (const auto& name : plan_names(file, plans)) note_output(name);
  }
}

std::filesystem::path moods_of_report(const std::string& given,
                                      const std::filesystem::path& scene) {
  if (!given.empty()) return given;
  const std::filesystem::path file = view::Moods::file_of(scene);
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

nlohmann::ordered_json report_pictures(const std::filesystem::path& picture,
                                       const std::filesystem::path& moods,
                                       const report::FalseColour& colours) {
  std::vector<std::pair<std::string, std::unique_ptr<LayeredPicture>>> states;
  states.emplace_back("as rendered", relit_picture(picture, {}));
  if (!moods.empty()) {
    const view::Moods kept(moods);
    const LightMix mix = read_light_mix(picture);
    for (const std::string& name : kept.names()) {
      states.emplace_back(name, relit_picture(picture, kept.changes(name, mix)));
    }
  }
  // One exposure, one white and one scale, so that moods can be compared.
  const Image first = states.front().second->root();
  const Image* const rendered = &first;
  const ToneMapping shown =
      with_one_exposure(shown_as({}, *states.front().second), std::span(&rendered, 1));
  report::FalseColour scaled = colours;
  if (!(scaled.scale > 0) && knows_illuminance(*states.front().second)) {
    for (const auto& [name, state] : states) {
      scaled.scale = std::max(scaled.scale, report::automatic_top(report::illuminance_of(*state)));
    }
    scaled.scale = report::rounded_top(scaled.scale, scaled.steps);
  }
  nlohmann::ordered_json pictures = nlohmann::ordered_json::array();
  for (const auto& [name, state] : states) add_pictures(*state, name, shown, scaled, pictures);
  return pictures;
}

}  // namespace photile::app
