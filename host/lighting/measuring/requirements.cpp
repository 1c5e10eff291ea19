#include "measuring/requirements.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::measuring {
namespace {

constexpr double two_errors = 2;
constexpr double uniformity_of_surfaces = 0.10;      // walls, ceilings, cylindrical, background
constexpr double uniformity_of_surroundings = 0.40;  // of the immediate ones
constexpr double background_share = 1.0 / 3;         // of the immediate surroundings' mean

/// The field that a word of a table or of user-defined requirements sets; null where there is none.
double* field_of(Requirement& requirement, std::string_view word) {
  using Field = std::pair<std::string_view, double*>;
  const std::array fields{
      Field{"Em", &requirement.mean},         Field{"Uo", &requirement.uniformity},
      Field{"Emin", &requirement.least},      Field{"Ud", &requirement.diversity},
      Field{"UGR", &requirement.glare},       Field{"Ra", &requirement.rendering},
      Field{"Ez", &requirement.cylindrical},  Field{"Ewall", &requirement.wall},
      Field{"Eceiling", &requirement.ceiling}};
  const auto found = std::ranges::find(fields, word, &Field::first);
  return found == fields.end() ? nullptr : found->second;
}

// Raw string literals: headings, then a row a line, areas of tables between them; an empty cell
// requires nothing. Their sources: docs/reference/targets.md. Tasks with a high risk that need over
// 150 lux need a tenth of it.
constexpr const char* tables =
#include "measuring/en12464_1.csv"
#include "measuring/en1838.csv"
    ;

std::vector<Requirement> read_rows() {
  std::vector<Requirement> rows;
  std::istringstream lines(tables);
  for (std::string heading, area, line, word, cell; std::getline(lines, line);) {
    const bool is_heading = line.starts_with("name;"), is_area = line.find(';') == line.npos;
    if (is_heading) heading = line;
    if (is_area) area = line;
    if (is_heading || is_area) continue;
    Requirement& row = rows.emplace_back();
    row.area = area;
    std::istringstream words(heading), cells(line);
    while (std::getline(words, word, ';') && std::getline(cells, cell, ';')) {
      if (word == "name") row.name = cell;
      if (word == "activity") row.what = cell;
      if (word == "table" || word == "clause") row.reference = cell;
      row.is_direct |= word == "clause";
      if (double* field = field_of(row, word)) *field = parse_number<double>(cell).value_or(0);
    }
    row.reference =
        fmt::format(fmt::runtime(row.is_direct ? "EN 1838:2013, {}, direct light alone"
                                               : "EN 12464-1:2021, table {}, required values{}"),
                    row.reference, cell == "confirmed" ? "" : " (not confirmed: check them)");
  }
  return rows;
}

/// "office-desk, reception-desk" for "desk": the names that hold a text, or that nearest to it.
std::string names_near(std::string_view text) {
  std::vector<std::string_view> all, near;
  for (const Requirement& row : known_requirements()) {
    all.push_back(row.name);
    if (row.name.find(text) != std::string::npos) near.push_back(row.name);
  }
  if (near.empty()) near = {text.find('=') < text.size() ? "office-desk" : nearest_word(text, all)};
  return fmt::format("{}", fmt::join(near, ", "));
}

void add(std::vector<Judgement>& all, const GridValues& values, const char* figure, double required,
         const Measured& measured) {
  if (required > 0) all.push_back({values.grid.name, figure, required, measured});
}

/// Of each grid the observer with the highest UGR of those to whom no other task is nearer; null
/// where there is none.
std::vector<const RatedObserver*> dazzled_most(const Measurement& measurement,
                                               std::span<const RatedObserver> observers) {
  std::vector<const RatedObserver*> most(measurement.size() + 1);  // the last is of no task
  for (const RatedObserver& observer : observers) {
    std::size_t nearest = measurement.size();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < measurement.size(); ++i) {
      if (measurement[i].grid.role != GridRole::task) continue;
      for (const Sensor& sensor : measurement[i].grid.sensors) {
        const double distance = glm::distance(sensor.position, observer.position);
        if (distance < least) least = distance, nearest = i;
      }
    }
    const RatedObserver*& found = most[nearest];
    if (!found || observer.ugr.value > found->ugr.value) found = &observer;
  }
  return most;
}

}  // namespace

std::span<const Requirement> known_requirements() {
  static const std::vector<Requirement> rows = read_rows();
  return rows;
}

Requirement parse_requirement(const std::string& text) {
  for (const Requirement& row : known_requirements()) {
    if (row.name == text) return row;
  }
  Requirement own{.name = text, .reference = "", .what = ""};
  const auto refuse = [&] {
    throw UsageError(
        fmt::format("target '{}': give values such as Em=500,Uo=0.6,UGR=19, or a name of "
                    "docs/reference/targets.md, such as {}",
                    text, names_near(text)));
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

bool are_direct(std::span<const SensorGrid> grids) {
  const auto direct = std::ranges::count_if(
      grids, [](const SensorGrid& grid) { return parse_requirement(grid.target).is_direct; });
  if (direct != 0 && direct != std::ssize(grids)) {
    throw UsageError(
        "targets of emergency lighting count direct light alone; measure their grids in a run "
        "without others");
  }
  return direct > 0;
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

std::vector<JudgedTarget> judge_targets(const Measurement& measurement,
                                        std::span<const RatedObserver> observers) {
  const std::vector<const RatedObserver*> most = dazzled_most(measurement, observers);
  std::vector<JudgedTarget> all;
  for (std::size_t i = 0; i < measurement.size(); ++i) {
    const SensorGrid& grid = measurement[i].grid;
    if (grid.target.empty()) continue;
    auto target =
        std::ranges::find(all, grid.target, [](const auto& one) { return one.requirement.name; });
    if (target == all.end()) target = all.insert(target, {parse_requirement(grid.target), {}});
    auto& [requirement, judgements] = *target;
    for (Judgement& one : judge(measurement[i], requirement)) judgements.push_back(std::move(one));
    if (most[i] && requirement.glare > 0) {
      std::string name = most[i]->name;  // "room 1: point 3"
      if (name.starts_with(grid.name + ": ")) name.erase(0, grid.name.size() + 2);
      judgements.push_back({grid.name, "UGR", requirement.glare, most[i]->ugr, true, name});
    }
  }
  return all;
}

std::vector<std::string> requirement_lines(std::span<const JudgedTarget> targets) {
  std::vector<std::string> lines;
  for (const auto& [requirement, judgements] : targets) {
    lines.push_back("target " + requirement.name);
    if (!requirement.reference.empty()) {
      lines.back() += fmt::format(" ({}: {})", requirement.reference, requirement.what);
    }
    for (const Judgement& judgement : judgements) lines.push_back("  " + judgement_text(judgement));
    const bool rated = std::ranges::count(judgements, "UGR", &Judgement::figure) > 0;
    if (requirement.glare > 0 && !rated) {
      lines.push_back(fmt::format("  UGR at most {:g}: see photile glare", requirement.glare));
    }
    if (requirement.rendering > 0) {
      lines.push_back(
          fmt::format("  Ra at least {:g}: see the lamps' data sheets", requirement.rendering));
    }
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
  const std::string& observer = judgement.observer;
  return fmt::format("{}{}{}: {} {}, {} {:g}: {}{}", judgement.grid, observer.empty() ? "" : ", ",
                     observer, judgement.figure, value, judgement.at_most ? "at most" : "at least",
                     judgement.required, judgement.met() ? "met" : "NOT MET",
                     judgement.doubtful() ? ", within two standard errors" : "");
}

}  // namespace photile::measuring
