// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/lens_weights/image_feather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "lf/camera/ray_weight.h"

namespace lf {
namespace {

double Smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Returns a feather in units of 1/kWholeFeather.
uint16_t Rounded(double feather) { return static_cast<uint16_t>(kWholeFeather * feather + 0.5); }

}  // namespace

double FeatherAt(const Intrinsics& lf_image, double x_px, double y_px) {
  const double width = kFeatherShare * std::min(lf_image.width_px, lf_image.height_px);
  const double across = std::min(x_px - 0.5, lf_image.width_px - 0.5 - x_px);
  const double down = std::min(y_px - 0.5, lf_image.height_px - 0.5 - y_px);
  return Smooth(across / width) * Smooth(down / width);
}

ImageFeather::ImageFeather(const PinholeCamera& lf_camera, const RenderCamera& frame)
    : intrinsics_(lf_camera.intrinsics),
      lf_camera_(lf_camera),
      frame_(frame),
      maps_(MapsOf(lf_camera, frame)) {
  constexpr double kRounding_px = 1e-6;
  border_px_ =
      0.5 + kRounding_px + kFeatherShare * std::min(intrinsics_.width_px, intrinsics_.height_px);
  forms_ = FormsOf(maps_);
}

ImageFeather::Maps ImageFeather::MapsOf(const PinholeCamera& lf_camera, const RenderCamera& frame) {
  const PinholeCamera& lens = frame.pinhole;
  const Vec3& n = frame.focus_plane.normal;
  const Vec3 offset = lf_camera.CentreWorld() - lens.CentreWorld();
  const double distance = frame.focus_plane.offset_w - n.dot(lens.CentreWorld());
  const double sign = distance < 0 ? -1 : 1;
  const Mat3 direction = lens.cam_from_world.rotation.transpose() * lens.intrinsics.InverseMatrix();
  // X is the focus point of the position e = (x, y, 1) on the plate, c the centre of the LF camera,
  // and c' the centre of the lens: X - c' = distance (direction e) / n.(direction e), and
  // X - c = X - c' - offset. If X is in front of the lens, to_focus e = (X - c) |n.(direction e)|.
  const Mat3 to_focus = sign * (distance * Mat3::Identity() - offset * n.transpose()) * direction;
  Maps maps;
  maps.to_focus = lf_camera.cam_from_world.rotation * to_focus;
  maps.to_pixel = lf_camera.intrinsics.Matrix() * maps.to_focus;
  maps.before_lens = (sign * n.transpose() * direction).transpose();
  maps.runs_forward = (lens.ForwardWorld().transpose() * to_focus).transpose();
  return maps;
}

ImageFeather::Forms ImageFeather::FormsOf(const Maps& maps) const {
  Forms forms;
  const auto set = [&forms](int number, const Vec3& form) {
    forms.x[number] = form.x();
    forms.y[number] = form.y();
    forms.constant[number] = form.z();
  };
  const Vec3 across = maps.to_pixel.row(0).transpose(), down = maps.to_pixel.row(1).transpose(),
             depth = maps.to_pixel.row(2).transpose();
  set(0, maps.before_lens);
  set(1, depth);
  for (const auto& [first, border_px] :
       {std::pair(Forms::kSeen, 0.5), {Forms::kWhole, border_px_}}) {
    set(first, across - border_px * depth);
    set(first + 1, (intrinsics_.width_px - border_px) * depth - across);
    set(first + 2, down - border_px * depth);
    set(first + 3, (intrinsics_.height_px - border_px) * depth - down);
  }
  return forms;
}

// The forms in a rectangle of corners of blocks.
class ImageFeather::RectForms {
 public:
  // (x, y) is the first position.
  RectForms(const Maps& maps, const Forms& forms, int x, int y, int columns, int rows)
      : columns_(columns) {
    const double width = kWeightBlock * (columns - 1.0), height = kWeightBlock * (rows - 1.0);
    struct Bounds {
      double value;        // at the first position
      double least, most;  // in the rectangle: values at corners
      double doubt;        // more than the rounding of the values
    };
    const auto bounds = [&](double form_x, double form_y, double constant) -> Bounds {
      const double value = form_x * x + form_y * y + constant;
      const double right = form_x * width, below = form_y * height;
      constexpr double kRounding = 1e-12;
      return {value, value + std::min(right, 0.0) + std::min(below, 0.0),
              value + std::max(right, 0.0) + std::max(below, 0.0),
              kRounding * (std::abs(form_x * x) + std::abs(form_y * y) + std::abs(constant) +
                           std::abs(right) + std::abs(below))};
    };
    const Vec3& runs_forward = maps.runs_forward;
    const Bounds forward = bounds(runs_forward.x(), runs_forward.y(), runs_forward.z());
    if (forward.least > forward.doubt) side_ = 1;
    if (forward.most < -forward.doubt) side_ = -1;
    for (int i = 0; i < Forms::kCount; ++i) {
      const double sign = i == 0 ? 1 : side_;
      const Bounds of_form = bounds(sign * forms.x[i], sign * forms.y[i], sign * forms.constant[i]);
      const double doubt = i < Forms::kSeen ? of_form.doubt : 0;
      is_unseen_ |= i < Forms::kWhole && of_form.most < -doubt;
      if (of_form.least >= doubt) continue;
      decisive_[decisive_count_++] = {i, kWeightBlock * sign * forms.x[i],
                                      kWeightBlock * sign * forms.y[i], of_form.value};
    }
  }

