// All frames of a walk on one picture.
#pragma once

#include "photile/image.hpp"

namespace photile::walk {

/// Small pictures side by side, left to right and top to bottom, on grey.
class ContactSheet {
 public:
  /// Room for `frames` (1 to 10,000) of width x height pixels, each drawn
  /// defaults::contact_sheet_width wide, or less where the sheet would be larger than a picture may
  /// be.
  ContactSheet(int frames, int width, int height);

  /// Frame `index`, from 0: display-referred R, G, B of the size that was announced.
  void add(int index, const Image& displayed);

  const Image& image() const { return image_; }

 private:
  int columns_, width_, height_;  ///< frames, pixels of a small picture
  Image image_;
};

}  // namespace photile::walk
