// SPDX-License-Identifier: Apache-2.0
// Calls of libpng whose errors become results. Internal to this folder.
//
// libpng leaves its functions by longjmp() when it meets an error. PngCalls confines these jumps:
// they end in Run(), and no exception of ours passes through libpng.
#pragma once

#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <utility>

namespace lf {

// The state of the calls for one file. It must not be moved, because libpng keeps its address.
class PngCalls {
 public:
  PngCalls() = default;
  PngCalls(const PngCalls&) = delete;
  PngCalls& operator=(const PngCalls&) = delete;

  // Calls `calls`, which calls libpng. Returns false if libpng reported an error, which message()
  // then describes. Rethrows what a callback threw, and throws std::bad_alloc if memory ran out.
  // `calls` may create no object that needs its destructor, because a jump would skip it.
  template <class Calls>
  bool Run(const Calls& calls) {
    if (setjmp(jump_) != 0) {
      if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
      if (out_of_memory_) throw std::bad_alloc();
      return false;
    }
    calls();
    return true;
  }

  // Calls a function of ours inside a callback of libpng. If it throws, libpng is left by a long
  // jump to Run(), which throws the exception again.
  template <class Function>
  void Guard(const Function& function) {
    try {
      function();
      return;
    } catch (...) {
      thrown_ = std::current_exception();
    }
    std::longjmp(jump_, 1);
  }

  const char* message() const { return message_; }

  // These functions are passed to png_create_read_struct_2() and png_create_write_struct_2(), with
  // the address of the PngCalls as pointer for errors and for memory.
  [[noreturn]] static void OnError(png_structp png, png_const_charp message) {
    PngCalls& calls = *static_cast<PngCalls*>(png_get_error_ptr(png));
    std::snprintf(calls.message_, sizeof calls.message_, "%s", message);
    std::longjmp(calls.jump_, 1);
  }
  static void IgnoreWarning(png_structp, png_const_charp) {}
  static png_voidp Allocate(png_structp png, png_alloc_size_t size) {
    void* const memory = std::malloc(size);
    if (memory == nullptr) static_cast<PngCalls*>(png_get_mem_ptr(png))->out_of_memory_ = true;
    return memory;
  }
  static void Free(png_structp, png_voidp memory) { std::free(memory); }

 private:
  std::jmp_buf jump_;
  char message_[256] = {};
  std::exception_ptr thrown_;
  bool out_of_memory_ = false;
};

}  // namespace lf
