// What `photile validate` tells, as a table and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "validation/validate.hpp"

namespace photile::app {

/// A line per reading: expected, then value, error, noise and verdict of each method.
std::vector<std::string> validation_table(std::span<const validation::ValidationRow> rows);

/// The content of --json FILE.
nlohmann::json validation_json(std::span<const validation::ValidationRow> rows,
                               const validation::ValidationParameters& parameters,
                               std::span<const Device> devices, double seconds);

/// Readings of which some method misses the tolerance, or is too noisy to tell.
std::size_t rows_not_within(std::span<const validation::ValidationRow> rows);

}  // namespace photile::app
