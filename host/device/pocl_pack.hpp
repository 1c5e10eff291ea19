// A PoCL program folder as one string: what a checked file carries.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace photile::device {

/// Texts of files by their path relative to PoCL's cache folder ("KO/BJGN.../program.bc").
using PackedFiles = std::map<std::string, std::string>;

/// The files below `folders` (relative to `root`) that a later run can use; unreadable ones throw
/// std::filesystem::filesystem_error.
PackedFiles collect_files(const std::filesystem::path& root, const std::set<std::string>& folders);

/// Writes the files below `root`, leaving those that exist: PoCL may have them mapped. Throws
/// std::runtime_error where one cannot be written; it is gone then.
void restore_files(const std::filesystem::path& root, const PackedFiles& files);

std::string pack(const PackedFiles& files);

/// Throws std::runtime_error on a text that `pack` did not make, and on a path that would leave the
/// root.
PackedFiles unpack(std::string_view text);

/// The "XX/name" program folders of PoCL's cache folder `root`.
std::set<std::string> program_folders(const std::filesystem::path& root);

/// The program folders that `files` lie in.
std::set<std::string> program_folders(const PackedFiles& files);

}  // namespace photile::device
