// Objects in JSON files written by users, read member by member.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace photile {

/// The content of a file. Errors: those of read_input_text and check_json_depth; InputError where
/// it is not JSON.
nlohmann::json read_input_json(const std::filesystem::path& file);

/// Values are copied, compared and written recursively: deeply nested brackets would overflow the
/// stack. Errors: InputError naming `file` where they are nested deeper than
/// limits::max_json_depth.
void check_json_depth(std::string_view text, const std::string& file);

/// One object of a file. Every error is an InputError that names its position in the file.
class JsonObject {
 public:
  ///   object   must outlive this
  ///   where    the file and the object's position in it, for messages
  ///   known    the members that it may have
  /// Errors: InputError where it is not an object, or has an unknown member.
  JsonObject(const nlohmann::json& object, std::string where,
             std::initializer_list<const char*> known);

  bool has(const char* key) const { return object_.contains(key); }

  // Errors: InputError where the member is missing, of another type or out of range.

  /// In [lowest, highest].
  double number(const char* key, double lowest, double highest) const;
  /// More than 0, at most limits::max_coordinate.
  double metres(const char* key) const;
  /// Whole, in [lowest, highest].
  int count(const char* key, int lowest, int highest) const;
  /// Each coordinate at most limits::max_coordinate from 0.
  glm::dvec3 vector(const char* key) const;

  /// Not empty; `otherwise` where it is missing.
  std::string text(const char* key, const std::string& otherwise) const;

  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  /// null where it is missing.
  nlohmann::json member(const char* key) const { return object_.value(key, nlohmann::json()); }

  const nlohmann::json& object_;
  std::string where_;
};

}  // namespace photile
