// The words of reports in other languages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace photile::report {

/// "en", "de".
const std::vector<std::string>& languages();

/// A text of reports in one of the languages; one that the table lacks stays English.
std::string translated(std::string_view english, std::string_view language);

}  // namespace photile::report
