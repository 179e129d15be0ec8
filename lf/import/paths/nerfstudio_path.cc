// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/nerfstudio_path.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/import/paths/json_list.h"
#include "lf/import/paths/lf_camera_keys.h"
#include "lf/light_field/model/rotation.h"
#include "lf/light_field/transforms_json/opengl_pose.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kListKey = "camera_path";
constexpr const char* kDataparserName = "dataparser_transforms.json";
constexpr const char* kTopKeys[] = {"lf_space", "lf_unit_m", "lf_views", "lf_first_frame"};
constexpr double kTransformTolerance = 1e-3;  // tolerance for rotations; files may have few digits

constexpr NumberRule kAnyNumber = {"from -1e12 to 1e12",
                                   [](double x) { return std::abs(x) <= 1e12; }};
constexpr NumberRule kSide = {"a whole number of pixels from 1 to 65536", [](double x) {
                                return x >= 1 && x <= kLargestPlateSide_px && x == std::floor(x);
                              }};
constexpr NumberRule kRate = {"frames per second from 0.001 to 1e6",
                              [](double x) { return x >= 1e-3 && x <= 1e6; }};
constexpr NumberRule kSeconds = {"seconds above 0, at most 1e9",
                                 [](double x) { return x > 0 && x <= 1e9; }};
constexpr NumberRule kMetres = {"metres per world unit, from 1e-9 to 1e9",
                                [](double x) { return x >= 1e-9 && x <= 1e9; }};
constexpr NumberRule kScale = {"a factor from 1e-9 to 1e9",
                               [](double x) { return x >= 1e-9 && x <= 1e9; }};

Result<ForeignCamera> CameraOfFrame(const JsonFields& frame,
                                    const std::array<int, 2>& resolution_px,
                                    const PathOptions& options, ForeignPath* path) {
  LF_RETURN_IF_ERROR(frame.CheckLfKeys(kLfCameraKeys, kTopKeys, "to the top level"));
  LF_ASSIGN_OR_RETURN(const RigidTransform pose, PoseOfMatrix(frame, "camera_to_world"));
  const NumberRule rule = FovRule(options);
  LF_ASSIGN_OR_RETURN(const std::optional<double> fov, frame.Number("fov", rule));
  if (!fov) return frame.Wrong("fov", rule.expected);
  ForeignCamera camera;
  camera.pinhole = {IntrinsicsOfFov(FovDeg(*fov, options, path), resolution_px), pose};
  LF_RETURN_IF_ERROR(ReadLfCameraKeys(frame, &camera));
  return camera;
}

Result<void> CheckCameraType(const JsonFields& top) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> type, top.Text("camera_type"));
  if (!type || *type == "perspective") return {};
  return top.Wrong(
      "camera_type",
      "\"perspective\", because a thin lens gives no other view; choose Perspective in "
      "nerfstudio's viewer, and save the path again");
}

Result<std::array<int, 2>> ResolutionOf(const JsonFields& top) {
  std::array<int, 2> resolution_px = {};
  size_t i = 0;
  for (const char* key : {"render_width", "render_height"}) {
    LF_ASSIGN_OR_RETURN(const std::optional<double> side, top.Number(key, kSide));
    if (!side) return top.Wrong(key, kSide.expected);
    resolution_px[i++] = static_cast<int>(*side);
  }
  if (static_cast<long long>(resolution_px[0]) * resolution_px[1] > kMostPlateElements)
    return top.Fault(fmt::format("{} x {} are more than {} elements: expected a smaller resolution",
                                 resolution_px[0], resolution_px[1], kMostPlateElements));
  return resolution_px;
}

// Returns the frame rate: "fps" or, if it is missing, the one that fits "seconds".
Result<double> RateOf(const JsonFields& top, const PathOptions& options, ForeignPath* path) {
  LF_ASSIGN_OR_RETURN(const std::optional<double> fps, top.Number("fps", kRate));
  if (fps) return *fps;
  LF_ASSIGN_OR_RETURN(const std::optional<double> seconds, top.Number("seconds", kSeconds));
  if (!seconds) return FpsOr(options, path);
  const double rate = static_cast<double>(top.ListSize(kListKey).value_or(0)) / *seconds;
  if (!kRate.holds(rate)) return top.Wrong("seconds", "a duration that fits the frames");
  return rate;
}

