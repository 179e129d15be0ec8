// SPDX-License-Identifier: Apache-2.0
// The command line of lfrenderer, of which `lffocus stack` has a part.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/frame_options.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"
#include "tools/common/setting_options.h"

#include "lf/core/result.h"
#include "lf/render/pipeline/render.h"

namespace lf {

struct RenderArguments {
  std::vector<std::string> inputs;  // the words LIGHTFIELD PATH, or PACKAGE...
  LightFieldArgument light_field;   // its options; its `path` is the value of --lightfield
  std::string output, video, memory = "8G", format = "exr", rectangles = "on", dump_every = "30s",
                             shard, finish, cache;
  SettingOptions settings;
  FrameRangeArguments frames;
  PictureArguments picture;
  AllowMissing allow_missing;
  bool densify = false, no_guard = false, no_contact_sheet = false, resume = false,
       overwrite = false, keep_plates = false;

  void AddTo(CLI::App& app);
  // Adds only the options that decide pictures, memory and checkpoints, for a program that renders
  // frames of its own: not those of the inputs and the outputs, nor --resume, --overwrite, --finish
  // and --shard.
  void AddRenderingTo(CLI::App& app);
  // Returns the common options of lfrenderer.
  static OfferedOptions Common();

  // Returns true if all inputs are packages: files that end in .lfp.
  bool HasPackages() const;
  // Must be called before MakeOptions(). kUsage if the inputs are neither LIGHTFIELD PATH nor
  // packages, if --allow-missing cannot be parsed, or if an option cannot be used with these
  // inputs.
  //   seed_given  true if --seed is given; packages contain a seed of their own
  Result<void> Check(bool seed_given) const;

  // Converts the arguments to options. If --clamp-frames leaves out all frames, which
  // HasNoFrame() tells, they must not be used, because they would mean all frames.
  //   all  frames of the film
  Result<RenderOptions> MakeOptions(const CommonOptions& common, const FrameNumbers& all) const;
  bool HasNoFrame(const RenderOptions& options) const { return frames.IsNone(options.frames); }

 private:
  Result<FilmSettings> MakeFilm(uint64_t seed) const;
  Result<FolderOptions> MakeFolder(const FrameNumbers& all) const;
};

}  // namespace lf
