// One stored value of any type as a float. Internal to this folder.
#pragma once

#include <OpenImageIO/typedesc.h>

#include <cstddef>

namespace lf {

// The value itself: OpenImageIO would scale integers to [0, 1].
float FloatOf(OIIO::TypeDesc type, const std::byte* bytes);

}  // namespace lf
