// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/stated_camera.h"

#include <charconv>
#include <cmath>

namespace lf {
namespace {

bool ParseThree(const std::string& text, std::array<double, 3>* numbers) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (double& number : *numbers) {
    while (at != end && *at == ' ') ++at;
    const std::from_chars_result read = std::from_chars(at, end, number);
    if (read.ec != std::errc() || !std::isfinite(number)) return false;
    at = read.ptr;
  }
  return at == end;
}

}  // namespace

std::optional<StatedCamera> StatedCameraOf(const std::function<std::string(const char*)>& text_of) {
  StatedCamera facts;
  if (ParseThree(text_of("lf:position"), &facts.position) &&
      ParseThree(text_of("lf:forward"), &facts.forward) && ParseThree(text_of("lf:up"), &facts.up))
    return facts;
  return std::nullopt;
}

}  // namespace lf
