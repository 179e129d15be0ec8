// SPDX-License-Identifier: Apache-2.0
// Opens any supported calibration as a LightField: all programs open their LIGHTFIELD with it.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "lf/core/result.h"
#include "lf/core/shell_word.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

enum class PictureLayout;  // import/formats/picture_grid.h

struct OpenOptions {
  // focal_px to flip_y complete or override what the file names in a folder with Stanford names say
  // (StanfordOptions, import/formats/read_stanford.h), and focal_px also trajectories of TUM's form
  // (import/exports/read_tum.h). If one of them is set, opening a calibration of another kind
  // returns kUsage. Several programs have an option for focal_px; only lfimport has
  // options for the others.
  std::optional<double> focal_px = {};
  std::optional<Vec2> pitch_w = {};
  std::optional<std::array<int, 2>> grid = {};
  bool is_serpentine = false;
  std::optional<PictureLayout> layout = {};  // how one picture holds the views
  std::optional<double> plane_distance_w = {};
  bool flip_x = false;
  bool flip_y = false;
  // The field of view of all cameras across both width and height, required for poses of Airborne
  // Optical Sectioning (import/formats/read_aos.h). If it is set, opening a calibration of another
  // kind returns kUsage.
  std::optional<double> fov_deg = {};
  // Folder in which image files are searched by name (light_field/model/find_images.h). kUsage for
  // packed stores and folders with Stanford names.
  std::optional<std::filesystem::path> images_folder = {};
  // Folder of masks, which are found by the names of the images (light_field/model/masks_beside.h)
  // and replace those that the calibration names. Only lfimport offers it. kUsage for packed
  // stores.
  std::optional<std::filesystem::path> masks_folder = {};
  // For light field videos (doc/formats/light_field_video.md): the recording time that is shown, in
  // seconds from the first frame; in a transforms.json, in units of its key "time". kUsage for
  // other light fields.
  std::optional<double> time = {};
  // The recording times that the frames of a path show, if `time` is not set: the slices of all of
  // them are opened (import/paths/recording_times.h).
  std::vector<double> path_times = {};
  // If true and neither `time` nor `path_times` is set, the first time is opened: for programs that
  // need no LF images.
  bool takes_any_time = false;
  // Frames per second of folders of frames, which do not state it; unset: 30.
  std::optional<double> recorded_fps = {};
  // Folder into which frames of videos are decoded, from which nothing is removed; unset: beside
  // the light field (import/video/video_frames.h).
  std::optional<std::filesystem::path> frame_cache = {};
  // Repeats the running call in the question for a time; unset: the question names the option
  // alone.
  CallAgain call_again = {};
  // How much the size of image files may differ from the calibrated size.
  ImageScale image_scale = {};
  // LF images are loaded at 1/reduce of their width and height: 1, 2, 4 or 8
  // (light_field/model/reduction.h). kUsage for densified packed stores.
  int reduce = 1;
  // alpha, background and keeps_opacity state the meaning of alpha and the background, and override
  // the calibration (light_field/model/radiance.h). kUsage: a packed store that was encoded for the
  // other kind of alpha (mask or light); a background that is brighter than max_radiance, or for
  // images whose alpha is a mask; opacity of mosaics.
  std::optional<AlphaMeaning> alpha = {};
  std::optional<std::array<double, 3>> background = {};
  bool keeps_opacity = false;  // needs a black background; see RadianceEncoding::keeps_opacity
  // If true, the transforms.json in a folder is ignored if HoldsOwnAndItsSource() is true. Only
  // lfimport sets this, when it writes that file again.
  bool passes_over_own = false;
  // StanfordOptions::import_again. Only lfimport sets it.
  CallAgain import_again = {};
  // Bayer pattern of the images; overrides the calibration and the files. Only lfimport offers it.
  // kUsage for packed stores.
  std::optional<BayerPattern> bayer = {};
};