  // 1 if runs_forward is positive in the rectangle, -1 if it is negative; 0 if it may be both. The
  // other functions must not be called then.
  double side() const { return side_; }
  // True if the feather is 0 in the rectangle.
  bool is_unseen() const { return is_unseen_; }

  // Along a row, the feather is 0, rises, is whole, falls, and is 0 again. Each change is where a
  // form is 0. Rounding does not matter at borders of the LF image, because the feather is smooth
  // there: it is rounded to 0 near 0.5 px, and to kWholeFeather near border_px_. Where one of the
  // first two forms changes its sign, the next position on either side is computed.
  RowParts PartsOf(int row) const {
    Range seen{0, columns_ - 1.0}, whole = seen;
    int doubtful = 0;
    for (int k = 0; k < decisive_count_; ++k) {
      const DecisiveForm& form = decisive_[k];
      const double value = form.first + form.down * row;
      if (form.number < Forms::kWhole) seen.Keep(value, form.right);
      if (form.number < Forms::kSeen || form.number >= Forms::kWhole) whole.Keep(value, form.right);
      if (form.number < Forms::kSeen) doubtful = 1;
    }
    const auto index = [](double position, int low, int high) {
      return static_cast<int>(
          std::clamp(position, static_cast<double>(low), static_cast<double>(high)));
    };
    RowParts parts;
    parts.seen_begin = index(std::ceil(seen.first) - doubtful, 0, columns_);
    parts.seen_end = index(std::floor(seen.last) + 1 + doubtful, parts.seen_begin, columns_);
    parts.whole_begin = index(std::ceil(whole.first) + doubtful, parts.seen_begin, parts.seen_end);
    parts.whole_end =
        index(std::floor(whole.last) + 1 - doubtful, parts.whole_begin, parts.seen_end);
    return parts;
  }

 private:
  // The first and the last position of a row at which forms are not negative.
  struct Range {
    double first, last;
    //   value  of the form at position 0;  right  its change from one position to the next
    void Keep(double value, double right) {
      if (right > 0)
        first = std::max(first, -value / right);
      else if (right < 0)
        last = std::min(last, -value / right);
      else if (value < 0)
        first = INFINITY;
    }
  };
  // A form that may be negative in the rectangle. Most forms are positive everywhere in it.
  struct DecisiveForm {
    int number;
    double right, down;  // its change from one position to the next
    double first;        // its value at the first position
  };

  int columns_;
  double side_ = 0;
  bool is_unseen_ = false;
  std::array<DecisiveForm, Forms::kCount> decisive_;
  int decisive_count_ = 0;
};

void ImageFeather::OfCorners(int x, int y, int columns, int rows, uint16_t* feather) const {
  const RectForms forms(maps_, forms_, x, y, columns, rows);
  if (intrinsics_.has_distortion() || frame_.surface || forms.side() == 0) {
    for (int row = 0; row < rows; ++row)
      ComputeRow(x, y + row * kWeightBlock, columns,
                 feather + static_cast<ptrdiff_t>(row) * columns);
    return;
  }
  if (forms.is_unseen()) {
    std::fill_n(feather, static_cast<ptrdiff_t>(rows) * columns, uint16_t{0});
    return;
  }
  const Mat3 to_focus = forms.side() * maps_.to_focus;
  for (int row = 0; row < rows; ++row) {
    uint16_t* const of_row = feather + static_cast<ptrdiff_t>(row) * columns;
    const auto compute = [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Vec3 e(x + i * kWeightBlock, y + row * kWeightBlock, 1);
        of_row[i] = maps_.before_lens.dot(e) > 0 ? Rounded(At(to_focus * e)) : 0;
      }
    };
    const RowParts parts = forms.PartsOf(row);
    std::fill_n(of_row, parts.seen_begin, uint16_t{0});
    compute(parts.seen_begin, parts.whole_begin);
    std::fill(of_row + parts.whole_begin, of_row + parts.whole_end, uint16_t{kWholeFeather});
    compute(parts.whole_end, parts.seen_end);
    std::fill(of_row + parts.seen_end, of_row + columns, uint16_t{0});
  }
}

