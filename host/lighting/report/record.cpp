#include "report/record.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/gtc/constants.hpp>
#include <tuple>

#include "common/ascii_text.hpp"
#include "photile/light_layers.hpp"
#include "report/plan_surroundings.hpp"
#include "report/tables.hpp"
#include "scene/surface_models.hpp"

namespace photile::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double degrees = glm::pi<double>() / 180;

/// cd per 1000 lm in a plane, at an angle from the aim that is negative on the plane's other side.
double intensity_at(const IntensityDistribution& lamp, double plane, double angle) {
  const double across = std::sin(angle);
  const glm::dvec3 direction(across * std::cos(plane), across * std::sin(plane), -std::cos(angle));
  return 1000 * lamp.intensity(direction) / lamp.flux();
}

/// lm of each of the scene's lights.
std::vector<double> lumens_of(const Scene& scene, const LightMix& mix) {
  // Radiant watts would be read as those of the mains.
  const LightGroups groups = light_groups_of(scene);
  std::vector<double> lumens = powers_of(scene, mix);
  for (std::size_t i = 0; i < lumens.size(); ++i) {
    if (mix.lights[groups.group_of[i]].unit == PowerUnit::watt) lumens[i] *= mix.lumen_per_watt;
  }
  return lumens;
}

/// Adds by what luminaires of one photometric file may differ.
void add_stated(const LuminaireData& data, Json& entry) {
  if (data.kelvin > 0) entry["kelvin"] = data.kelvin;
  if (data.maintenance > 0) entry["maintenance_factor"] = data.maintenance;
}

/// Adds what a report says of the scene beside what was measured: luminaires with their numbers on
/// plans, photometric files, reflectances of opaque materials that triangles have.
void add_scene(const Scene& scene, const LightMix& mix, Json& record) {
  const std::vector<double> lumens = lumens_of(scene, mix);
  Json lamps = Json::array(), files = Json::array(), surfaces = Json::array();
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const auto place = place_of(scene, light);
    const bool measured = light.distribution != none;
    lamps.push_back({{"number", i + 1},
                     {"name", light.name},
                     {"kind", kind_name(light)},
                     {"file", measured ? scene.distributions[light.distribution].name() : ""},
                     {"position", place ? vector_json(position_in_world(scene, *place)) : Json()},
                     {"lumens", lumens[i]}});
    if (measured) add_stated(scene.distributions[light.distribution].data(), lamps.back());
  }
  for (const Part& part : parts_of(scene, lumens)) {
    const auto planes = intensities_of(*part.lamp);
    files.push_back({{"name", part.lamp->name()},
                     {"pieces", part.count},
                     {"lumens", part.lumens},
                     {"watts", part.watts},
                     {"flux", part.lamp->flux()},
                     {"ra", part.lamp->data().rendering},
                     {"round", part.lamp->opening().shape != LuminousOpening::Shape::box},
                     {"data", data_rows(*part.lamp)},
                     {"intensities", {{"C0", planes[0]}, {"C90", planes[1]}}}});
    add_stated(part.lamp->data(), files.back());
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

Json target_json(const measuring::JudgedTarget& target) {
  const auto& [requirement, judgements] = target;
  Json json{{"name", requirement.name},    {"reference", requirement.reference},
            {"what", requirement.what},    {"ugr_limit", requirement.glare},
            {"ra", requirement.rendering}, {"judgements", Json::array()}};
  for (const measuring::Judgement& judgement : judgements) {
    json["judgements"].push_back({{"grid", judgement.grid},
                                  {"figure", judgement.figure},
                                  {"required", judgement.required},
                                  {"at_most", judgement.at_most},
                                  {"value", judgement.measured.value},
                                  {"standard_error", judgement.measured.standard_error},
                                  {"met", judgement.met()},
                                  {"doubtful", judgement.doubtful()}});
    if (!judgement.observer.empty()) json["judgements"].back()["observer"] = judgement.observer;
  }
  return json;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> data_rows(const IntensityDistribution& lamp) {
  const LuminaireData& data = lamp.data();
  std::vector<std::pair<std::string, std::string>> rows;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) rows.emplace_back(name, value);
  };
  add("maker", data.maker);
  add("article", data.article);
  add("luminaire", data.luminaire);
  add("lamps", data.source);
  if (data.watts > 0) {
    add("power",
        fmt::format("{} W, {:.0f} lm/W", number_text(data.watts, 4), lamp.flux() / data.watts));
  }
  if (data.kelvin > 0) {
    const bool tunable = data.highest_kelvin > data.kelvin;
    add("colour temperature",
        fmt::format("{:.0f}{} K", data.kelvin,
                    tunable ? fmt::format(" to {:.0f}", data.highest_kelvin) : ""));
  }
  if (data.rendering > 0) add("colour rendering", fmt::format("Ra {:.0f}", data.rendering));
  if (data.maintenance > 0) add("maintenance factor", fmt::format("{:g}", data.maintenance));
  return rows;
}

