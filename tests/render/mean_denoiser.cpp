// A library with the functions of Open Image Denoise 2 that photile calls: its "filter" gives each
// pixel the mean of those around it, 3x3, whose albedo and normal are its own. Alone, an albedo or
// a normal is rounded to quarters, which takes away a little noise.
#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>
#include <map>
#include <string>

namespace {

struct Device {};

struct Filter {
  std::map<std::string, glm::vec3*> images;
  int width = 0, height = 0;
  bool hdr = false, clean_guides = false;

  bool has(const char* name) const { return images.count(name) != 0; }
};

glm::vec3 mean_of_like(const Filter& filter, int column, int row) {
  const glm::vec3* albedo = filter.images.at("albedo");
  const glm::vec3* normal = filter.images.at("normal");
  const int own = row * filter.width + column;
  glm::vec3 sum(0.0f);
  float count = 0;
  for (int y = row - 1; y <= row + 1; ++y) {
    for (int x = column - 1; x <= column + 1; ++x) {
      if (y < 0 || x < 0 || y >= filter.height || x >= filter.width) continue;
      const int other = y * filter.width + x;
      if (albedo[other] != albedo[own] || normal[other] != normal[own]) continue;
      sum += filter.images.at("color")[other];
      count += 1;
    }
  }
  return sum / count;
}

/// What is asked for wrongly shows as -1.
glm::vec3 filtered(const Filter& filter, int column, int row) {
  if (filter.has("color")) {
    const bool whole = filter.hdr && filter.clean_guides;
    return whole ? mean_of_like(filter, column, row) : glm::vec3(-1.0f);
  }
  if (filter.hdr || filter.has("albedo") == filter.has("normal")) return glm::vec3(-1.0f);
  const glm::vec3* guide = filter.images.at(filter.has("albedo") ? "albedo" : "normal");
  return glm::round(4.0f * guide[row * filter.width + column]) / 4.0f;
}

}  // namespace

extern "C" {

Device* oidnNewDevice(int) { return new Device; }
void oidnReleaseDevice(Device* device) { delete device; }
void oidnSetDeviceInt(Device*, const char*, int) {}
int oidnGetDeviceInt(Device*, const char* name) {
  return std::strcmp(name, "versionMajor") == 0 ? 2 : 0;
}
void oidnCommitDevice(Device*) {}
int oidnGetDeviceError(Device*, const char**) { return 0; }
Filter* oidnNewFilter(Device*, const char*) { return new Filter; }
void oidnReleaseFilter(Filter* filter) { delete filter; }
void oidnSetSharedFilterImage(Filter* filter, const char* name, void* pixels, int,
                              std::size_t width, std::size_t height, std::size_t, std::size_t,
                              std::size_t) {
  filter->images[name] = static_cast<glm::vec3*>(pixels);
  filter->width = static_cast<int>(width);
  filter->height = static_cast<int>(height);
}
void oidnSetFilterBool(Filter* filter, const char* name, bool value) {
  (std::strcmp(name, "cleanAux") == 0 ? filter->clean_guides : filter->hdr) = value;
}
void oidnCommitFilter(Filter*) {}
void oidnExecuteFilter(Filter* filter) {
  for (int row = 0; row < filter->height; ++row) {
    for (int column = 0; column < filter->width; ++column) {
      filter->images.at("output")[row * filter->width + column] = filtered(*filter, column, row);
    }
  }
}

}  // extern "C"