Result<bool> IsWorld(const JsonFields& top) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> space, top.Text("lf_space"));
  if (space && *space != "world" && *space != "trained")
    return top.Wrong("lf_space", "\"world\" or \"trained\"");
  return space && *space == "world";
}

// Returns the similarity of the poses that `light_field` states from those that they were made of:
// applied_transform and applied_scale of a transforms.json; the identity if there is none.
Result<Similarity> SavedFromOriginal(const fs::path& light_field, double* applied_scale) {
  std::error_code error;
  fs::path file = light_field;
  if (fs::is_directory(file, error)) file /= "transforms.json";
  if (file.extension() != ".json" || !fs::exists(file, error)) return Similarity();
  JsonObject object;
  LF_RETURN_IF_ERROR(ReadTopLevel(file, "frames", &object));
  const JsonFields top(object, file);
  LF_ASSIGN_OR_RETURN(const std::optional<double> scale, top.Number("applied_scale", kScale));
  *applied_scale = scale.value_or(1);
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> matrix,
                      top.Matrix("applied_transform", 3, 3, 4, kAnyNumber));
  if (!matrix) return Similarity();
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows(matrix->data());
  const Result<Mat3> rotation = NearestRotation(rows.leftCols<3>(), kTransformTolerance);
  if (!rotation) return top.Fault("\"applied_transform\" " + rotation.error().message);
  return Similarity{1, *rotation, rows.col(3)};
}

Similarity Composed(const Similarity& c_from_b, const Similarity& b_from_a) {
  return {c_from_b.scale * b_from_a.scale, c_from_b.rotation * b_from_a.rotation,
          c_from_b.scale * (c_from_b.rotation * b_from_a.translation) + c_from_b.translation};
}

}  // namespace

Result<RigidTransform> PoseOfMatrix(const JsonFields& frame, const char* key) {
  const size_t size = frame.ListSize(key).value_or(16);
  const bool has_rows = size == 3 || size == 4;
  const size_t count = size == 12 ? 12 : 16;
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> numbers,
                      has_rows ? frame.Matrix(key, 3, 4, 4, kAnyNumber)
                               : frame.Numbers(key, count, count, kAnyNumber));
  if (!numbers)
    return frame.Wrong(key,
                       "16 numbers, the rows of the 4x4 camera-to-world matrix, or a list of its "
                       "rows");
  if (numbers->size() == 16) {
    const Eigen::RowVector4d last(numbers->data() + 12);
    if (last != Eigen::RowVector4d(0, 0, 0, 1))
      return frame.Fault(
          fmt::format("\"{}\" has the last row {}, {}, {}, {}: expected 0, 0, 0, 1; is the matrix "
                      "column-major?",
                      key, last[0], last[1], last[2], last[3]));
  }
  const Result<RigidTransform> pose =
      CamFromWorldOfOpenGl(Eigen::Matrix<double, 3, 4, Eigen::RowMajor>(numbers->data()));
  if (!pose) return frame.Fault(fmt::format("\"{}\" {}", key, pose.error().message));
  return pose;
}

Result<void> UndoTraining(const fs::path& file, const PathOptions& options, bool is_world,
                          ForeignPath* path) {
  std::error_code error;
  fs::path dataparser = options.dataparser_transforms;
  if (is_world && !dataparser.empty())
    return UsageError(fmt::format(
        "{{dataparser_transforms {}}}: {} states that its cameras are in the world of the "
        "light field (lf_space): leave the option out",
        dataparser.string(), file.string()));
  if (is_world) return {};
  if (dataparser.empty()) {
    dataparser = file.parent_path() / kDataparserName;
    if (!fs::exists(dataparser, error)) {
      path->lacks.push_back(
          fmt::format("nothing about the space in which nerfstudio trained (the world of the light "
                      "field is assumed: put {} beside the path, or {{dataparser_transforms}})",
                      kDataparserName));
      return {};
    }
  }
  LF_ASSIGN_OR_RETURN(const Similarity world_from_trained,
                      WorldFromTrained(dataparser, options.light_field));
  for (ForeignCamera& camera : path->cameras) MoveInto(world_from_trained, &camera);
  LogInfo("{}: the cameras are moved from the trained space to the world by {}", file.string(),
          dataparser.string());
  return {};
}

