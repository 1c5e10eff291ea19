#include "measuring/requirements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::measuring {
namespace {

constexpr double two_errors = 2;
constexpr double uniformity_of_surfaces = 0.10;      // walls, ceilings, cylindrical, background
constexpr double uniformity_of_surroundings = 0.40;  // of the immediate ones
constexpr double background_share = 1.0 / 3;         // of the immediate surroundings' mean

constexpr bool unconfirmed = false;

/// Required values; the modified ones may be asked for by hand. Where they were confirmed:
/// docs/reference/targets.md.
const std::array<Requirement, 17> rows{{
    {"corridor", "table 9", "circulation areas and corridors", 100, 0.40, 28, 40, 50, 50, 30},
    {"stairs", "table 9", "stairs, escalators and travelators", 100, 0.40, 25, 40, 50, 50, 30},
    {"canteen", "table 10", "canteens and pantries", 200, 0.40, 22, 80, 75, 75, 50, unconfirmed},
    {"washroom", "table 10", "cloakrooms, washrooms and toilets", 200, 0.40, 25, 80, 75, 75, 50},
    {"store-room", "table 12", "store and stockrooms", 100, 0.40, 25, 80, 50, 50, 30, unconfirmed},
    {"office-filing", "table 34", "filing and copying", 300, 0.40, 19, 80, 100, 100, 75,
     unconfirmed},
    {"office-desk", "table 34", "writing, typing, reading and data processing", 500, 0.60, 19, 80,
     150, 150, 100},
    {"office-drawing", "table 34", "technical drawing", 750, 0.70, 16, 80, 150, 150, 100,
     unconfirmed},
    {"office-cad", "table 34", "CAD workstations", 500, 0.60, 19, 80, 150, 150, 100, unconfirmed},
    {"meeting-room", "table 34", "conference and meeting rooms", 500, 0.60, 19, 80, 150, 150, 100},
    {"conference-table", "table 34", "conference tables", 500, 0.60, 19, 80, 150, 150, 100},
    {"reception-desk", "table 34", "reception desks", 300, 0.60, 22, 80, 100, 100, 75, unconfirmed},
    {"archive", "table 34", "archives", 200, 0.40, 25, 80, 75, 75, 50, unconfirmed},
    {"classroom", "table 44", "classrooms, general activities", 500, 0.60, 19, 80, 150, 150, 100,
     unconfirmed},
    {"school-entrance", "table 44", "entrance halls of schools", 200, 0.40, 22, 80, 75, 75, 50},
    {"school-corridor", "table 44", "corridors of schools", 100, 0.40, 25, 80, 50, 50, 30},
    {"school-stairs", "table 44", "stairs of schools", 150, 0.40, 25, 80, 50, 50, 30},
}};

/// Emergency lighting. A tenth of what a task with a high risk needs is more than 15 lux where that
/// is above 150.
const std::array<Requirement, 3> emergency_rows{{
    {.name = "escape-route",
     .reference = "4.2",
     .what = "centre line of an escape route",
     .least = 1,
     .diversity = 1.0 / 40,
     .is_direct = true},
    {.name = "open-area",
     .reference = "4.3",
     .what = "open area, against panic",
     .least = 0.5,
     .diversity = 1.0 / 40,
     .is_direct = true},
    {.name = "high-risk-task",
     .reference = "4.4",
     .what = "task area with a high risk",
     .mean = 15,
     .uniformity = 0.1,
     .is_direct = true},
}};

const std::vector<Requirement>& all_rows() {
  static const std::vector<Requirement> all = [] {
    std::vector<Requirement> list(rows.begin(), rows.end());
    for (Requirement& row : list) {
      row.reference = "EN 12464-1:2021, " + row.reference + ", required values";
      if (!row.confirmed) row.reference += " (not confirmed: check them)";
    }
    for (Requirement row : emergency_rows) {
      row.reference = "EN 1838:2013, " + row.reference + ", direct light alone";
      list.push_back(std::move(row));
    }
    return list;
  }();
  return all;
}

std::string known_names() {
  std::string names;
  for (const Requirement& row : all_rows()) names += (names.empty() ? "" : ", ") + row.name;
  return names;
}

/// The field that a word of user-defined requirements sets; null where there is none.
double* field_of(Requirement& requirement, std::string_view word) {
  if (word == "Em") return &requirement.mean;
  if (word == "Uo") return &requirement.uniformity;
  if (word == "Emin") return &requirement.least;
  if (word == "Ud") return &requirement.diversity;
  if (word == "UGR") return &requirement.glare;
  if (word == "Ra") return &requirement.rendering;
  if (word == "Ez") return &requirement.cylindrical;
  if (word == "Ewall") return &requirement.wall;
  if (word == "Eceiling") return &requirement.ceiling;
  return nullptr;
}

void add(std::vector<Judgement>& all, const GridValues& values, const char* figure, double required,
         const Measured& measured) {
  if (required > 0) all.push_back({values.grid.name, figure, required, measured});
}

}  // namespace

