#include <fmt/format.h>

#include <algorithm>

#include "common/foreign_text.hpp"
#include "measuring/requirements.hpp"
#include "report/plan_surroundings.hpp"
#include "report/tables.hpp"

namespace photile::report {
namespace {

using Json = nlohmann::ordered_json;

std::string with_error(const std::optional<Measured>& measured, const char* format, int width) {
  if (!measured) return fmt::format("{:>{}}", "-", width);
  const std::string text =
      fmt::format(fmt::runtime(format), measured->value, measured->standard_error);
  return fmt::format("{:>{}}", text, width);
}

/// A rating of UGR with its error.
std::string rating_text(const std::optional<Measured>& measured, int width) {
  if (!measured) return with_error(measured, "", width);
  const std::string rating = measuring::glare_text(measured->value);
  if (!rating.starts_with('<')) return with_error(measured, "{:.1f} +-{:.1g}", width);
  return fmt::format("{:>{}}", rating, width);
}

std::string plain(const std::optional<double>& value, const char* format, int width) {
  if (!value) return fmt::format("{:>{}}", "-", width);
  return fmt::format("{:>{}}", fmt::format(fmt::runtime(format), *value), width);
}

/// "highest UGR: 19.3, eyes 4", or nothing.
template <class Value, class Text>
void add_highest(std::span<const glare::ObserverGlare> all, const char* what, const Text& text,
                 const Value& value, std::vector<std::string>& lines) {
  const glare::ObserverGlare* highest = nullptr;
  for (const glare::ObserverGlare& each : all) {
    if (value(each) && (!highest || *value(each) > *value(*highest))) highest = &each;
  }
  if (!highest) return;
  lines.push_back(
      fmt::format("highest {}: {}, {}", what, text(*value(*highest)), highest->observer.name));
}

std::optional<double> value_of(const std::optional<Measured>& measured) {
  return measured ? std::optional(measured->value) : std::nullopt;
}

std::string csv_number(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "";
}

std::string csv_measured(const std::optional<Measured>& measured) {
  return measured ? fmt::format("{:.6g},{:.3g}", measured->value, measured->standard_error) : ",";
}

Json measured_json(const std::optional<Measured>& measured) {
  return measured ? report::measured_json(*measured) : Json(nullptr);
}

Json number_json(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json luminaire_json(const glare::VisibleLuminaire& seen) {
  return {{"name", seen.name},
          {"direction", vector_json(seen.direction)},
          {"luminance", seen.luminance},
          {"solid_angle", seen.solid_angle},
          {"position_index", seen.position_index},
          {"projected_area", seen.projected_area},
          {"illuminance", seen.illuminance}};
}

Json picture_json(const glare::PictureGlare& picture) {
  const std::vector<glare::Source> sources = picture.plain_sources();
  Json json{
      {"illuminance", picture.illuminance},
      {"background_luminance", picture.background},
      {"dgp", glare::dgp(sources, picture.illuminance)},
      {"ugr", sources.empty() ? Json(nullptr) : Json(glare::ugr(sources, picture.background))},
      {"sources", Json::array()}};
  for (const glare::PictureSource& each : picture.sources) {
    json["sources"].push_back({{"direction_right_up_forward", vector_json(each.direction)},
                               {"luminance", each.source.luminance},
                               {"solid_angle", each.source.solid_angle},
                               {"position_index", each.source.position_index}});
  }
  return json;
}

}  // namespace

std::vector<std::string> glare_lines(std::span<const glare::ObserverGlare> all) {
  std::size_t width = 8;
  bool ggr = false, pictures = false;
  for (const glare::ObserverGlare& each : all) {
    width = std::max(width, each.observer.name.size());
    ggr = ggr || each.ggr;
    pictures = pictures || each.picture;
  }
  std::vector<std::string> lines{
      fmt::format("{:<{}} {:>16} {:>16} {:>13}{}{}", "observer", width, "Ev/lux", "Lb/(cd/m2)",
                  "UGR", ggr ? fmt::format(" {:>6}", "GGR") : "",
                  pictures ? fmt::format(" {:>15} {:>10} {:>6}", "DGP", "low light", "DGI") : "")};
  for (const glare::ObserverGlare& each : all) {
    std::string line =
        fmt::format("{:<{}} {} {} {}", each.observer.name, width,
                    with_error(each.illuminance, "{:.4g} +-{:.2g}", 16),
                    with_error(each.background, "{:.4g} +-{:.2g}", 16), rating_text(each.ugr, 13));
    if (ggr) line += fmt::format(" {:>6}", each.ggr ? measuring::glare_text(*each.ggr) : "-");
    if (pictures) {
      line += fmt::format(" {} {} {}", with_error(each.dgp, "{:.3f} +-{:.1g}", 15),
                          plain(value_of(each.dgp_low_light), "{:.3f}", 10),
                          plain(each.dgi, "{:.1f}", 6));
    }
    lines.push_back(std::move(line));
  }
  if (all.size() > 1) {
    add_highest(
        all, "UGR", [](double rating) { return measuring::glare_text(rating); },
        [](const auto& each) { return value_of(each.ugr); }, lines);
    add_highest(
        all, "DGP", [](double rating) { return fmt::format("{:.3f}", rating); },
        [](const auto& each) { return value_of(each.dgp); }, lines);
  }
  return lines;
}

std::string glare_csv(std::span<const glare::ObserverGlare> all, std::optional<double> ground) {
  std::string text =
      std::string(
          "observer,x,y,z,dx,dy,dz,illuminance,illuminance_error,background_luminance,"
          "background_error,ugr,ugr_error,ggr,dgp,dgp_error,dgp_low_light,dgi") +
      ground_heading(ground) + "\n";
  for (const glare::ObserverGlare& each : all) {
    const glm::dvec3 &p = each.observer.position, &d = each.observer.forward;
    text += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.6g},{:.6g},{:.6g},{},{},{},{},{},{},{}{}\n",
                        csv_field(each.observer.name), p.x, p.y, p.z, d.x, d.y, d.z,
                        csv_measured(each.illuminance), csv_measured(each.background),
                        csv_measured(each.ugr), csv_number(each.ggr), csv_measured(each.dgp),
                        csv_number(value_of(each.dgp_low_light)), csv_number(each.dgi),
                        ground_field(ground));
  }
  return text;
}

