#include "tools/common/frame_options.h"

#include "tools/common/program.h"
#include "tools/common/validators.h"

namespace lf {

void AddFrameRange(OptionGroup& output, std::string& frames) {
  output
      .Add("--frames RANGE", frames,
           "Frames to render, such as 1-100x2, 7 or 3-5,9 (all)\n"
           "1-100x2: every second frame of 1 to 100. Frames are counted from 1.")
      ->check(NotEmpty());
}

void AddFrameFormat(OptionGroup& output, std::string& format) {
  output.AddChoice("--format", format, {"exr", "exr-float", "png", "png16"},
                   "File format of the frames\n"
                   "exr: linear light as 16-bit floating-point numbers\n"
                   "exr-float: linear light as 32-bit floating-point numbers\n"
                   "png: 8-bit sRGB\n"
                   "png16: 16-bit sRGB");
}

void AddFilmFiles(OptionGroup& output, std::string& video, bool& no_contact_sheet) {
  output.Add("--video FILE", video, "Also write the frames as this mp4 file; needs ffmpeg")
      ->check(NotEmpty());
  output.AddFlag("--no-contact-sheet", no_contact_sheet,
                 "Do not write contact_sheet.png\n"
                 "The contact sheet shows a dozen frames on one page.");
}

}  // namespace lf
