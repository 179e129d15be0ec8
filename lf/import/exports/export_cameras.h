// SPDX-License-Identifier: Apache-2.0
// Makes a light field of the cameras that another program exported: the common end of all readers
// in this folder. A reader parses its file into ExportedCameras, without looking at image files,
// and FinishExport() does the rest.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// One image of an export.
struct ExportedImage {
  std::string name;  // as the export states it, with folders; the extension may be missing
  // With width_px and height_px of 0 if the export does not state the size.
  Intrinsics intrinsics;
  RigidTransform cam_from_world;  // camera axes: x right, y down, z forward
};

// Which image files state the sizes that an export does not state.
enum class SizesFrom {
  kFirstImage,  // all images have the size of the first one that is found
  kEachImage,   // each image has its own size; missing files count as the first that is found
};

// The cameras of an export, before image files are looked at.
struct ExportedCameras {
  std::vector<ExportedImage> images;
  std::filesystem::path folder;  // the names of the images are relative to it; empty: "."
  std::optional<DepthRange> depth_range;
  double unit_m = 1;  // metres per world unit
  // The next three describe images whose size is not stated.
  SizesFrom sizes_from = SizesFrom::kFirstImage;
  bool counts_from_middle = false;  // their cx_px and cy_px are offsets from the image's middle
  bool in_larger_sides = false;     // their lengths are shares of the image's larger side
};

// The options of a reader.
struct ExportOptions {
  // Folder in which image files are searched by name (FindImageFiles()).
  std::optional<std::filesystem::path> images_folder = {};
  // Focal length of all cameras in pixels, for forms that do not state it
  // (ExportForm::takes_focal).
  std::optional<double> focal_px = {};
  // The source of the sizes that the export does not state. Fuzz targets and unit tests replace it.
  ImageSizeSource image_size = ImageSizeInHeader;
};

// Returns a light field with the images in their order, distinct intrinsics, the folder, the depth
// range and DefaultMaxRadiance() of the names. If a size or the extension of a name is not stated,
// the image files are found by FindImageFiles(), which changes names and folder. Sizes are read by
// options.image_size.
//   file  for messages
// kInput names the file, the image and the value: no images, or more than kMaxImageCount; a name
// that is empty, longer than 4096 bytes, holds a NUL character or occurs twice; a focal length
// outside 0.001 to 1e7 px; a principal point or skew outside +-1e7 px; a size outside 1 to 65536,
// or of more than 2^30 pixels; a distortion that is not finite or not one (IsDistortion()); a
// camera beyond kLargest_w; a size that is not stated if no image file is found.
Result<LightField> FinishExport(ExportedCameras cameras, const std::filesystem::path& file,
                                const ExportOptions& options);

// Parses the text of an export, without looking at image files.
//   file  for messages; its folder, or one near it, becomes ExportedCameras::folder
using ParseExport = Result<ExportedCameras> (*)(std::string_view text,
                                                const std::filesystem::path& file);

// Reads a file of at most kMostExportBytes, and finishes what `parse` returns.
inline constexpr size_t kMostExportBytes = size_t{2} << 30;
Result<LightField> ReadExport(const std::filesystem::path& file, const ExportOptions& options,
                              ParseExport parse);

// Returns the first of the folders in which one of up to 64 of the images lies under its name;
// `otherwise` if none does.
std::filesystem::path FolderWithImages(const std::vector<ExportedImage>& images,
                                       const std::vector<std::filesystem::path>& folders,
                                       const std::filesystem::path& otherwise);
// Returns the folder in which a file or folder lies: "." for a name without a folder.
std::filesystem::path FolderAbove(const std::filesystem::path& path);

// Logs how many of the images of an export have a pose, unless all have one.
void LogPosedCount(const std::filesystem::path& file, size_t posed_count, size_t image_count);

// Returns a distortion with the parameters in the order of the model. The model kRadialTangential
// without distortion becomes kNone.
Distortion DistortionOf(DistortionModel model, const DistortionParameters& parameters);

// Returns the pose of a camera at `centre`: x_cam = rotation (x_world - centre).
inline RigidTransform PoseAt(const Mat3& cam_from_world_rotation, const Vec3& centre) {
  return {cam_from_world_rotation, -(cam_from_world_rotation * centre)};
}

// The following functions make rotations of what exports state. Their messages of kInput do not
// name the place in the file; the caller adds it. All of them end in NearestRotation().

// Deviation from right angles and unit length that is accepted in rotation matrices of exports.
inline constexpr double kExportRotationTolerance = 1e-3;

// kInput if the length of the quaternion is not within 1 % of 1.
Result<Mat3> RotationOfQuaternion(double w, double x, double y, double z);
// Turns by |axis_angle| radians about the axis. kInput for numbers that are not finite, or an angle
// above 1e3.
Result<Mat3> RotationOfAxisAngle(const Vec3& axis_angle);
// Reads nine numbers row by row.
Result<Mat3> RotationOfRows(const std::vector<double>& numbers);

// Reads the calibration matrix fx skew cx, 0 fy cy, 0 0 1, row by row, without width and height.
// nullopt if the other four numbers differ.
std::optional<Intrinsics> IntrinsicsOfRows(const std::vector<double>& numbers);

// Axes of OpenGL, x right, y up, z backwards, in camera axes of the library: diag(1, -1, -1).
// cam_from_world = kFromOpenGl * opengl_from_world.
inline Mat3 CameraFromOpenGl() { return Vec3(1, -1, -1).asDiagonal(); }

}  // namespace lf