std::span<const Requirement> known_requirements() { return all_rows(); }

Requirement parse_requirement(const std::string& text) {
  for (const Requirement& row : all_rows()) {
    if (row.name == text) return row;
  }
  Requirement own{.name = text, .reference = "", .what = ""};
  const auto refuse = [&] {
    throw UsageError(
        fmt::format("target '{}': give values such as Em=500,Uo=0.6,UGR=19, or one of {}", text,
                    known_names()));
  };
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), part.size() + 1));
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) refuse();
    double* field = field_of(own, part.substr(0, equals));
    const auto value = parse_number<double>(part.substr(equals + 1));
    if (!field || !value || !(*value > 0)) refuse();
    *field = *value;
  }
  return own;
}

bool Judgement::met() const {
  return at_most ? measured.value <= required : measured.value >= required;
}

bool Judgement::doubtful() const {
  return std::abs(measured.value - required) <= two_errors * measured.standard_error;
}

double mean_of_surroundings(double task_mean) {
  if (task_mean >= 750) return 500;
  if (task_mean >= 500) return 300;
  if (task_mean >= 300) return 200;
  return std::min(task_mean, 150.0);
}

std::vector<Judgement> judge(const GridValues& values, const Requirement& requirement) {
  std::vector<Judgement> all;
  const GridStatistics& figures = values.total().statistics;
  const auto surface = [&](double mean) {
    if (!(mean > 0)) return;
    add(all, values, "Em", mean, figures.mean);
    add(all, values, "Uo", uniformity_of_surfaces, figures.uniformity);
  };
  switch (values.grid.role) {
    case GridRole::task:
      add(all, values, "Em", requirement.mean, figures.mean);
      add(all, values, "Uo", requirement.uniformity, figures.uniformity);
      add(all, values, "Emin", requirement.least, figures.minimum);
      add(all, values, "Ud", requirement.diversity, figures.diversity);
      break;
    case GridRole::surroundings:
      if (!(requirement.mean > 0)) break;
      add(all, values, "Em", mean_of_surroundings(requirement.mean), figures.mean);
      add(all, values, "Uo", uniformity_of_surroundings, figures.uniformity);
      break;
    case GridRole::background:
      surface(mean_of_surroundings(requirement.mean) * background_share);
      break;
    case GridRole::wall:
      surface(requirement.wall);
      break;
    case GridRole::ceiling:
      surface(requirement.ceiling);
      break;
    case GridRole::cylindrical:
      surface(requirement.cylindrical);
      break;
    case GridRole::other:
      break;
  }
  return all;
}

std::vector<std::string> requirement_lines(const Measurement& measurement,
                                           const Requirement& requirement,
                                           const std::optional<Judgement>& glare) {
  std::vector<std::string> lines{"target " + requirement.name};
  if (!requirement.reference.empty()) {
    lines.front() += fmt::format(" ({}: {})", requirement.reference, requirement.what);
  }
  for (const GridValues& values : measurement) {
    for (const Judgement& judgement : judge(values, requirement)) {
      lines.push_back("  " + judgement_text(judgement));
    }
  }
  if (glare) {
    lines.push_back("  " + judgement_text(*glare));
  } else if (requirement.glare > 0) {
    lines.push_back(fmt::format("  UGR at most {:g}: see photile glare", requirement.glare));
  }
  if (requirement.rendering > 0) {
    lines.push_back(
        fmt::format("  Ra at least {:g}: see the lamps' data sheets", requirement.rendering));
  }
  return lines;
}

std::string glare_text(double rating, const char* format) {
  return rating < least_glare ? fmt::format("<{:g}", least_glare)
                              : fmt::format(fmt::runtime(format), rating);
}

std::string judgement_text(const Judgement& judgement) {
  const double measured = judgement.measured.value;
  const bool rating = judgement.figure == "UGR" && judgement.required >= least_glare;
  const bool ratio = judgement.figure == "Uo" || judgement.figure == "Ud";
  const std::string value = ratio    ? fmt::format("{:.3f}", measured)
                            : rating ? glare_text(measured, "{:.4g}")
                                     : fmt::format("{:.4g}", measured);
  return fmt::format("{}: {} {}, {} {:g}: {}{}", judgement.grid, judgement.figure, value,
                     judgement.at_most ? "at most" : "at least", judgement.required,
                     judgement.met() ? "met" : "NOT MET",
                     judgement.doubtful() ? ", within two standard errors" : "");
}

}  // namespace photile::measuring
