// SPDX-License-Identifier: Apache-2.0
// Parses the texts in which a frame states its camera. Internal to this folder.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "lf/pixels/files/picture_header.h"

namespace lf {

// Returns the camera that a picture states, or nullopt if an entry is missing or no direction or
// position: three finite numbers with blanks between them.
//   text_of  returns the text of an entry, such as "lf:position"; "" if there is none
std::optional<StatedCamera> StatedCameraOf(const std::function<std::string(const char*)>& text_of);

}  // namespace lf
