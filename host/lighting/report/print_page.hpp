// HTML pages as PDF.
#pragma once

#include <string>

namespace photile::report {

/// The page as PDF, on the paper that its style names, by WeasyPrint in a process of its own
/// (Debian's package weasyprint). Errors: OutputError where it is missing or fails.
std::string pdf_of(const std::string& html);

}  // namespace photile::report
