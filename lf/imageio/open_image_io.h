// Setup and error checks of OpenImageIO for this folder. Internal to imageio.
#pragma once

#include <string>

#include "lf/core/result.h"
#include "lf/imageio/image_probe.h"

namespace lf {

// Makes OpenImageIO start no threads of its own, because many files are coded at a time, each by
// one of our threads. Must be called before every use; only the first call has an effect.
void ConfigureOpenImageIo();

// Returns what OpenImageIO calls its coder of the format, which must not be kRaw.
const char* PluginName(ImageFormat format);

// kInput if a decoder reported anything. After an error libtiff continues with the next row, and
// libpng with the data it has, so a report means that some pixels were not recorded.
Result<void> CheckRemarks(const std::string& remarks, const std::string& name);

}  // namespace lf
