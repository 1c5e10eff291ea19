// Files that a run reads: whether they can be read, and the content of texts.
#pragma once

#include <filesystem>
#include <string>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile {

/// What keeps it from being one, with the remedy: "no such file; check the path", "is not a regular
/// file; name one". "" where nothing does.
std::string why_no_regular_file(const std::filesystem::path& file);

/// The whole content. Errors: InputError naming the file where it is missing, unreadable, no
/// regular file or larger than limits::max_input_text_bytes; those of note_input.
std::string read_input_text(const std::filesystem::path& file);

/// The same for a file that the run may write again: it is not noted as an input.
std::string read_own_text(const std::filesystem::path& file);

/// What `work` finds wrong with what a file holds, or with what is asked of it, by the file's name;
/// without a file, as it is.
template <class Work>
auto about_file(const std::filesystem::path& file, const Work& work) {
  const auto named = [&](const std::string& what) {
    const std::string name = one_line(file.string()) + ": ";
    return file.empty() || what.starts_with(name) ? what : name + what;
  };
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(named(error.what()));
  } catch (const UsageError& error) {
    throw UsageError(named(error.what()));
  }
}

}  // namespace photile
