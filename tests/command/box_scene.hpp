// Tiny scenes, written to a folder, and commands that read them.
#pragma once

#include <string>

#include "child_process.hpp"
#include "file_folder.hpp"

namespace photile::test {

/// A closed box of 2 x 2 x 2 m with diffuse walls and two lamps under its ceiling, "left" and
/// "right", as OBJ with its MTL. Returns the path of the OBJ.
std::string write_box(const FileFolder& folder);

/// The text of the box's OBJ, to be spoilt by a test; it names box.mtl.
std::string box_obj();

/// The box with a wall left out, and as a file.
std::string open_box_obj();
std::string write_open_box(const FileFolder& folder);

/// The weather of a year in which every day is alike: light from nine to five.
std::string write_weather(const FileFolder& folder);

/// The text of box.mtl.
std::string box_mtl();

/// A draft of the box, 16 x 12 pixels, to out.png.
Run small_render(const FileFolder& folder);

/// A command, by its words: DISK stands for a folder in this one, SCENE, LARGE and MANY for files
/// of it, NOWHERE for a picture that nobody looks at.
std::string filled(std::string command, const FileFolder& folder);

}  // namespace photile::test
