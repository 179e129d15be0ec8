// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/picture_decoder.h"

#include <fmt/format.h>

#include "lf/pixels/files/image_probe.h"

namespace lf {

Error MissingLibrary(const std::string& name, const char* format, const char* library) {
  return InputError(
      fmt::format("{}: {} images need a build with {}: install it and build the programs again, or "
                  "convert the images to PNG or TIFF",
                  name, format, library));
}

Error MissingAtRunTime(const std::string& name, const char* format, const char* library,
                       const char* package) {
  return InputError(
      fmt::format("{}: {} images need {}, which is not installed here: install it (package {} of "
                  "Debian), or convert the images to PNG or TIFF",
                  name, format, library, package));
}

Result<void> CheckPictureSize(int64_t width, int64_t height, int64_t channels,
                              const std::string& name) {
  constexpr int64_t kMaxValues = int64_t{1} << 32;
  if (width < 1 || height < 1 || channels < 1)
    return InputError(
        fmt::format("{}: claims {} x {} pixels of {} channels: expected at least 1 of each", name,
                    width, height, channels));
  LF_RETURN_IF_ERROR(
      CheckPixelCount(static_cast<uint64_t>(width), static_cast<uint64_t>(height), name));
  if (channels > kMaxValues / (width * height))
    return InputError(fmt::format(
        "{}: claims {} x {} pixels of {} channels, more than the limit of {} values in total", name,
        width, height, channels, kMaxValues));
  return {};
}

}  // namespace lf
