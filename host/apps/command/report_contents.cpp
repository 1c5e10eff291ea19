#include "command/report_contents.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

#include "command/output_files.hpp"
#include "command/scene_report.hpp"
#include "command/terminal_progress.hpp"
#include "common/ascii_text.hpp"
#include "common/files.hpp"
#include "photile/errors.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "report/false_colour.hpp"
#include "report/luminaires.hpp"
#include "report/plan_surroundings.hpp"
#include "report/printing.hpp"
#include "report/tables.hpp"
#include "scene/surface_models.hpp"
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

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))); }

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

std::vector<double> lumens_of(const Scene& scene, const LightMix& mix) {
  // Radiant watts would be read as those of the mains.
  const LightGroups groups = light_groups_of(scene);
  std::vector<double> lumens = powers_of(scene, mix);
  for (std::size_t i = 0; i < lumens.size(); ++i) {
    if (mix.lights[groups.group_of[i]].unit == PowerUnit::watt) lumens[i] *= mix.lumen_per_watt;
  }
  return lumens;
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

std::vector<double> watts_of(const Scene& scene, const LightMix& mix, double efficacy) {
  const LightGroups groups = light_groups_of(scene);
  const std::vector<double> lumens = lumens_of(scene, mix);
  std::vector<double> stated(mix.lights.size()), all(mix.lights.size());
  std::vector<bool> known(mix.lights.size(), true);
  for (std::size_t i = 0; i < lumens.size(); ++i) {
    const std::uint32_t group = groups.group_of[i], file = scene.lights[i].distribution;
    const IntensityDistribution* const lamp = file == none ? nullptr : &scene.distributions[file];
    all[group] += lumens[i];
    if (lamp != nullptr && lamp->data().watts > 0) {
      stated[group] += lamp->electrical_watts(lumens[i]);
    } else {
      known[group] = false;
    }
  }
  for (std::size_t group = 0; group < all.size(); ++group) {
    if (!known[group]) stated[group] = all[group] / efficacy;
  }
  return stated;
}

void add_scene(const Scene& scene, const LightMix& mix, nlohmann::ordered_json& record) {
  using Json = nlohmann::ordered_json;
  const std::vector<double> lumens = lumens_of(scene, mix);
  Json lamps = Json::array(), files = Json::array(), surfaces = Json::array();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const auto place = report::place_of(scene, light);
    const bool measured = light.distribution != none;
    lamps.push_back(
        {{"number", i + 1},
         {"name", light.name},
         {"kind", kind_name(light)},
         {"file", measured ? scene.distributions[light.distribution].name() : ""},
         {"position", place ? report::vector_json(position_in_world(scene, *place)) : Json()},
         {"lumens", lumens[i]}});
  }
  for (const report::Part& part : report::parts_of(scene, lumens)) {
    const auto planes = report::intensities_of(*part.lamp);
    files.push_back({{"name", part.lamp->name()},
                     {"pieces", part.count},
                     {"lumens", part.lumens},
                     {"watts", part.watts},
                     {"flux", part.lamp->flux()},
                     {"ra", part.lamp->data().rendering},
                     {"round", part.lamp->opening().shape != LuminousOpening::Shape::box},
                     {"data", report::data_rows(*part.lamp)},
                     {"intensities", {{"C0", planes[0]}, {"C90", planes[1]}}}});
  }
  std::vector<bool> used(scene.materials.size(), false);
  for (const std::uint32_t material : scene.triangle_material) used[material] = true;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (!used[i]) continue;
    const auto reflectance = scene::reflectance_of(scene, scene.materials[i]);
    if (!reflectance) continue;
    surfaces.push_back(
        {{"material", scene.materials[i].name}, {"reflectance", reflectance->whole}});
  }
  record["luminaires"] = std::move(lamps);
  record["photometry"] = std::move(files);
  record["reflectances"] = std::move(surfaces);
}

nlohmann::ordered_json colours_json(const report::FalseColour& colours) {
  constexpr int last = 255;
  const report::Palette palette(colours.palette);
  std::string all;
  for (int i = 0; i <= last; ++i) {
    if (i > 0) all += ' ';
    all += palette.hex(static_cast<double>(i) / last);
  }
  return {{"scale", colours.scale},
          {"steps", colours.steps},
          {"decades", colours.decades},
          {"label", colours.label},
          {"contours", name_in({"cells", "isolines", "bands", "steps"}, colours.contours)},
          {"palette", all}};
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
