// SPDX-License-Identifier: Apache-2.0
#include "lf/import/agreement/pose_repair.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lf/core/natural_order.h"
#include "lf/core/parse_number.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/light_field/model/keep_images.h"

namespace lf {
namespace {

struct ReadingName {
  PoseReading reading;
  const char *name, *clause;
};
constexpr ReadingName kReadings[] = {
    {PoseReading::kInverse, "inverse",
     "the matrices were inverted (world to camera, camera to world)"},
    {PoseReading::kTranspose, "transpose", "the rotations were transposed"},
    {PoseReading::kTransposeOpenGl, "transpose-opengl",
     "the rotations of the camera-to-world matrices were transposed"},
    {PoseReading::kTransposeRotation, "transpose-rotation",
     "the rotations were transposed and the translations kept"},
    {PoseReading::kCentre, "centre", "the translations were taken as the positions of the cameras"},
    {PoseReading::kTranslation, "translation", "the positions were taken as translations"},
};

struct OrderName {
  NameOrder order;
  const char *name, *clause;
};
constexpr OrderName kOrders[] = {
    {NameOrder::kNext, "names+1", "each image had the pose recorded for the next name"},
    {NameOrder::kPrevious, "names-1", "each image had the pose recorded for the name before"},
    {NameOrder::kReversed, "names-reversed", "the images were in the reverse order of their names"},
    {NameOrder::kFromText, "names-from-text",
     "the poses belonged to names sorted as text (1, 10, 2) instead of by number (1, 2, 10)"},
    {NameOrder::kToText, "names-to-text",
     "the poses belonged to names sorted by number (1, 2, 10) instead of as text (1, 10, 2)"},
};

Mat3 MatrixOf(const Axes& axes) {
  Mat3 matrix = Mat3::Zero();
  for (int row = 0; row < 3; ++row) {
    const int axis = axes[static_cast<size_t>(row)];
    matrix(row, std::abs(axis) - 1) = axis < 0 ? -1 : 1;
  }
  return matrix;
}

std::string TextOf(const Axes& axes) {
  std::string text;
  for (const int axis : axes) {
    if (axis < 0) text += '-';
    text += "xyz"[std::abs(axis) - 1];
  }
  return text;
}

std::optional<Axes> ParseAxes(std::string_view text) {
  Axes axes = {};
  std::array<bool, 3> used = {};
  for (int& axis : axes) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    if (text.empty() || text[0] < 'x' || text[0] > 'z') return std::nullopt;
    const auto index = static_cast<size_t>(text[0] - 'x');
    if (used[index]) return std::nullopt;
    used[index] = true;
    axis = (negative ? -1 : 1) * static_cast<int>(index + 1);
    text.remove_prefix(1);
  }
  return text.empty() ? std::optional(axes) : std::nullopt;
}

// Returns true if the axes form a right-handed frame.
bool IsRightHanded(const Axes& axes) { return MatrixOf(axes).determinant() > 0; }

std::vector<Axes> AllAxes() {
  std::vector<Axes> all;
  std::array<int, 3> order = {1, 2, 3};
  do {
    for (int signs = 0; signs < 8; ++signs)
      all.push_back({(signs & 1) ? -order[0] : order[0], (signs & 2) ? -order[1] : order[1],
                     (signs & 4) ? -order[2] : order[2]});
  } while (std::next_permutation(order.begin(), order.end()));
  return all;
}

RigidTransform ReadAs(PoseReading reading, const RigidTransform& pose) {
  const Mat3& r = pose.rotation;
  const Vec3& t = pose.translation;
  const Vec3 centre = -(r.transpose() * t);
  const auto at = [](const Mat3& rotation, const Vec3& c) {
    return RigidTransform{rotation, -(rotation * c)};
  };
  const Mat3 d = MatrixOf({1, -2, -3});
  switch (reading) {
    case PoseReading::kAsRecorded:
      return pose;
    case PoseReading::kInverse:
      return pose.Inverse();
    case PoseReading::kTranspose:
      return at(r.transpose(), centre);
    case PoseReading::kTransposeOpenGl:
      return at(d * r.transpose() * d, centre);
    case PoseReading::kTransposeRotation:
      return {r.transpose(), t};
    case PoseReading::kCentre:
      return at(r, t);
    case PoseReading::kTranslation:
      return {r, centre};
  }
  LF_CHECK(false);
}

template <class Less>
std::vector<uint32_t> SortedBy(const std::vector<std::string>& names, const Less& less) {
  std::vector<uint32_t> order(names.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return less(names[a], names[b]); });
  return order;
}

