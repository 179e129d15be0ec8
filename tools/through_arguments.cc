// SPDX-License-Identifier: Apache-2.0
#include "tools/through_arguments.h"

#include <algorithm>

#include "tools/common/help.h"
#include "tools/common/program.h"
#include "tools/common/validators.h"

#include "lf/render/package/package_file.h"

namespace lf {
namespace {

void AddOutput(CLI::App& app, ThroughArguments& a) {
  OptionGroup output(app, kOutputGroup);
  output
      .Add("-o,--output OUT", a.outputs,
           "File to write, .exr or .png in sRGB, or folder of frames\n"
           "Files may be given several times. Channels and attributes are those of a frame. The "
           "channels count_red, count_green and count_blue tell the number of rays of which the "
           "statistic is taken.")
      ->required()
      ->check(NotEmpty())
      ->check(TakesFiles(".exr .png folder"));
  a.frames.AddTo(output, "render", "nothing is rendered");
  output.AddChoice("--format", a.format, {"auto", "exr", "exr-float", "png", "png16"},
                   "Values in the files\n"
                   "auto: exr or png, by the extension of the name; exr in a folder\n"
                   "exr, exr-float: linear light as floating-point numbers of 16 or 32 bits\n"
                   "png, png16: sRGB of 8 or 16 bits");
  a.picture.AddTo(output);
  AddFilmFiles(output, a.video, a.no_contact_sheet);
}

void AddRunning(CLI::App& app, ThroughArguments& a) {
  OptionGroup running(app, kRunningGroup);
  running
      .Add("--memory SIZE", a.memory,
           "Upper limit of the memory that is used\n"
           "SIZE: such as 8G or 512M. Frames whose values fit together read each LF image once. If "
           "the values of one frame need more, it is made in parts, and LF images are read once "
           "for each.")
      ->check(NotEmpty());
  CLI::Option* const resume = running.AddFlag(
      "--resume", a.resume,
      "Continue the unfinished frames of a folder\n"
      "The inputs and the options that change frames must be the same. Finished frames are kept; "
      "the frames that were being made are begun again.");
  running
      .AddFlag("--overwrite", a.overwrite,
               "Replace files that exist, and remove an unfinished render\n"
               "Needed, unless --resume is given, if a file exists, or if the folder has an "
               "unfinished render or frames of another film. Finished frames in the folder are "
               "replaced one by one.")
      ->excludes(resume);
}

}  // namespace

void ThroughArguments::AddTo(CLI::App& app) {
  ThroughArguments& a = *this;
  a.light_field.AddTo(app);
  a.light_field.AddReduceTo(app);
  OptionGroup input(app, kInputGroup);
  input
      .Add("PATH", a.paths,
           std::string(kPathHelp) +
               " Or packages of lfpreprocessor: files that end in .lfp, whose light field is "
               "LIGHTFIELD.")
      ->required()
      ->check(NotEmpty());
  a.frame.AddNumberTo(input);
  a.allow_missing.AddTo(app, "the LF images that the lens sees");
  AddOutput(app, a);
  OptionGroup look(app, kPictureGroup);
  look.AddChoice("--statistic", a.statistic, {"median", "trimmed", "min", "max", "mean"},
                 "Statistic of the rays of each element\n"
                 "median: the value in the middle; the mean of the two in the middle of an even "
                 "number\n"
                 "trimmed: the mean without the share --trim of the values at each end\n"
                 "min, max: the lowest and the highest value\n"
                 "mean: the mean, as in a frame with --lens-weights none");
  CLI::Option* const share =
      look.Add("--trim SHARE", a.trim,
               "Share of values that trimmed leaves out at each end\n"
               "From 0 to below 0.5. Of n values, SHARE times n are left out at each end, "
               "rounded down.");
  share->check(CLI::Range(0.0, 0.5));
  look.AddChoice("--order", a.order, {"channels", "luminance"},
                 "Values that are sorted\n"
                 "channels: each colour by itself, so that a colour may be one that no ray has\n"
                 "luminance: whole rays by their luminance, so that their colours stay together");
  look.AddChoice("--filter", a.filter, {"auto", "nearest", "bilinear", "bicubic", "prefiltered"},
                 "Interpolation between LF pixels\n"
                 "auto: bilinear for min and max, because other filters undershoot and overshoot "
                 "beside edges; bicubic for brackets (LF images of one pose with different "
                 "exposures); otherwise prefiltered");
  a.settings.AddTo(
      look, "max_images",
      "Maximum number of LF images per frame (all)\n"
      "A frame has the statistic of the rays of N of the LF images that contribute to it, spread "
      "evenly over its lens: more noise, in less time and memory.");
  look.AddChoice("--lf-pixels", a.lf_pixels, {"auto", "areas", "points"},
                 "What LF pixels show, for --filter prefiltered\n"
                 "areas: the mean light of their area, as in photographs\n"
                 "points: the light of their centre, as in renders without anti-aliasing\n"
                 "auto: as lf_pixels of the light field says, otherwise measured");
  look.Add("--max-angle DEGREES", a.max_angle_deg,
           "Largest angle between LF camera and frame axes (no limit)\n"
           "LF cameras whose optical axis is farther from that of the frame are left out.")
      ->check(CLI::Range(0.0, 180.0));
  AddRunning(app, a);
}

bool ThroughArguments::HasPackages() const {
  return std::all_of(paths.begin(), paths.end(), IsPackageName);
}

}  // namespace lf
