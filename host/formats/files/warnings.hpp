// What an import finds wrong and goes on with, or leaves to the importer.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "common/ascii_text.hpp"

namespace photile::files {

/// A texture, buffer or material library cannot be used. `what()` names the file and the reason;
/// the importer decides whether to go on with a warning or to fail.
struct ResourceError : std::runtime_error {
  explicit ResourceError(const std::string& message) : std::runtime_error(one_line(message)) {}
};

/// Gathered so that a hundred materials with one trouble give one line.
class Warnings {
 public:
  /// A warning about the whole file.
  void add(const std::string& message);

  /// A warning about one object: `kind` is "material", "node", ... Objects of one kind with the
  /// same message share a line.
  void add(const std::string& kind, const std::string& name, const std::string& message);

  /// One line each, in the order in which they were first met.
  std::vector<std::string> lines() const;

 private:
  struct Entry {
    std::string kind, message;
    std::vector<std::string> first_names;
    std::set<std::string> names;
  };
  std::vector<Entry> entries_;
  std::map<std::pair<std::string, std::string>, std::size_t> index_;  ///< by kind and message
};

}  // namespace photile::files