std::array<std::vector<double>, 2> intensities_of(const IntensityDistribution& lamp) {
  std::array<std::vector<double>, 2> planes;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (int angle = -180; angle <= 180; ++angle) {
      planes[i].push_back(
          intensity_at(lamp, static_cast<double>(i) * 90 * degrees, angle * degrees));
    }
  }
  return planes;
}

std::vector<Part> parts_of(const Scene& scene, const std::vector<double>& lumens) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::uint32_t distribution = scene.lights[i].distribution;
    if (distribution == none) continue;
    const IntensityDistribution* const lamp = &scene.distributions[distribution];
    const auto what = [](const IntensityDistribution& one) {
      return std::tuple(one.name(), one.data().kelvin, one.data().maintenance);
    };
    auto part = std::find_if(parts.begin(), parts.end(),
                             [&](const Part& each) { return what(*each.lamp) == what(*lamp); });
    if (part == parts.end()) part = parts.insert(part, Part{lamp});
    ++part->count;
    part->lumens += lumens[i];
    part->watts += lamp->electrical_watts(lumens[i]);
  }
  return parts;
}

std::string_view kind_name(const Light& light) {
  if (light.distribution != none) return "photometric";
  if (light.is_sky_patch()) return name_of(LightKind::environment);
  if (light.kind == LightKind::directional && light.has_size()) return "sun";
  return name_of(light.kind);
}

std::vector<double> powers_of(const Scene& scene, const LightMix& mix) {
  const LightGroups groups = light_groups_of(scene);
  std::vector<double> powers;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    powers.push_back(groups.fraction[i] * mix.lights[groups.group_of[i]].power);
  }
  return powers;
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

Json colours_json(const FalseColour& colours) {
  constexpr int last = 255;
  const Palette palette(colours.palette);
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

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))); }

Json run_json(const measuring::Measurement& measurement, const MeasureRun& run,
              const std::string& unit) {
  const MeasuringParameters& parameters = run.parameters;
  const bool planar = parameters.gathering.response == SensorResponse::planar;
  Json record{{"photile", run.version},
              {"scene", run.scene.source.filename().string()},
              {"date", today()},
              {"unit", unit},
              {"response", planar ? "planar" : "cylindrical"},
              {"maintenance_factor", parameters.maintenance},
              {"integrator", parameters.by_paths ? "path" : "photon-map"},
              {"seed", parameters.photons.seed},
              {"repeats", parameters.repeats},
              {"rays", parameters.gathering.rays}};
  if (!parameters.by_paths) {
    record["photons"] = parameters.photons.photons.emitted_photons;
    record["neighbours"] = parameters.photons.neighbours;
  }
  if (!run.mood.empty()) record["mood"] = run.mood;
  if (run.ground) record["ground_reflectance"] = *run.ground;
  for (const auto& [name, value] : run.sky) record["sky"][name] = value;
  if (!run.warnings.empty()) record["warnings"] = run.warnings;
  record["lumen_per_watt"] = run.mix.lumen_per_watt;
  for (const MixedLight& light : run.mix.lights) {
    record["lights"].push_back(
        {{"name", light.name}, {"power", light.power}, {"unit", symbol_of(light.unit)}});
  }
  if (!run.glare.is_null()) record["glare"] = run.glare;
  for (const auto& target : run.targets) record["targets"].push_back(target_json(target));
  if (const auto& room = run.room) {
    for (const char* key : {"area", "sides", "height"}) record["room"][key] = room->facts[key];
  }
  add_scene(run.scene, run.mix, record);
  record["grids"] = measurement_json(measurement);
  const RayScene rays(run.scene);
  for (std::size_t i = 0; i < measurement.size(); ++i) {
    const auto& layout = measurement[i].grid.layout;
    if (layout) record["grids"][i]["plan"] = plan_json(rays, *layout, run.north);
  }
  return record;
}

}  // namespace photile::report
