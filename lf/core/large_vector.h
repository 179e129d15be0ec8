// SPDX-License-Identifier: Apache-2.0
// Vectors for images and plates. They begin at the boundary of a cache line (64 bytes), so that
// SIMD loads cross as few cache lines as possible. Vectors of 4 MiB and more request huge pages
// from the system. With small pages, each access to a distant row walks through the page tables,
// which took a tenth to a sixth of the time of ray collection.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

namespace lf {

template <class T>
struct LargeAllocator {
  static_assert(alignof(T) <= alignof(std::max_align_t));
  using value_type = T;
  static constexpr size_t kCacheLine = 64;
  static constexpr size_t kHugePage = size_t{2} << 20;

  LargeAllocator() = default;
  template <class U>
  LargeAllocator(const LargeAllocator<U>& /*other*/) {}  // NOLINT: implicit, as allocators must be

  T* allocate(size_t count) {
    if (count > (SIZE_MAX - kCacheLine) / sizeof(T)) throw std::bad_array_new_length();
    const size_t bytes = (count * sizeof(T) + kCacheLine - 1) / kCacheLine * kCacheLine;
    const bool is_large = bytes >= 2 * kHugePage;
    void* memory = nullptr;
    if (posix_memalign(&memory, is_large ? kHugePage : kCacheLine, bytes) != 0)
      throw std::bad_alloc();
    // This is only a request: a system without huge pages gives small ones.
    if (is_large) madvise(memory, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t /*count*/) { std::free(memory); }
  friend bool operator==(const LargeAllocator&, const LargeAllocator&) = default;
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace lf