// Multiplies focal lengths. A focal length as a share of the width, in millimetres, or of images of
// another size comes with a principal point in the same unit or in pixels. One that lies beside the
// image, or nearly so, is multiplied if that brings it near the middle, otherwise replaced by the
// middle. Rectified slabs have such principal points by right.
void MultiplyFocalLengths(const std::array<double, 2>& factors, bool is_rectified, Intrinsics* k) {
  if (factors == std::array<double, 2>{1, 1}) return;
  k->fx_px *= factors[0];
  k->fy_px *= factors[1];
  k->skew_px *= factors[0];
  const auto is_beside = [](double position, int size) {
    return position <= 0.1 * size || position >= 0.9 * size;
  };
  if (is_rectified || !(is_beside(k->cx_px, k->width_px) || is_beside(k->cy_px, k->height_px)))
    return;
  const auto moved = [](double position, double factor, int size) {
    const double result = position * factor;
    return result > 0.4 * size && result < 0.6 * size ? result : size / 2.0;
  };
  k->cx_px = moved(k->cx_px, factors[0], k->width_px);
  k->cy_px = moved(k->cy_px, factors[1], k->height_px);
}

Result<void> AddWord(std::string_view word, Repair* repair) {
  for (const ReadingName& one : kReadings)
    if (word == one.name) return repair->reading = one.reading, Result<void>();
  for (const OrderName& one : kOrders)
    if (word == one.name) return repair->names = one.order, Result<void>();
  if (word == "mirror-x") return repair->mirror_x = true, Result<void>();
  if (word == "mirror-y") return repair->mirror_y = true, Result<void>();
  if (word == "swap-principal-point") return repair->swap_principal_point = true, Result<void>();
  const std::string_view value = word.substr(std::min(word.size(), word.find(':') + 1));
  if (word.starts_with("focal:")) {
    const size_t cross = value.find('x');
    const auto x = ParseNumber(value.substr(0, cross));
    const auto y = cross == std::string_view::npos ? x : ParseNumber(value.substr(cross + 1));
    if (x && y && std::min(*x, *y) >= 1e-6 && std::max(*x, *y) <= 1e6)
      return repair->focal_factors = {*x, *y}, Result<void>();
  }
  if (const std::optional<Axes> axes = ParseAxes(value)) {
    if (word.starts_with("axes:") && IsRightHanded(*axes))
      return repair->camera_axes = *axes, Result<void>();
    if (word.starts_with("positions:")) return repair->position_axes = *axes, Result<void>();
  }
  std::vector<std::string_view> words;
  for (const ReadingName& one : kReadings) words.push_back(one.name);
  for (const OrderName& one : kOrders) words.push_back(one.name);
  return UsageError(fmt::format(
      "{{repair {}}}: expected words separated by commas: {}, mirror-x, mirror-y, axes:AXES (such "
      "as "
      "axes:x-y-z, right-handed), positions:AXES (such as positions:xz-y), focal:FACTOR (1e-6 to "
      "1e6), swap-principal-point",
      word, fmt::join(words, ", ")));
}

}  // namespace

Result<Repair> ParseRepair(std::string_view text) {
  Repair repair;
  while (!text.empty()) {
    const size_t comma = std::min(text.size(), text.find(','));
    LF_RETURN_IF_ERROR(AddWord(text.substr(0, comma), &repair));
    text.remove_prefix(std::min(text.size(), comma + 1));
  }
  return repair;
}

std::string NameOf(const Repair& repair) {
  std::vector<std::string> words;
  for (const OrderName& one : kOrders)
    if (one.order == repair.names) words.push_back(one.name);
  for (const ReadingName& one : kReadings)
    if (one.reading == repair.reading) words.push_back(one.name);
  if (repair.camera_axes != kSameAxes) words.push_back("axes:" + TextOf(repair.camera_axes));
  if (repair.position_axes != kSameAxes)
    words.push_back("positions:" + TextOf(repair.position_axes));
  if (repair.mirror_x) words.push_back("mirror-x");
  if (repair.mirror_y) words.push_back("mirror-y");
  const auto [fx, fy] = repair.focal_factors;
  if (fx != 1 || fy != 1)
    words.push_back(fx == fy ? fmt::format("focal:{}", fx) : fmt::format("focal:{}x{}", fx, fy));
  if (repair.swap_principal_point) words.push_back("swap-principal-point");
  return fmt::format("{}", fmt::join(words, ","));
}

