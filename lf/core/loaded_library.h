// SPDX-License-Identifier: Apache-2.0
// Loads a shared library when it is first needed.
//
// A library that many programs link but few use costs each of them its start: libheif, libjxl and
// libhdf5 load some 45 further libraries, which takes 11 ms and 12 MiB.
#pragma once

namespace lf {

// A library that stays loaded until the program ends. Functions may be called by many threads at
// once.
class LoadedLibrary {
 public:
  // Loads the library.
  //   file_name  as the linker of the system finds it, such as "libheif.so.1"
  explicit LoadedLibrary(const char* file_name);

  // Returns the address of a function or a variable; null if the library is not installed or lacks
  // it, which also sets has_all() to false.
  void* Find(const char* name);
  // Returns true if everything that was looked for was found.
  bool has_all() const { return has_all_; }

 private:
  void* handle_ = nullptr;
  bool has_all_ = false;
};

}  // namespace lf

// Declares a member with the name and the type of a function of a library, and sets it to the
// address that the member `library` finds.
#define LF_LOADED(function) \
  decltype(&::function) function = reinterpret_cast<decltype(&::function)>(library.Find(#function))