// Returns true if the folder holds a light field in one of the forms that OpenLightField() finds
// there. Its files may be damaged.
bool HoldsLightField(const std::filesystem::path& folder);

// Returns true if the folder holds both a transforms.json that lfimport wrote and nobody changed,
// and a calibration of another form, from which it may have been made.
//   has_grid  true: images of any names are such a calibration, because OpenOptions::grid orders
//   them
bool HoldsOwnAndItsSource(const std::filesystem::path& folder, bool has_grid = false);

// Opens a calibration file, or the first of these that it finds in a folder:
// - transforms.json, or any .json file without M3x4 matrices:
//   light_field/transforms_json/transforms_json.h
// - a COLMAP model, in the folder, its sparse/0 or below: light_field/colmap/read_colmap.h
// - NAME_par.txt: import/formats/read_middlebury.h
// - poses_bounds.npy, or any .npy file of two dimensions: import/formats/read_llff.h
// - poses_bounds.npy or models.json beside videos, or folders of frames, of the cameras
//   (import/formats/open_video.h): a light field video. If image files of the calibration are there
//   as well, they are opened unless a time is given
// - parameters.cfg, or any .cfg file: import/formats/read_hci.h
// - poses.json, or any .json file with M3x4 matrices: import/formats/read_aos.h
// - transforms_train.json, transforms_val.json and transforms_test.json: their union
// - images with Stanford names, in the folder or its images/: import/formats/read_stanford.h
// - a .npy file of four or five dimensions, or an HDF5 file, also as the only one in a folder:
//   pixels/files/view_array.h, import/formats/hci_archive.h
// - a picture that holds the views of a grid of cameras, or a folder with one picture whose name
// says
//   so: import/formats/picture_grid.h
// - STORE.lfs: storage/packed/packed_store_file.h
// - the exports of other programs, in the order of import/exports/export_table.cc, which tells them
//   by their names and the words in them
// A folder with Stanford names that lack a part of the calibration is opened by an export in it, if
// there is one and no option states what the names lack. A .json file that is given itself is
// opened as an export before it is taken for a transforms.json of another name. A file of a kind
// named after "or any" is opened only if `path` is the file itself. If the first kind that is found
// in a folder is NAME_par.txt or STORE.lfs, two such files are an error. An incomplete COLMAP model
// is an error unless another calibration file is there, which is then taken with a warning. If no
// image file of a transforms.json is there, a warning names another calibration in its folder.
//
// If image files are not where the calibration says, they are searched by name in its folder or in
// OpenOptions::images_folder; not every file is checked for existence. If the headers of up to 64
// files show that all images are smaller than calibrated by the same whole factor, intrinsics are
// scaled (light_field/model/find_images.h). If neither options nor calibration state the meaning of
// alpha, it is derived from the pixels of up to three images (light_field/model/alpha_evidence.h)
// and logged. For camera raw files, pattern, levels and colours that the calibration does not state
// are read from the first file; a warning names what this file does not state either. kInput: there
// is no light field (the message lists what was searched for, and advises how to export files that
// only other programs read); an error of the reader;
// images_folder has none of the images; masks_folder has none of the masks; camera raw files with
// an unknown Bayer pattern. A packed store by resolution that lacks its finest parts is opened as a
// light field of smaller LF images, with a warning. kUsage: an option that the calibration does not
// allow; a light field video without a time. kOutput: frames of a video cannot be decoded.
Result<LightField> OpenLightField(const std::filesystem::path& path,
                                  const OpenOptions& options = {});

// Returns at most 2048 points of the scene, in world coordinates, that the image of LF camera `id`
// shows. Only a COLMAP model with a points3D file states such points
// (light_field/colmap/points_seen.h); the result is empty for other light fields. Reads the model
// again, block by block.
//   path, light_field  the argument and the result of OpenLightField()
Result<std::vector<Vec3>> PointsSeenBy(const std::filesystem::path& path,
                                       const LightField& light_field, LfImageId id);

}  // namespace lf
