// SPDX-License-Identifier: Apache-2.0
#include "tools/common/light_field_argument.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "tools/common/help.h"
#include "tools/common/interrupt.h"
#include "tools/common/next_step.h"
#include "tools/common/validators.h"

#include "lf/import/paths/recording_times.h"

namespace lf {
namespace {

void AddUnusualOptions(CLI::App& app, LightFieldArgument& argument) {
  OptionGroup unusual(app, "Unusual light fields");
  unusual
      .Add("--focal-px PIXELS", argument.focal_px,
           "Focal length of the LF cameras (as recorded)\n"
           "In pixels of the LF images. Needed if LIGHTFIELD is a folder of images with Stanford "
           "names (doc/formats/stanford.md) that do not contain the focal length, or a trajectory "
           "in "
           "the form of TUM's benchmark (doc/formats/tum.md).")
      ->check(CLI::NonNegativeNumber);
  unusual
      .Add("--fov-deg DEGREES", argument.fov_deg,
           "Field of view of the LF cameras (as recorded)\n"
           "Needed for Airborne Optical Sectioning (AOS), whose pose files do not contain it. AOS "
           "images are square, so that one angle is the field of view of the width and of the "
           "height.")
      ->check(CLI::Range(0., 179.));
  unusual
      .Add("--recorded-fps FPS", argument.recorded_fps,
           "Frames per second of a light field video (30)\n"
           "For folders of frames, which do not state it. Videos state it themselves.")
      ->transform(Rate())
      ->check(CLI::Range(1e-6, 1e6));
  unusual.Add(
      "--frame-cache DIR", argument.frame_cache,
      "Folder for decoded frames of videos (LIGHTFIELD.frames)\n"
      "Frames of videos are decoded into PNG files, which later calls use again. The folder "
      "beside LIGHTFIELD is kept below 16 GiB: frames that were not used for a day are "
      "removed first. Nothing is removed from DIR.");
  unusual.Add(
      "--store-cache DIR", argument.store_cache,
      "Folder for copies of stores on web servers (~/.cache)\n"
      "What is read of a store is kept there for later calls. The folder in ~/.cache, or in "
      "$XDG_CACHE_HOME, is kept below 16 GiB: stores that were not used for a day are removed "
      "first. Nothing is removed from DIR.");
  unusual.Add(
      "--image-scale FACTOR", argument.image_scale,
      "Size of the image files relative to calibration\n"
      "FACTOR: size of the image files divided by the calibrated size, such as 0.25\n"
      "auto: 1, or the factor of 1/2, 1/3, ... 1/16 that fits all files of up to 64 examined "
      "LF images\n"
      "off: the image files must have the calibrated size");
  unusual.AddChoice(
      "--image-alpha", argument.image_alpha, {"auto", "mask", "straight", "premultiplied"},
      "Meaning of the alpha channel\n"
      "auto: as recorded; if nothing is recorded, found from pixels of the images\n"
      "mask: pixels with an alpha below one half are left out\n"
      "straight, premultiplied: alpha is opacity, and the light of --background shines through");
}

}  // namespace

void LightFieldArgument::AddTo(CLI::App& app) {
  OptionGroup input(app, kInputGroup);
  input
      .Add("LIGHTFIELD", path,
           "Calibration file, its folder, or a packed store\n"
           "The calibration is a transforms.json, a calibration of COLMAP, Middlebury, LLFF, "
           "HCI or AOS, or an export of another program, such as Metashape or Meshroom "
           "(doc/inputs.md). A packed store is one file, STORE.lfs, or its URL on a web server, "
           "https://HOST/STORE.lfs (doc/remote_stores.md). A folder of images with "
           "Stanford names is also a light field: the names contain the calibration. lfimport "
           "also opens other folders of images, and pictures that hold many views.")
      ->required()
      ->check(NotEmpty());
  AddOptionsTo(app);
}

void LightFieldArgument::AddOptionsTo(CLI::App& app) {
  OptionGroup input(app, kInputGroup);
  input.Add("--images DIR", images,
            "Folder of the LF images, if they were moved\n"
            "Needed if the image files are not where the calibration says. Each image file is "
            "searched by its name in DIR and all folders below it. The extension of the name, "
            "such as .png, may differ.");
  input
      .Add("--background COLOUR", background,
           "Light behind LF images with alpha\n"
           "Used if the alpha channel of the LF images is opacity (--image-alpha straight or "
           "premultiplied). If the option is not given, the background is the one that the "
           "calibration states; if it states none, the colour of the transparent pixels if the "
           "meaning of alpha was found from them, otherwise black.\n"
           "COLOUR: black, white, or R,G,B in linear light, where 1 is display white\n"
           "none: frames get an alpha channel; their colours are those in front of black")
      ->check(NotEmpty())
      ->default_str("as recorded, else black");
  input.Add("--time T", time,
            "Time that is shown of a light field video (none)\n"
            "In seconds from the first frame; for a transforms.json in the units of its key time. "
            "Each LF camera shows its frame nearest to the nearest recorded time. Needed for light "
            "field videos (doc/formats/light_field_video.md), unless the camera path moves through "
            "time.");
  AddUnusualOptions(app, *this);
}

void LightFieldArgument::AddReduceTo(CLI::App& app) {
  OptionGroup input(app, kInputGroup);
  input
      .Add(
          "--reduce N", reduce,
          "Load LF images at 1/N of their size (1)\n"
          "N is 1, 2, 4 or 8: a pixel is the mean of N x N recorded pixels. For quick films, whose "
          "frames are less sharp. JPEG files and packed stores then take less time to load, and of "
          "a store by resolution (lfcompressor --by-resolution) fewer bytes are read.")
      ->check(CLI::IsMember({1, 2, 4, 8}));
}

Result<void> LightFieldArgument::CheckWithPackages() const {
  if (image_alpha != "auto" || !background.empty())
    return UsageError(
        "--image-alpha and --background cannot be used with packages, which contain the values of "
        "these options that lfpreprocessor was given: leave the options out, or give them to "
        "lfpreprocessor and make the packages again");
  if (!path.empty() || Words().empty()) return {};
  return UsageError(fmt::format(
      "{} cannot be used with packages, which contain the calibration: leave it out; if the LF "
      "images were moved, give their light field with --lightfield",
      Words()[0]));
}

Result<LightField> LightFieldArgument::OpenFor(const std::string& path_file) const {
  const EndsSoon until_open;  // videos may take long to decode
  LF_ASSIGN_OR_RETURN(OpenOptions options, Options());
  options.call_again = CallOfProgram();
  // An error of the path is reported when it is opened, after those of the light field.
  if (Result<std::vector<double>> times = RecordingTimesOf(path_file); times && !time)
    options.path_times = *std::move(times);
  return OpenLightField(path, options);
}

Result<LightField> LightFieldArgument::Open() const {
  const EndsSoon until_open;
  LF_ASSIGN_OR_RETURN(OpenOptions options, Options());
  options.call_again = CallOfProgram();
  return OpenLightField(path, options);
}

}  // namespace lf
