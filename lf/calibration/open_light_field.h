// Any supported calibration as a LightField: every program takes its LIGHTFIELD through this.
#pragma once

#include <filesystem>
#include <optional>

#include "lf/capture/light_field.h"
#include "lf/core/result.h"

namespace lf {

struct OpenOptions {
  // What folders of the Stanford form may lack: StanfordOptions of calibration/read_stanford.h, and
  // kUsage elsewhere. All but the first are offered by lfimport alone.
  std::optional<double> focal_px = {};
  std::optional<Vec2> pitch_w = {};
  std::optional<double> plane_distance_w = {};
  bool flip_x = false;
  bool flip_y = false;
  // Of all cameras of poses of Airborne Optical Sectioning, which need it (calibration/read_aos.h);
  // elsewhere kUsage.
  std::optional<double> fov_deg = {};
  // Where the image files of a COLMAP model are, not checked (colmap/read_colmap.h), or those of
  // poses of Airborne Optical Sectioning; instead of searching. kUsage elsewhere: others say it.
  std::optional<std::filesystem::path> images_folder = {};
  // The images are mosaics of this pattern, whatever the calibration or the files say. Offered by
  // lfimport alone.
  std::optional<BayerPattern> bayer = {};
};

// Reads what `path` is: a file, or a folder that holds one, looked for in this order:
// - transforms.json, or any .json file that is no poses.json: native/transforms_json.h
// - a COLMAP model, in the folder or in its sparse/0: colmap/read_colmap.h
// - NAME_par.txt, one in the folder: calibration/read_middlebury.h
// - poses_bounds.npy, or any .npy file: calibration/read_llff.h
// - poses.json, or any .json file with M3x4 matrices: calibration/read_aos.h
// - images named by the Stanford form, in the folder or its images/: calibration/read_stanford.h
// - STORE.lfs, one in the folder: packed/packed_store_file.h
//
// No pixels are read; that image files exist is not checked here, but for a first one where its
// header tells the size, or its name the folder. Camera raw files: pattern, levels and colours that
// the calibration does not state are those that the first file tells; a warning says what neither
// does.
// kInput: nothing there that is a light field (the message lists what was looked for), or the
// reader's own error; camera raw files whose Bayer pattern nobody tells.
Result<LightField> OpenLightField(const std::filesystem::path& path,
                                  const OpenOptions& options = {});

}  // namespace lf
