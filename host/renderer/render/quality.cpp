#include "photile/renderer.hpp"
#include "render/setting.hpp"

namespace photile {

std::string_view name_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return "draft";
    case Quality::good:
      return "good";
    case Quality::best:
      return "final";
  }
  return "unknown";
}

std::string_view description_of(Quality quality) {
  switch (quality) {
    case Quality::draft:
      return "quick, and blurred: light is averaged over many photons";
    case Quality::good:
      return "clean to the eye";
    case Quality::best:
      return "more of everything, for stills";
  }
  return "unknown";
}

void set_quality(RenderParameters& parameters, Quality quality) {
  for (const Setting& setting : settings()) {
    if (setting.is_of_quality()) setting.set(parameters, setting.by_quality[index_of(quality)]);
  }
}

}  // namespace photile
