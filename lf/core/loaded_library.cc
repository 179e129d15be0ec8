// SPDX-License-Identifier: Apache-2.0
#include "lf/core/loaded_library.h"

#include <dlfcn.h>

namespace lf {

// RTLD_LOCAL keeps the functions of the library apart from those of the program.
LoadedLibrary::LoadedLibrary(const char* file_name)
    : handle_(::dlopen(file_name, RTLD_NOW | RTLD_LOCAL)), has_all_(handle_ != nullptr) {}

void* LoadedLibrary::Find(const char* name) {
  void* const found = handle_ == nullptr ? nullptr : ::dlsym(handle_, name);
  if (found == nullptr) has_all_ = false;
  return found;
}

}  // namespace lf
