// Tiny scenes, written to a folder.
#pragma once

#include <string>

#include "file_folder.hpp"

namespace photile::test {

/// A closed box of 2 x 2 x 2 m with diffuse walls and two lamps under its ceiling, "left" and
/// "right", as OBJ with its MTL. Returns the path of the OBJ.
std::string write_box(const FileFolder& folder);

/// The text of the box's OBJ, to be spoilt by a test; it names box.mtl.
std::string box_obj();

/// The box with a wall left out.
std::string open_box_obj();

/// The text of box.mtl.
std::string box_mtl();

}  // namespace photile::test
