// The kernel texts that cmake/PhotileEmbed.cmake compiled into the library.
#pragma once

#include <span>
#include <string_view>

namespace photile::device {

struct EmbeddedFile {
  std::string_view path;  ///< below kernels/ ("grid/build.cl"), or "photile/device/<name>.h"
  std::string_view text;
};

/// Every embedded file, in no particular order. Implemented by the generated source.
std::span<const EmbeddedFile> embedded_files();

}  // namespace photile::device