std::string ClauseOf(const Repair& repair) {
  std::vector<std::string> clauses;
  for (const OrderName& one : kOrders)
    if (one.order == repair.names) clauses.push_back(one.clause);
  for (const ReadingName& one : kReadings)
    if (one.reading == repair.reading) clauses.push_back(one.clause);
  if (repair.camera_axes == Axes{1, -2, -3})
    clauses.push_back("the cameras' y and z axes were negated (OpenCV, OpenGL)");
  else if (repair.camera_axes == Axes{-1, -2, 3})
    clauses.push_back("the images were turned by 180 degrees");
  else if (repair.camera_axes == Axes{2, -1, 3} || repair.camera_axes == Axes{-2, 1, 3})
    clauses.push_back("the images were turned by 90 degrees");
  else if (repair.camera_axes != kSameAxes)
    clauses.push_back(
        fmt::format("the cameras' right, down and forward axes were {} of the recorded ones",
                    TextOf(repair.camera_axes)));
  if (repair.position_axes != kSameAxes)
    clauses.push_back(
        fmt::format("the x, y and z of the positions were {}", TextOf(repair.position_axes)));
  if (repair.mirror_x)
    clauses.push_back(
        "the images or the x axis of the world were mirrored, or columns counted from the right");
  if (repair.mirror_y)
    clauses.push_back("the images were mirrored upside down, or rows counted from the other end");
  const auto [fx, fy] = repair.focal_factors;
  if (fx != 1 || fy != 1)
    clauses.push_back(fx == fy
                          ? fmt::format("the focal lengths were {:.4g} times as long", fx)
                          : fmt::format("the focal lengths were {:.4g} times as long along x, and "
                                        "{:.4g} times along y",
                                        fx, fy));
  if (repair.swap_principal_point) clauses.push_back("cx and cy were exchanged");
  return fmt::format("{}", fmt::join(clauses, ", and "));
}

PinholeCamera RepairedCamera(const Repair& repair, PinholeCamera camera, bool is_rectified) {
  Intrinsics& k = camera.intrinsics;
  RigidTransform pose = ReadAs(repair.reading, camera.cam_from_world);
  pose = RigidTransform{MatrixOf(repair.camera_axes), Vec3::Zero()} * pose;
  if (repair.position_axes != kSameAxes) {
    const Mat3 axes = MatrixOf(repair.position_axes);
    pose.translation = -(pose.rotation * (axes * pose.Inverse().translation));
    if (is_rectified && std::abs(repair.position_axes[2]) == 3) {
      const Vec2 middle(k.width_px / 2.0, k.height_px / 2.0);
      const Vec2 moved = axes.topLeftCorner<2, 2>() * (Vec2(k.cx_px, k.cy_px) - middle) + middle;
      k.cx_px = moved.x();
      k.cy_px = moved.y();
    }
  }
  MultiplyFocalLengths(repair.focal_factors, is_rectified, &k);
  if (repair.swap_principal_point) std::swap(k.cx_px, k.cy_px);
  for (const int axis : {0, 1}) {
    if (!(axis == 0 ? repair.mirror_x : repair.mirror_y)) continue;
    Mat3 mirror = Mat3::Identity();
    mirror(axis, axis) = -1;
    pose = {mirror * pose.rotation * mirror, mirror * pose.translation};
    if (axis == 0) k.cx_px = k.width_px - k.cx_px;
    if (axis == 1) k.cy_px = k.height_px - k.cy_px;
    k.skew_px = -k.skew_px;
  }
  camera.cam_from_world = pose;
  return camera;
}

bool IsRectified(const LightField& light_field) {
  if (light_field.intrinsics.size() < 3) return false;
  const auto [least, most] = std::minmax_element(
      light_field.intrinsics.begin(), light_field.intrinsics.end(),
      [](const Intrinsics& a, const Intrinsics& b) {
        return a.cx_px / std::max(1, a.width_px) < b.cx_px / std::max(1, b.width_px);
      });
  return most->cx_px / std::max(1, most->width_px) - least->cx_px / std::max(1, least->width_px) >
         0.01;
}

std::vector<uint32_t> NaturalOrder(const std::vector<std::string>& names) {
  return SortedBy(names, NaturallyLess);
}

