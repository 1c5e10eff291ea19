#include "common/module.hpp"

#include <dlfcn.h>

namespace photile {

Module::Module(const std::filesystem::path& file, Symbols symbols)
    : handle_(dlopen(file.c_str(), RTLD_NOW | (symbols == Symbols::own ? RTLD_LOCAL : RTLD_GLOBAL)),
              &dlclose) {
  if (!handle_) error_ = dlerror();
}

void* Module::address_of(const char* name) const {
  return handle_ ? dlsym(handle_.get(), name) : nullptr;
}

}  // namespace photile