Json glare_json(std::span<const glare::ObserverGlare> all) {
  Json list = Json::array();
  for (const glare::ObserverGlare& each : all) {
    Json entry{{"name", each.observer.name},
               {"position", vector_json(each.observer.position)},
               {"direction", vector_json(each.observer.forward)},
               {"up", vector_json(each.observer.up)},
               {"illuminance", measured_json(each.illuminance)},
               {"background_luminance", measured_json(each.background)},
               {"ugr", measured_json(each.ugr)},
               {"ggr", number_json(each.ggr)},
               {"luminaires", Json::array()}};
    for (const glare::VisibleLuminaire& seen : each.luminaires) {
      entry["luminaires"].push_back(luminaire_json(seen));
    }
    if (each.picture) {
      entry["dgp"] = measured_json(each.dgp);
      entry["dgp_low_light"] = measured_json(each.dgp_low_light);
      entry["dgi"] = number_json(each.dgi);
      entry["picture"] = picture_json(*each.picture);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json glare_record(const Scene& scene, std::span<const glare::ObserverGlare> all,
                  const std::optional<measuring::PlaneLayout>& plane) {
  Json record = Json::object();
  if (plane) {
    record["plane"] = plane_json(*plane);
    record["plan"] = plan_json(RayScene(scene), *plane);
  }
  record["observers"] = glare_json(all);
  return record;
}

}  // namespace photile::report
