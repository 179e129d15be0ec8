// How OpenImageIO is used in this folder, and only here. Internal to imageio.
#pragma once

#include <string>

#include "lf/core/result.h"
#include "lf/imageio/image_probe.h"

namespace lf {

// No threads of its own: many files are coded at the same time, each by one of our threads.
// Called before every use; the first call does it.
void ConfigureOpenImageIo();

// Returns what OpenImageIO calls its coder of the format, which must not be kRaw.
const char* PluginName(ImageFormat format);

// kInput if a decoder remarked anything. libtiff goes on with the next row, and libpng with what it
// has: it means pixels that were not recorded.
Result<void> CheckRemarks(const std::string& remarks, const std::string& name);

}  // namespace lf
