// Light names that EXR layers and the command line can hold.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "photile/scene.hpp"

namespace photile::scene {

/// `name` with every byte that separates things elsewhere ('.' in EXR channel names, '=' in
/// `--light NAME=POWER`, blanks, ...) or is not valid UTF-8 replaced by '_', cut to at most
/// `max_bytes` bytes between characters. "light" when nothing is left.
std::string clean_light_name(std::string_view name, std::size_t max_bytes);

/// The cleaned name, with a number if it is taken already: lamp, lamp_2, lamp_3.
std::string unused_light_name(std::string_view name, std::unordered_set<std::string>& taken);

/// Cleans the names of all lights and groups. Groups with different names stay separate, and lights
/// whose name occurs twice or belongs to a group that they are not in are numbered.
void make_light_names_unique(std::vector<Light>& lights);

/// What follows "there" in a message: "are 'a', 'b'", "is 'a'" or "are none". The rest of a long
/// list is only counted.
std::string listed_names(std::span<const std::string> names, std::size_t most = 20);

/// The names listed, with those first that have the fewest edits between them and `name`; upper and
/// lower case are equal.
std::string names_like(std::string_view name, std::vector<std::string> names,
                       std::size_t most = 20);

}  // namespace photile::scene
