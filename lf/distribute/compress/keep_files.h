// SPDX-License-Identifier: Apache-2.0
// Which LF images a packed store keeps as the bytes of their image files, instead of encoding them.
#pragma once

#include <cstdint>

namespace lf {

// A file that is kept gives exactly its pixels, and is decoded as slowly as in a folder. A view of
// a larger picture, and a part of an LF image that packages need, are encoded in any case.
enum class KeepFiles : uint8_t {
  kNone,     // all LF images are encoded
  kSmaller,  // files that are at most as large as their encoded images
  kAll,      // all files
};

}  // namespace lf
