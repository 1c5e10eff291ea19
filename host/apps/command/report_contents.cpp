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
#include "photile/ray_scene.hpp"
#include "report/false_colour.hpp"
#include "report/plan_lines.hpp"
#include "report/printing.hpp"
#include "report/tables.hpp"
#include "scene/surface_models.hpp"
#include "view/moods.hpp"

namespace photile::app {
namespace {

/// The file of each of several plans: numbered where they are more than one.
std::vector<std::filesystem::path> plan_names(const std::filesystem::path& file,
                                              std::size_t plans) {
  if (plans <= 1) return std::vector(plans, file);
  std::vector<std::filesystem::path> names;
  for (std::size_t i = 1; i <= plans; ++i) {
    names.push_back(file);
    names.back().replace_filename(fmt::format("{}-{}.svg", file.stem().string(), i));
  }
  return names;
}

std::string place_text(const Scene& scene, const Light& light) {
  const auto place = report::place_of(scene, light);
  if (!place) return "";
  const glm::dvec3 world = position_in_world(scene, *place);
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", world.x, world.y, world.z);
}

/// The bytes of a PNG file.
std::string png_of(const Image& displayed) {
  const report::ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "picture.png";
  write_png(file, displayed);
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool knows_illuminance(const LayeredPicture& picture) {
  constexpr std::size_t with_illuminance = 4;  // beside R, G and B
  return picture.lights() > 0 && picture.channel_names(0).size() >= with_illuminance;
}

void add_pictures(const LayeredPicture& picture, const std::string& caption,
                  const ToneMapping& shown, const report::FalseColour& colours,
                  std::vector<report::ReportPicture>& pictures) {
  const Image displayed = tone_map(picture.root(), shown);
  pictures.push_back({caption, png_of(displayed)});
  if (!knows_illuminance(picture)) return;
  const std::vector<float> lux = report::illuminance_of(picture);
  pictures.push_back({caption, png_of(report::false_colour_picture(lux, displayed, colours)),
                      "illuminance of the surfaces that are seen, lux"});
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
  std::vector<std::string> plans;
  if (has_any(files, {".svg"})) plans = results.plans();
  std::string page;
  if (has_any(files, {".html", ".pdf"})) page = results.page();
  for (const std::string& file : files) {
    if (ends_in(file, ".csv")) write_file(file, results.csv());
    if (ends_in(file, ".json")) write_file(file, results.json());
    if (ends_in(file, ".html")) write_file(file, page);
    if (ends_in(file, ".pdf")) write_file(file, report::pdf_of(page));
    if (!ends_in(file, ".svg")) continue;
    const auto names = plan_names(file, plans.size());
    for (std::size_t i = 0; i < names.size(); ++i) write_file(names[i], plans[i]);
  }
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
    if (!ends_in(file, ".svg")) continue;
    if (plans == 0) {
      throw UsageError(
          fmt::format("{}: points have no plan; give a plane, by --plane or --grid", file));
    }
    if (plans == 1) continue;
    for (const auto& name : plan_names(file, plans)) note_output(name);
  }
}

void add_surroundings(const Scene& scene, std::vector<report::ReportMap>& maps) {
  const RayScene rays(scene);
  for (report::ReportMap& map : maps) {
    map.surroundings = report::surroundings_of(rays, *map.values.grid.layout);
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

double least_rendering(const std::vector<report::Part>& parts) {
  if (parts.empty()) return 0;
  double least = 100;
  for (const report::Part& part : parts) least = std::min(least, part.lamp->data().rendering);
  return least;
}

report::ReportTable lamp_schedule(const Scene& scene, const LightMix& mix) {
  report::ReportTable table{
      "Luminaires",
      {"number", "name", "kind", "photometric file", "position (x, y, z), m", "luminous flux"},
      {}};
  const std::vector<double> lumens = lumens_of(scene, mix);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    table.rows.push_back(
        {std::to_string(i + 1), light.name, kind_name(light),
         light.distribution == none ? "" : scene.distributions[light.distribution].name(),
         place_text(scene, light), format_power(lumens[i], PowerUnit::lumen)});
  }
  return table;
}

report::ReportTable list_of_parts(const std::vector<report::Part>& parts) {
  report::ReportTable table{
      "List of parts",
      {"pieces", "maker", "article", "luminaire", "luminous flux", "power", "luminous efficacy"},
      {}};
  const auto row = [&](std::vector<std::string> cells, double lumens, double watts) {
    const bool known = watts > 0;
    cells.push_back(report::grouped(lumens, 4) + " lm");
    cells.push_back(known ? report::grouped(watts, 4) + " W" : "");
    cells.push_back(known ? fmt::format("{:.0f} lm/W", lumens / watts) : "");
    table.rows.push_back(std::move(cells));
  };
  std::size_t count = 0;
  double lumens = 0, watts = 0;
  for (const report::Part& part : parts) {
    const LuminaireData& data = part.lamp->data();
    row({std::to_string(part.count), data.maker, data.article,
         data.luminaire.empty() ? part.lamp->name() : data.luminaire},
        part.lumens, part.watts);
    count += part.count;
    lumens += part.lumens;
    watts += part.watts;
  }
  const bool all_known = std::all_of(parts.begin(), parts.end(),
                                     [](const report::Part& part) { return part.watts > 0; });
  if (parts.size() > 1) {
    row({std::to_string(count), "together", "", ""}, lumens, all_known ? watts : 0);
  }
  return table;
}

std::vector<report::DataSheet> data_sheets(const std::vector<report::Part>& parts) {
  std::vector<report::DataSheet> sheets;
  for (const report::Part& part : parts) {
    report::DataSheet sheet{part.lamp->name(), report::data_rows(*part.lamp),
                            report::polar_curve_svg(*part.lamp)};
    sheet.rows.insert(sheet.rows.begin(),
                      {"luminous flux", report::grouped(part.lamp->flux(), 4) + " lm"});
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

std::vector<std::pair<std::string, std::string>> energy_of(const std::vector<report::Part>& parts,
                                                           double area, double mean,
                                                           double kilowatt_hours) {
  std::vector<std::pair<std::string, std::string>> rows;
  double watts = 0;
  const bool known = std::all_of(parts.begin(), parts.end(), [&](const report::Part& part) {
    watts += part.watts;
    return part.watts > 0;
  });
  if (known && watts > 0) {
    rows.emplace_back("installed power", report::grouped(watts, 4) + " W");
    if (area > 0) {
      rows.emplace_back(
          "power density",
          fmt::format(
              "{:.2f} W/m2{}", watts / area,
              mean > 0 ? fmt::format(", {:.2f} W/m2 / 100 lx", 100 * watts / area / mean) : ""));
    }
  }
  if (kilowatt_hours > 0 && area > 0) {
    rows.emplace_back("LENI (EN 15193)", fmt::format("{:.1f} kWh/(m2 a), {:.0f} kWh / a",
                                                     kilowatt_hours / area, kilowatt_hours));
  }
  return rows;
}

report::ReportTable reflectances(const Scene& scene) {
  report::ReportTable table{"Reflectances", {"material", "reflectance"}, {}};
  std::vector<bool> used(scene.materials.size(), false);
  for (const std::uint32_t material : scene.triangle_material) used[material] = true;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (!used[i]) continue;
    const auto reflectance = scene::reflectance_of(scene, scene.materials[i]);
    if (!reflectance) continue;
    table.rows.push_back(
        {scene.materials[i].name, fmt::format("{:.0f}%", 100 * reflectance->whole)});
  }
  return table;
}

std::filesystem::path moods_of_report(const std::string& given,
                                      const std::filesystem::path& scene) {
  if (!given.empty()) return given;
  const std::filesystem::path file = view::Moods::file_of(scene);
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

std::vector<report::ReportPicture> report_pictures(const std::filesystem::path& picture,
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
  std::vector<report::ReportPicture> pictures;
  for (const auto& [name, state] : states) add_pictures(*state, name, shown, scaled, pictures);
  return pictures;
}

}  // namespace photile::app
