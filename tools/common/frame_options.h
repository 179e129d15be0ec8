// SPDX-License-Identifier: Apache-2.0
// The options that are common to programs that render frames or prepare their rendering.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/common/help.h"

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/frame_file.h"

namespace lf {

// The options --frames RANGE and --clamp-frames, which choose frames of a path.
struct FrameRangeArguments {
  std::string range;   // empty: all frames
  bool clamp = false;  // frames beyond the end of the path are left out; false: they are an error

  // Adds the options, and returns them.
  //   use        use of the frames, for the help, such as "render"
  //   if_none    consequence if no frame is left, such as "nothing is rendered"
  std::vector<CLI::Option*> AddTo(OptionGroup& output, const std::string& use,
                                  const std::string& if_none);
  // Returns the frames in ascending order. Empty if the range is empty, which means all frames, and
  // if no frame is left, which IsNone() tells apart. kUsage: as for ParseFrameRange().
  Result<std::vector<FrameId>> Of(const FrameNumbers& all) const;
  // Returns true if no frame of the range is left. The caller must then do nothing, tell so by
  // TellNone(), and end without an error.
  bool IsNone(const std::vector<FrameId>& frames) const { return !range.empty() && frames.empty(); }
  void TellNone() const;

 private:
  std::string if_none_;
};

// Adds --format exr|exr-float|png|png16.
void AddFrameFormat(OptionGroup& output, std::string& format);

// The options that add to the files of frames, or change their colours.
struct PictureArguments {
  bool alpha = false, z = false;
  std::optional<std::string> colour_space;
  std::string channels = "all", exr_compression = "zip";
  std::string view, display;

  void AddTo(OptionGroup& output);
  // True if frames need the alpha that FilmSettings::adds_opacity adds.
  bool HasAlpha() const { return alpha || channels == "rgba"; }
  // kUsage: an option needs files of another format. Other errors are those of DisplayView::Open().
  Result<PictureOptions> Make(FrameFormat format) const;
};

// Adds --video FILE and --no-contact-sheet.
void AddFilmFiles(OptionGroup& output, std::string& video, bool& no_contact_sheet);

}  // namespace lf
