// The page without a room: page/page.html with its style and scripts, joined when photile is built.
#pragma once

#include <string_view>

namespace photile::publish {

/// Holds @TITLE@, @ROOM@ and @DATA@ where these belong.
std::string_view page_template();

}  // namespace photile::publish
