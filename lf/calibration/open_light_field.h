// Any supported calibration as a LightField: every program takes its LIGHTFIELD through this.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "lf/capture/find_images.h"
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
  // The folder of the image files, where they are found by their names (capture/find_images.h).
  // kUsage of folders of the Stanford form and packed stores.
  std::optional<std::filesystem::path> images_folder = {};
  // Image files may have another size than was calibrated.
  ImageScale image_scale = {};
  // These two say what alpha means and what is behind it, and go before the calibration
  // (capture/radiance.h).
  // kUsage: of packed stores, where pixels were coded as the other of mask and light; a background
  // of images whose alpha is a mask, or brighter than max_radiance; opacity of mosaics.
  std::optional<AlphaMeaning> alpha = {};
  std::optional<std::array<double, 3>> background = {};
  bool keeps_opacity = false;  // with a background of black, as RadianceEncoding::keeps_opacity
  // A transforms.json is passed over in a folder that HoldsOwnAndItsSource(). lfimport alone sets
  // this, when it writes that file again.
  bool passes_over_own = false;
  // The images are mosaics of this pattern, whatever the calibration or the files say. Offered by
  // lfimport alone.
  std::optional<BayerPattern> bayer = {};
};

// Returns whether the folder holds a transforms.json that lfimport wrote, unchanged, and what it
// was made from.
bool HoldsOwnAndItsSource(const std::filesystem::path& folder);

// Reads what `path` is: a file, or a folder that holds one, looked for in this order:
// - transforms.json, or any .json file that is no poses.json: native/transforms_json.h
// - a COLMAP model, in the folder or in its sparse/0: colmap/read_colmap.h
// - NAME_par.txt, one in the folder: calibration/read_middlebury.h
// - poses_bounds.npy, or any .npy file: calibration/read_llff.h
// - parameters.cfg, or any .cfg file: calibration/read_hci.h
// - poses.json, or any .json file with M3x4 matrices: calibration/read_aos.h
// - images named by the Stanford form, in the folder or its images/: calibration/read_stanford.h
// - STORE.lfs, one in the folder: packed/packed_store_file.h
//
// Image files that are not where the calibration says are looked for by their
// names, in its folder or in OpenOptions::images_folder; that each of them exists is not checked
// here. The headers of up to 64 tell whether all are smaller than they were calibrated. Where
// nobody says what the alpha of images means, the pixels of three tell (capture/alpha_evidence.h),
// which is logged. Camera raw files: pattern, levels and colours that the calibration does not
// state are those that the first file tells; a warning says what neither does. kInput: nothing
// there that is a light field (the message lists what was looked for), or the reader's own error;
// camera raw files whose Bayer pattern nobody tells.
Result<LightField> OpenLightField(const std::filesystem::path& path,
                                  const OpenOptions& options = {});

// Returns points of the scene that the image of LF camera `id` shows, in world coordinates, at most
// 2048: of a light field that OpenLightField() read from a COLMAP model with a points3D file
// (colmap/points_seen.h). None of any other. The model is read again, a block at a time.
//   path, light_field  what OpenLightField() was given and returned
Result<std::vector<Vec3>> PointsSeenBy(const std::filesystem::path& path,
                                       const LightField& light_field, LfImageId id);

}  // namespace lf
