// Setup and error checks of OpenImageIO for this folder. Internal to this folder.
#pragma once

#include <string>

#include "lf/core/result.h"
#include "lf/pixels/files/image_probe.h"

namespace lf {

// Makes OpenImageIO start no threads of its own, because many files are encoded or decoded at the
// same time, each by one of our threads. Must be called before every use; only the first call has
// an effect.
void ConfigureOpenImageIo();

// Returns OpenImageIO's name for its plugin of the format, which must not be kRaw.
const char* PluginName(ImageFormat format);

// kInput if `remarks`, the messages of a decoder, are not empty. After an error libtiff continues
// with the next row, and libpng with the data it has, so any message means that pixels may be
// missing.
Result<void> CheckRemarks(const std::string& remarks, const std::string& name);

}  // namespace lf
