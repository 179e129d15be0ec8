// SPDX-License-Identifier: Apache-2.0
#include "tools/common/frame_options.h"

#include <fmt/format.h>

#include "tools/common/program.h"
#include "tools/common/validators.h"

#include "lf/core/log.h"
#include "lf/film/develop/display_view.h"
#include "lf/film/develop/video.h"
#include "lf/render/pipeline/frame_range.h"

namespace lf {

std::vector<CLI::Option*> FrameRangeArguments::AddTo(OptionGroup& output, const std::string& use,
                                                     const std::string& if_none) {
  if_none_ = if_none;
  CLI::Option* const frames =
      output
          .Add("--frames RANGE", range,
               fmt::format("Frames to {}, such as 1-100x2, 7 or 3-5,9 (all)\n"
                           "1-100x2, 1-100:2: every second frame of 1 to 100. They are the "
                           "numbers of the path, which count from 1 or its first_frame.",
                           use))
          ->check(NotEmpty());
  CLI::Option* const clamps = output.AddFlag(
      "--clamp-frames", clamp,
      fmt::format("Leave out frames of --frames beyond the end of the path\n"
                  "Without this option they are an error. If none is left, {}, and "
                  "the exit code is 0. Render farms need this if their last chunk may be too long.",
                  if_none));
  return {frames, clamps};
}

Result<std::vector<FrameId>> FrameRangeArguments::Of(const FrameNumbers& all) const {
  if (range.empty()) return std::vector<FrameId>();
  return ParseFrameRange(range, all, "--frames",
                         clamp ? FramesBeyondEnd::kLeftOut : FramesBeyondEnd::kError);
}

void FrameRangeArguments::TellNone() const {
  LogInfo("--frames {}: all of these frames are beyond the end of the path: {}", range, if_none_);
}

void AddFrameFormat(OptionGroup& output, std::string& format) {
  output.AddChoice("--format", format, {"exr", "exr-float", "png", "png16"},
                   "File format of the frames\n"
                   "exr: linear light as 16-bit floating-point numbers\n"
                   "exr-float: linear light as 32-bit floating-point numbers\n"
                   "png: 8-bit sRGB\n"
                   "png16: 16-bit sRGB");
}

namespace {

void AddViews(OptionGroup& output, PictureArguments& a) {
  output
      .Add(
          "--view VIEW", a.view,
          "Make PNG frames by a view of OpenColorIO (sRGB)\n"
          "VIEW: a view of the configuration that the environment variable OCIO names, such as the "
          "output transform of ACES. Contact sheet and video show the same picture.")
      ->check(NotEmpty());
  output.Add("--display DISPLAY", a.display, "Display of --view (that of the configuration)")
      ->needs("--view")
      ->check(NotEmpty());
}

}  // namespace

void PictureArguments::AddTo(OptionGroup& output) {
  output
      .Add("--colour-space SPACE", colour_space,
           "Primaries of EXR frames: rec709, rec2020, acescg (rec709)\n"
           "The light stays linear. The attribute chromaticities of the file names the primaries.\n"
           "rec709: those of sRGB displays, white D65\n"
           "rec2020: those of ITU-R BT.2020, white D65\n"
           "acescg: AP1, with white adapted from D65 to that of ACES (Bradford)")
      ->check(CLI::IsMember({"rec709", "rec2020", "acescg"}));
  output.AddFlag("--frame-alpha", alpha,
                 "Give frames alpha\n"
                 "Alpha is 1 where light was recorded or filled, and 0 where nothing was recorded. "
                 "Frames that have alpha without this option, because their LF images have, keep "
                 "it. Colours are multiplied by alpha in EXR frames, and are not in PNG frames.");
  output.AddFlag("--z", z,
                 "Give EXR frames the depth of the focus plane\n"
                 "The channel Z is the depth at which each element is in focus, along the optical "
                 "axis, in world units. It varies if the focus plane is tilted, and is infinite "
                 "where an element does not see the plane.");
  output.AddChoice("--channels", channels, {"all", "rgba", "rgb"},
                   "Channels of EXR frames\n"
                   "all: light, and what is known of each element, such as the number of rays\n"
                   "rgba: R, G, B and A alone, with alpha as by --frame-alpha\n"
                   "rgb: R, G and B alone\n"
                   "--z adds Z to any of them.");
  output.AddChoice(
      "--exr-compression", exr_compression, {"zip", "zips"},
      "Compression of EXR frames, which loses nothing\n"
      "zip: 16 rows together\n"
      "zips: each row by itself, for compositing programs that read frames row by row");
  AddViews(output, *this);
}

namespace {

// kUsage if an option has no meaning for PNG frames.
Result<void> CheckSuitsPng(const PictureArguments& a, FrameFormat format) {
  std::string option;
  if (a.exr_compression != "zip") option = "--exr-compression " + a.exr_compression;
  if (a.channels != "all") option = "--channels " + a.channels;
  if (a.colour_space.value_or("rec709") != "rec709") option = "--colour-space " + *a.colour_space;
  if (a.z) option = "--z";
  if (option.empty()) return {};
  return UsageError(fmt::format(
      "--format {}: cannot be used with {}, because PNG frames are sRGB pictures for display: "
      "leave one of them out, or use --format exr",
      NameOf(format), option));
}

}  // namespace

Result<PictureOptions> PictureArguments::Make(FrameFormat format) const {
  PictureOptions options;
  options.has_focus_depth = z;
  if (colour_space) options.colours = *ParseColourSpace(*colour_space);
  options.channels = *ParseFrameChannels(channels);
  options.compression = *ParseExrCompression(exr_compression);
  if (!IsExr(format)) LF_RETURN_IF_ERROR(CheckSuitsPng(*this, format));
  if (alpha && options.channels == FrameChannels::kRgb)
    return UsageError(
        "--channels rgb: cannot be used with --frame-alpha, which adds a channel: use --channels "
        "rgba, or leave --frame-alpha out");
  if (view.empty()) return options;
  if (IsExr(format))
    return UsageError(fmt::format(
        "--view {}: cannot be used with --format {}, which holds linear light: use --format png or "
        "png16, or leave it out and give compositing programs the linear light",
        view, NameOf(format)));
  LF_ASSIGN_OR_RETURN(options.view, DisplayView::Open(display, view));
  return options;
}

namespace {

// Accepts names of videos, so that another name is refused before anything is read.
CLI::Validator VideoName() {
  return CLI::Validator(
      [](const std::string& word) -> std::string {
        if (IsVideoName(word)) return "";
        return fmt::format(
            "expected a name that ends in .mp4, found '{}': no other kind of video is written",
            word);
      },
      "");
}

}  // namespace

void AddFilmFiles(OptionGroup& output, std::string& video, bool& no_contact_sheet) {
  output.Add("--video FILE", video, "Also write the frames as this video, NAME.mp4; needs ffmpeg")
      ->check(NotEmpty())
      ->check(VideoName())
      ->check(TakesFiles(".mp4"));
  output.AddFlag("--no-contact-sheet", no_contact_sheet,
                 "Do not write contact_sheet.png\n"
                 "The contact sheet shows a dozen frames on one page.");
}

}  // namespace lf
