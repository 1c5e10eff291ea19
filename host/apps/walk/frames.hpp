// The numbered frames of a walk: the names of their files, and all of them on one picture.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "photile/image.hpp"

namespace photile::walk {

/// A file's name with a position for the number of a frame: a run of '#', as long as the number is
/// wide at least, or %d, %4d, %04d as in printf. A name without one gets .#### before its ending.
class FrameNames {
 public:
  /// Errors: UsageError where there are several positions, or a text that looks like one.
  explicit FrameNames(const std::string& pattern);

  std::filesystem::path of(int frame) const;

 private:
  std::string before_, after_;
  int width_ = 1;  ///< digits at least
  char fill_ = '0';
};

/// Frames first, first + step ... up to last, by number.
struct FrameRange {
  int first = 0, last = 0, step = 1;

  bool contains(int number) const {
    return number >= first && number <= last && (number - first) % step == 0;
  }
};

/// "7", "1-240" or "1-240x10", as render farms write it. Nothing if it is none: numbers are whole,
/// the last is not below the first, and the step is above 0.
std::optional<FrameRange> parse_frame_range(std::string_view text);

/// The place, from 0, of a frame of `count` on a sheet that shows `most` of them, at even distances
/// where they are more; -1 for one that it leaves out.
int place_on_sheet(int frame, int count, int most);

/// Small pictures side by side, left to right and top to bottom, on grey.
class ContactSheet {
 public:
  /// Room for `frames` (1 to 10,000) of width x height pixels, each drawn
  /// defaults::contact_sheet_width wide, or less where the sheet would be larger than a picture may
  /// be.
  ContactSheet(int frames, int width, int height);

  /// Frame `index`, from 0: display-referred R, G, B of the size that was announced. `name` is
  /// written in its lower left corner.
  void add(int index, const Image& displayed, const std::string& name = {});

  const Image& image() const { return image_; }

 private:
  void write(int left, int bottom, const std::string& name);

  int columns_, width_, height_;  ///< frames, pixels of a small picture
  Image image_;
};

}  // namespace photile::walk