Result<ForeignPath> ParseNerfstudioPath(std::string_view text, const fs::path& file,
                                        const PathOptions& options, bool* is_world) {
  ForeignPath path;
  std::array<int, 2> resolution_px = {};
  const auto read_top = [&](const JsonFields& top) -> Result<void> {
    LF_RETURN_IF_ERROR(CheckCameraType(top));
    LF_RETURN_IF_ERROR(top.CheckLfKeys(kTopKeys, kLfCameraKeys, "into each frame"));
    LF_ASSIGN_OR_RETURN(resolution_px, ResolutionOf(top));
    LF_ASSIGN_OR_RETURN(path.fps, RateOf(top, options, &path));
    LF_ASSIGN_OR_RETURN(path.unit_m, top.Number("lf_unit_m", kMetres));
    LF_ASSIGN_OR_RETURN(path.views, ViewsOfKey(top));
    LF_ASSIGN_OR_RETURN(path.first_frame, FirstFrameOfKey(top));
    LF_ASSIGN_OR_RETURN(*is_world, IsWorld(top));
    return {};
  };
  bool states_intrinsics = false;
  const auto read_frame = [&](const JsonFields& frame) -> Result<void> {
    LF_ASSIGN_OR_RETURN(const ForeignCamera camera,
                        CameraOfFrame(frame, resolution_px, options, &path));
    states_intrinsics = states_intrinsics || frame.Has(kLfIntrinsicsKey);
    path.cameras.push_back(camera);
    return {};
  };
  LF_RETURN_IF_ERROR(ReadJsonList(text, file, kListKey, read_top, read_frame));
  if (states_intrinsics) path.largest_fov = std::nullopt;
  return path;
}

Result<ForeignPath> ReadNerfstudioPath(const fs::path& file, const PathOptions& options) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMaxPathBytes));
  bool is_world = false;
  LF_ASSIGN_OR_RETURN(ForeignPath path, ParseNerfstudioPath(text, file, options, &is_world));
  LF_RETURN_IF_ERROR(UndoTraining(file, options, is_world, &path));
  return path;
}

Result<Similarity> TrainedFromOriginal(const JsonFields& top) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> matrix,
                      top.Matrix("transform", 3, 3, 4, kAnyNumber));
  LF_ASSIGN_OR_RETURN(const std::optional<double> scale, top.Number("scale", kScale));
  if (!matrix)
    return top.Wrong("transform", "the transform of the dataparser, 3 lists of 4 numbers");
  if (!scale) return top.Wrong("scale", kScale.expected);
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> rows(matrix->data());
  const Result<Mat3> rotation = NearestRotation(rows.leftCols<3>(), kTransformTolerance);
  if (!rotation) return top.Fault("\"transform\" " + rotation.error().message);
  return Similarity{*scale, *rotation, *scale * rows.col(3)};
}

Result<Similarity> WorldFromTrained(const fs::path& dataparser, const fs::path& light_field) {
  JsonObject object;
  LF_RETURN_IF_ERROR(ReadTopLevel(dataparser, "", &object));
  LF_ASSIGN_OR_RETURN(Similarity trained_from_original,
                      TrainedFromOriginal(JsonFields(object, dataparser)));
  double applied_scale = 1;
  LF_ASSIGN_OR_RETURN(const Similarity saved_from_original,
                      SavedFromOriginal(light_field, &applied_scale));
  // The scale includes applied_scale, by which the saved poses were scaled already.
  trained_from_original.scale /= applied_scale;
  trained_from_original.translation /= applied_scale;
  return Composed(saved_from_original, InverseOf(trained_from_original));
}

}  // namespace lf
