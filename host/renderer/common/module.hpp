// Shared objects that a process loads when it first needs them: processes that need none start
// faster and take less memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace photile {

class Module {
 public:
  /// Where the symbols of the module are visible: in itself, or also in what it loads in turn.
  enum class Symbols { own, global };

  /// `file`: a path, or the name of one of photile's modules, which is found by the run paths of
  /// the command, of the Python module and of programs that link the library.
  explicit Module(const std::filesystem::path& file, Symbols symbols = Symbols::own);

  /// One line about why it is not loaded, or "".
  const std::string& error() const { return error_; }

  /// Null where it has no such function, or is not loaded.
  template <class Function>
  Function* find(const char* name) const {
    return reinterpret_cast<Function*>(address_of(name));
  }

 private:
  void* address_of(const char* name) const;

  std::unique_ptr<void, int (*)(void*)> handle_;
  std::string error_;
};

}  // namespace photile
