// The options that are common to programs that render frames or prepare their rendering.
#pragma once

#include <optional>
#include <string>

#include "tools/common/help.h"

#include "lf/core/result.h"
#include "lf/film/develop/frame_file.h"

namespace lf {

// Adds --frames RANGE.
void AddFrameRange(OptionGroup& output, std::string& frames);

// Adds --format exr|exr-float|png|png16.
void AddFrameFormat(OptionGroup& output, std::string& format);

// The options that add to the files of frames, or change their colours.
struct PictureArguments {
  bool alpha = false, z = false;
  std::optional<std::string> colour_space;
  std::string view, display;

  void AddTo(OptionGroup& output);
  // kUsage: an option needs files of another format. Other errors are those of DisplayView::Open().
  Result<PictureOptions> Make(FrameFormat format) const;
};

// Adds --video FILE and --no-contact-sheet.
void AddFilmFiles(OptionGroup& output, std::string& video, bool& no_contact_sheet);

}  // namespace lf
