// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/focal_surface_source.h"

#include <fmt/format.h>

#include <cstddef>

namespace lf {
namespace {

// The place of a frame's number in a file name.
struct NumberPlace {
  size_t begin = 0;
  size_t end = 0;  // 0: there is none
  int digits = 1;  // least number of digits, filled up with zeros
};

NumberPlace NumberIn(const std::string& file) {
  for (size_t i = 0; i < file.size(); ++i) {
    if (file[i] != '%') continue;
    size_t end = i + 1;
    while (end < file.size() && end < i + 4 && file[end] >= '0' && file[end] <= '9') ++end;
    if (end >= file.size() || file[end] != 'd') continue;
    int digits = 0;
    for (size_t k = i + 1; k < end; ++k) digits = 10 * digits + (file[k] - '0');
    return {i, end + 1, digits > 0 ? digits : 1};
  }
  return {};
}

}  // namespace

std::string FileOfFrame(const FocalSurfaceSource& source, uint32_t frame) {
  const NumberPlace place = NumberIn(source.file);
  if (place.end == 0) return source.file;
  return fmt::format("{}{:0{}}{}", source.file.substr(0, place.begin), frame, place.digits,
                     source.file.substr(place.end));
}

bool HasFilePerFrame(const FocalSurfaceSource& source) { return NumberIn(source.file).end != 0; }

}  // namespace lf
