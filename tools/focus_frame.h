// SPDX-License-Identifier: Apache-2.0
// The frame of PATH whose camera a command of lffocus uses.
#pragma once

#include <cstdint>
#include <string>

#include "tools/common/help.h"

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/import/paths/open_path.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct FrameArgument {
  std::string path;                    // PATH
  std::optional<uint32_t> frame = {};  // unset: the first of the path

  FrameId IdIn(const CameraPath& opened) const {
    return frame ? FrameId{*frame} : opened.frames().At(0);
  }
  // Adds the positional argument PATH, and --frame N.
  void AddTo(OptionGroup& input);
  void AddNumberTo(OptionGroup& input);  // --frame N alone
  // Opens the path for a light field. kUsage: the path has no such frame. Other errors are those of
  // OpenPath().
  //   surface  use of a focal surface that the path may have
  Result<CameraPath> Open(const LightField& light_field,
                          PathOptions::Surface surface = PathOptions::Surface::kRefuse) const;
};

// Refuses a name for a folder that ends as a file of pictures, videos, arrays or texts, such as
// vx.png, unless there is a folder of this name. kUsage.
//   files  names of the files that may be written instead, such as "views.npy"
Result<void> CheckFolderName(const std::string& output, const std::string& files);

}  // namespace lf