std::vector<uint32_t> CamerasOfImages(NameOrder order, const std::vector<std::string>& names) {
  std::vector<uint32_t> camera_of(names.size());
  std::iota(camera_of.begin(), camera_of.end(), 0u);
  if (order == NameOrder::kAsRecorded) return camera_of;
  const std::vector<uint32_t> natural = NaturalOrder(names);
  const size_t n = names.size();
  if (order == NameOrder::kFromText || order == NameOrder::kToText) {
    const std::vector<uint32_t> text = SortedBy(names, std::less<std::string>());
    for (size_t i = 0; i < n; ++i)
      (order == NameOrder::kFromText ? camera_of[text[i]] : camera_of[natural[i]]) =
          order == NameOrder::kFromText ? natural[i] : text[i];
    return camera_of;
  }
  for (size_t i = 0; i < n; ++i) {
    const size_t from = order == NameOrder::kReversed ? n - 1 - i
                        : order == NameOrder::kNext   ? i + 1
                                                      : i - 1;  // wraps around before the first
    camera_of[natural[i]] = from < n ? natural[from] : LfCamera::kNone;
  }
  return camera_of;
}

size_t ApplyRepair(const Repair& repair, LightField* light_field) {
  if (repair.is_none()) return 0;  // products with ones would change the last bits, and signs of 0
  const bool is_rectified = IsRectified(*light_field);
  const std::vector<uint32_t> camera_of = CamerasOfImages(repair.names, light_field->image_names);
  const std::vector<LfCamera> recorded = light_field->cameras;
  const std::vector<Intrinsics> intrinsics = std::move(light_field->intrinsics);
  DistinctIntrinsics distinct;
  std::vector<size_t> kept;
  for (size_t i = 0; i < recorded.size(); ++i) {
    if (camera_of[i] == LfCamera::kNone) continue;
    kept.push_back(i);
    const LfCamera& from = recorded[camera_of[i]];
    const PinholeCamera camera = RepairedCamera(
        repair, {intrinsics[from.intrinsics_index], from.cam_from_world}, is_rectified);
    light_field->cameras[i].cam_from_world = camera.cam_from_world;
    light_field->cameras[i].intrinsics_index = distinct.IndexOf(camera.intrinsics);
  }
  light_field->intrinsics = distinct.Take();
  const size_t removed = recorded.size() - kept.size();
  for (size_t i = 0; i < recorded.size(); ++i)
    if (camera_of[i] == LfCamera::kNone) light_field->cameras[i].intrinsics_index = 0;
  if (removed > 0) KeepImages(kept, light_field);
  return removed;
}

std::vector<Repair> UsualRepairs(bool are_parallel) {
  std::vector<Repair> all;
  const auto add = [&](const Repair& repair) { all.push_back(repair); };
  const auto add_mirrors = [&] {
    add({.mirror_y = true});
    add({.mirror_x = true});
    if (are_parallel) add({.mirror_x = true, .mirror_y = true});
  };
  if (are_parallel) {
    add_mirrors();
    add({.position_axes = {2, 1, 3}});
  }
  add({.camera_axes = {1, -2, -3}});
  add({.reading = PoseReading::kInverse});
  add({.reading = PoseReading::kInverse, .camera_axes = {1, -2, -3}});
  if (!are_parallel) add_mirrors();
  add({.camera_axes = {-1, -2, 3}});
  for (const OrderName& one : kOrders) add({.names = one.order});
  for (const PoseReading reading :
       {PoseReading::kTranspose, PoseReading::kTransposeOpenGl, PoseReading::kTransposeRotation,
        PoseReading::kCentre, PoseReading::kTranslation})
    add({.reading = reading});
  add({.swap_principal_point = true});
  add({.camera_axes = {1, -2, -3}, .mirror_x = true});
  add({.camera_axes = {1, -2, -3}, .mirror_y = true});
  const std::vector<Axes> axes = AllAxes();
  for (const Axes& one : axes) add({.position_axes = one});
  for (const PoseReading reading :
       {PoseReading::kAsRecorded, PoseReading::kInverse, PoseReading::kTranspose,
        PoseReading::kTransposeOpenGl, PoseReading::kTransposeRotation, PoseReading::kCentre,
        PoseReading::kTranslation})
    for (const bool mirrored : {false, true})
      for (const Axes& one : axes)
        if (IsRightHanded(one)) add({.reading = reading, .camera_axes = one, .mirror_x = mirrored});
  std::vector<Repair> distinct;
  for (const Repair& one : all)
    if (!one.is_none() && std::find(distinct.begin(), distinct.end(), one) == distinct.end())
      distinct.push_back(one);
  return distinct;
}

}  // namespace lf
