// How OpenImageIO is used in this folder, and only here. Internal to imageio.
#pragma once

#include "lf/imageio/image_probe.h"

namespace lf {

// No threads of its own: many files are coded at the same time, each by one of our threads.
// Called before every use; the first call does it.
void ConfigureOpenImageIo();

// What OpenImageIO calls its coder of the format.
const char* PluginName(ImageFormat format);

}  // namespace lf
