#include "command/report_contents.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <utility>

#include "command/scene_report.hpp"
#include "command/terminal_progress.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/light_layers.hpp"
#include "report/false_colour.hpp"
#include "report/plan_lines.hpp"
#include "report/report.hpp"
#include "scene/surface_models.hpp"
#include "view/moods.hpp"

namespace photile::app {
namespace {

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

void add_pictures(const LayeredPicture& picture, const std::string& caption,
                  const report::FalseColour& colours,
                  std::vector<report::ReportPicture>& pictures) {
  const Image displayed = tone_map(picture.root(), {});
  pictures.push_back({caption, png_of(displayed)});
  constexpr std::size_t with_illuminance = 4;  // beside R, G and B
  if (picture.lights() == 0 || picture.channel_names(0).size() < with_illuminance) return;
  const std::vector<float> lux = report::illuminance_of(picture);
  pictures.push_back({caption + ": illuminance of the surfaces that are seen, lux",
                      png_of(report::false_colour_picture(lux, displayed, colours))});
}

}  // namespace

report::ReportTable lamp_schedule(const Scene& scene, const LightMix& mix) {
  report::ReportTable table{
      "Luminaires",
      {"number", "name", "kind", "photometric file", "position (x, y, z), m", "luminous flux"},
      {}};
  const std::vector<double> powers = powers_of(scene, mix);
  const LightGroups groups = light_groups_of(scene);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    // Radiant watts would be read as those of the mains.
    const bool watts = mix.lights[groups.group_of[i]].unit == PowerUnit::watt;
    const double lumens = (watts ? mix.lumen_per_watt : 1) * powers[i];
    table.rows.push_back(
        {std::to_string(i + 1), light.name, kind_name(light),
         light.distribution == none ? "" : scene.distributions[light.distribution].name(),
         place_text(scene, light), format_power(lumens, PowerUnit::lumen)});
  }
  return table;
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
  std::vector<report::ReportPicture> pictures;
  add_pictures(*relit_picture(picture, {}), "as rendered", colours, pictures);
  if (moods.empty()) return pictures;
  const view::Moods kept(moods);
  const LightMix mix = read_light_mix(picture);
  for (const std::string& name : kept.names()) {
    add_pictures(*relit_picture(picture, kept.changes(name, mix)), name, colours, pictures);
  }
  return pictures;
}

}  // namespace photile::app
