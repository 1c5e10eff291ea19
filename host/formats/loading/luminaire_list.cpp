#include "loading/luminaire_list.hpp"

#include <fmt/format.h>

#include "common/input_file.hpp"
#include "common/json_object.hpp"
#include "common/output_file.hpp"
#include "photile/errors.hpp"

namespace photile::loading {

std::string LuminaireList::text() const {
  if (alone && entries.size() == 1) return entries.front().dump() + "\n";
  std::string text = "[";
  for (const nlohmann::ordered_json& entry : entries) {
    text += text.size() > 1 ? ",\n " : "";
    text += entry.dump();
  }
  return text + "]\n";
}

LuminaireList LuminaireList::parse(const std::string& text, const std::string& name) {
  check_json_depth(text, name);
  const auto content = nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (content.is_discarded()) throw InputError(fmt::format("{}: is no JSON", name));
  LuminaireList list;
  list.alone = !content.is_array();
  if (list.alone) {
    list.entries.push_back(content);
  } else {
    list.entries.assign(content.begin(), content.end());
  }
  return list;
}

LuminaireList read_luminaires(const std::filesystem::path& file) {
  return LuminaireList::parse(read_input_text(file), file.string());
}

LuminaireList read_own_luminaires(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) return {};
  return LuminaireList::parse(read_own_text(file), file.string());
}

void write_luminaires(const std::filesystem::path& file, const LuminaireList& list) {
  write_file(file, list.text());
}

}  // namespace photile::loading
