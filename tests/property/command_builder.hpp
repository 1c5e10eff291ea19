// Parts that commands at random have in common.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "random_command.hpp"

namespace photile::test {

/// Adds arguments to a command, and says which files it reads and writes.
class CommandBuilder {
 public:
  CommandBuilder(const Workplace& place, Dice& dice) : place_(place), dice_(dice) {}

 protected:
  void add(std::initializer_list<std::string> arguments);
  void maybe(double probability, std::initializer_list<std::string> arguments);
  /// An option with the file, or folder, that it is to write.
  void output(const std::string& option, const std::string& name);
  /// A file beside the scene, to be read.
  std::filesystem::path input(const std::string& name, const std::string& content);
  std::filesystem::path weather();  ///< a year, seldom a part of one

  void scene();
  /// Options of the table of settings, but for some.
  void settings(const std::vector<std::string_view>& without = {});
  std::string light();  ///< a name, seldom of none
  void light_changes(double probability);
  /// What is added to lamps and changed in them, skies and materials while the scene is loaded.
  void lights();
  void scene_changes();
  void sky();
  void mood();
  void film();
  void scale();
  void false_colour();
  void tone_mapping();
  void run();
  void drawings(double probability);

  const Workplace& place_;
  Dice& dice_;
  RandomCommand command_;

 private:
  void luminaires();
};

}  // namespace photile::test
