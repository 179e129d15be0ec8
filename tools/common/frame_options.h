// The options that are common to programs that render frames or prepare their rendering.
#pragma once

#include <string>

#include "tools/common/help.h"

namespace lf {

// Adds --frames RANGE.
void AddFrameRange(OptionGroup& output, std::string& frames);

// Adds --format exr|exr-float|png|png16.
void AddFrameFormat(OptionGroup& output, std::string& format);

// Adds --video FILE and --no-contact-sheet.
void AddFilmFiles(OptionGroup& output, std::string& video, bool& no_contact_sheet);

}  // namespace lf
