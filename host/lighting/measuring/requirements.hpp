// What standards require of the light in a room, and whether a measurement has it.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "measuring/measurement.hpp"

namespace photile::measuring {

/// A row of EN 12464-1:2021 or EN 1838:2013, or one of the user's own. 0 = nothing is required.
struct Requirement {
  std::string name;        ///< "office-desk"
  std::string area = {};   ///< "Offices"
  std::string reference;   ///< "EN 12464-1:2021, table 34, required values"
  std::string what;        ///< "writing, typing, reading, data processing"
  double mean = 0;         ///< E_m, lux, maintained, on the task area
  double uniformity = 0;   ///< U_o there
  double glare = 0;        ///< R_UGL: the highest UGR
  double rendering = 0;    ///< R_a, which photile cannot measure
  double cylindrical = 0;  ///< E_m,z, lux
  double wall = 0;         ///< E_m,wall, lux
  double ceiling = 0;      ///< E_m,ceiling, lux
  double least = 0;        ///< E_min, lux: at each point of the task area
  double diversity = 0;    ///< U_d = E_min / E_max there
  /// Whether light that surfaces reflect does not count, as in emergencies.
  bool is_direct = false;
};

/// The rows that are known by name.
std::span<const Requirement> known_requirements();

/// "office-desk", or values of one's own: "Em=300,Uo=0.6,UGR=19", any of Em, Uo, Emin, Ud,
/// UGR, Ra, Ez, Ewall, Eceiling; "" requires nothing. Errors: UsageError that lists the names.
Requirement parse_requirement(const std::string& text);

/// Whether the targets of these grids count direct light alone. Errors: UsageError where only some
/// do.
bool are_direct(std::span<const SensorGrid> grids);

/// One figure of a grid beside what is required.
struct Judgement {
  std::string grid;
  std::string figure;  ///< "Em", "Uo", "Emin", "Ud", "UGR"
  double required = 0;
  Measured measured;
  bool at_most = false;       ///< whether the requirement is an upper limit
  std::string observer = {};  ///< of UGR, beside the grid; "" = the grid's own name says it
  /// Whether it is met. Within two standard errors of the limit it could be either.
  bool met() const;
  bool doubtful() const;
};

/// Judges the mean and, on tasks and their surroundings, the uniformity: walls, ceilings and
/// cylindrical illuminance have a uniformity of 0.10, the immediate surroundings 0.40 and the mean
/// of table 2 of the standard, the background a third of that and 0.10. Grids of another role are
/// not judged.
std::vector<Judgement> judge(const GridValues& values, const Requirement& requirement);

/// Who sees luminaires.
struct RatedObserver {
  std::string name;
  glm::dvec3 position{0.0};  ///< of the eyes, as those of sensors
  Measured ugr;
};

/// A requirement beside all that is judged by it.
struct JudgedTarget {
  Requirement requirement;
  std::vector<Judgement> judgements;
};

/// The targets of the grids, in the order of the first of each. A task that is nearer to some
/// observers than others are has the highest UGR of these.
std::vector<JudgedTarget> judge_targets(const Measurement& measurement,
                                        std::span<const RatedObserver> observers = {});

/// The judgements under a heading each, and what a program cannot judge.
std::vector<std::string> requirement_lines(std::span<const JudgedTarget> targets);

/// E_m of the immediate surroundings of a task: EN 12464-1:2021, table 2.
double mean_of_surroundings(double task_mean);

/// Below it a glare rating means nothing any more (CIE 117).
inline constexpr double least_glare = 10;
/// A glare rating as data sheets state it: "19.3" or "<10".
std::string glare_text(double rating, const char* format = "{:.1f}");

/// "office-desk: working plane: Em 512 lux, at least 500: met"
std::string judgement_text(const Judgement& judgement);

}  // namespace photile::measuring