void ImageFeather::ComputeRow(int x, int y, int count, uint16_t* feather) const {
  const bool is_distorted = intrinsics_.has_distortion();
  if (is_distorted) std::call_once(map_is_made_, [this] { map_.emplace(intrinsics_.distortion); });
  Maps of_piece;
  const FocalPiece* piece = nullptr;
  for (int i = 0; i < count; ++i) {
    const Vec3 e(x + i * kWeightBlock, y, 1);
    if (frame_.surface && (piece == nullptr || piece != &frame_.surface->PieceAt(e.x(), e.y()))) {
      piece = &frame_.surface->PieceAt(e.x(), e.y());
      RenderCamera camera = FocusedAsAt(frame_, e.x(), e.y());
      of_piece = MapsOf(lf_camera_, camera);
    }
    const Maps& maps = frame_.surface ? of_piece : maps_;
    feather[i] = 0;
    if (!(maps.before_lens.dot(e) > 0)) continue;
    const double side = maps.runs_forward.dot(e) < 0 ? -1 : 1;
    // This test is five times as fast as At().
    if (!is_distorted && IsInside(side * (maps.to_pixel * e)))
      feather[i] = kWholeFeather;
    else
      feather[i] = Rounded(At(side * (maps.to_focus * e)));
  }
}

// It suffices to test the corners of `rect`: if they pass, a projective map takes `rect` to a
// quadrilateral in the LF image, which is within any rectangle that contains its corners.
bool ImageFeather::IsWhole(const PixelRect& rect) const {
  if (intrinsics_.has_distortion()) return false;
  if (!frame_.surface) return IsWhole(rect, maps_);
  // Corners of blocks have the feather of their own piece. All pieces of the rectangle are between
  // the depths of its blocks of pieces; at both depths, the points are in a convex region.
  const Intrinsics& plate = frame_.pinhole.intrinsics;
  if (Intersection(rect, {0, 0, plate.width_px, plate.height_px}) != rect) return false;
  double q_low = INFINITY, q_high = 0;
  for (const FocalBlock& block : frame_.surface->blocks())
    if (block.elements.x_begin <= rect.x_end && block.elements.x_end >= rect.x_begin &&
        block.elements.y_begin <= rect.y_end && block.elements.y_end >= rect.y_begin) {
      q_low = std::min(q_low, block.q_low);
      q_high = std::max(q_high, block.q_high);
    }
  if (!(q_low <= q_high)) return false;
  for (const double q : {q_low, q_high}) {
    RenderCamera at_depth = frame_;
    at_depth.focus_plane = PlaneOfPiece(frame_.pinhole, {rect, {0, 0, q}});
    if (!IsWhole(rect, MapsOf(lf_camera_, at_depth))) return false;
  }
  return true;
}

bool ImageFeather::IsWhole(const PixelRect& rect, const Maps& maps) const {
  double side = 0;
  for (const int y : {rect.y_begin, rect.y_end})
    for (const int x : {rect.x_begin, rect.x_end}) {
      const Vec3 e(x, y, 1);
      const double forward = maps.runs_forward.dot(e);
      if (!(maps.before_lens.dot(e) > 0) || forward * side < 0) return false;
      side = forward < 0 ? -1 : 1;
      if (!IsInside(side * (maps.to_pixel * e))) return false;
    }
  return true;
}

// Returns the feather of a ray in the LF image.
//   direction  direction of the ray, of any length, in the axes of the LF camera
double ImageFeather::At(const Vec3& direction) const {
  const Intrinsics& k = intrinsics_;
  Vec2 distorted;
  if (map_) {
    const std::optional<Vec2> recorded = map_->Distort(direction);
    if (!recorded) return 0;
    distorted = *recorded;
  } else {
    if (!(direction.z() > 0)) return 0;
    distorted = direction.head<2>() / direction.z();
  }
  return FeatherAt(k, k.fx_px * distorted.x() + k.skew_px * distorted.y() + k.cx_px,
                   k.fy_px * distorted.y() + k.cy_px);
}

}  // namespace lf
