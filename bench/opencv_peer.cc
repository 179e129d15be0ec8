// SPDX-License-Identifier: Apache-2.0
// The usual implementation with OpenCV: it demosaics the LF image (Bayer), warps it onto the focus
// plane as the frame sees it (bilinear or bicubic), and accumulates it where its rays pass the
// lens. All values are linear light.
//
// In OpenCV's favour, everything is cut to the pixels and elements that can contribute, the mask of
// image border and lens is filled as a polygon instead of being warped, and with lens distortion
// the maps of cv::remap are made once for all images, in fixed-point form.
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "bench/contender.h"

#include "lf/camera/ray_forms.h"
#include "lf/core/check.h"

namespace lf::bench {
namespace {

// Number of edges of the polygon that masks a disk.
constexpr int kDiskEdges = 128;

using Polygon = std::vector<Vec2>;  // corners are ideal positions or elements

// Returns the part of the polygon with form (x, y, 1) <= 0. For a concave polygon the result may
// contain edges that coincide, but it is filled correctly.
Polygon Clip(const Polygon& polygon, const PixelForm& form) {
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    const double at_a = Value(form, a.x(), a.y()), at_b = Value(form, b.x(), b.y());
    if (at_a <= 0) kept.push_back(a);
    if ((at_a <= 0) != (at_b <= 0)) kept.emplace_back(a + (b - a) * (at_a / (at_a - at_b)));
  }
  return kept;
}

cv::Rect BoundsOf(const Polygon& polygon, const cv::Rect& limit) {
  Vec2 low = polygon[0], high = polygon[0];
  for (const Vec2& p : polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const auto x = static_cast<int>(std::floor(low.x())), y = static_cast<int>(std::floor(low.y()));
  return cv::Rect(x, y, static_cast<int>(std::ceil(high.x())) - x,
                  static_cast<int>(std::ceil(high.y())) - y) &
         limit;
}

int DemosaicCode(BayerPattern pattern) {
  switch (pattern) {
    case BayerPattern::kRggb:
      return cv::COLOR_BayerRGGB2RGB;
    case BayerPattern::kBggr:
      return cv::COLOR_BayerBGGR2RGB;
    case BayerPattern::kGrbg:
      return cv::COLOR_BayerGRBG2RGB;
    case BayerPattern::kGbrg:
      return cv::COLOR_BayerGBRG2RGB;
    case BayerPattern::kNone:
      break;
  }
  LF_CHECK(false);
  return 0;
}

class OpenCv final : public Contender {
 public:
  OpenCv(const KernelCase& kernel_case, bool is_cubic)
      : case_(kernel_case),
        interpolation_(is_cubic ? cv::INTER_CUBIC : cv::INTER_LINEAR),
        plate_(0, 0, kernel_case.spec.plate_width, kernel_case.spec.plate_height),
        sums_(plate_.size(), CV_32FC3, cv::Scalar(0)),
        counts_(plate_.size(), CV_32FC1, cv::Scalar(0)),
        mask_(plate_.size(), CV_8UC1) {
    cv::setNumThreads(1);
    for (const LfPixels& pixels : kernel_case.images) images_.push_back(Prepare(pixels));
    if (kernel_case.ideal_pixels) MakeMaps();
  }

  void Collect(int image_count) override {
    for (size_t i = 0; i < static_cast<size_t>(image_count); ++i) Add(i);
  }

  Picture Develop() const override {
    Picture picture{plate_.width, plate_.height, {}, {}};
    for (int y = 0; y < plate_.height; ++y)
      for (int x = 0; x < plate_.width; ++x)
        for (int channel = 0; channel < 3; ++channel) {
          picture.sums.push_back(sums_.at<cv::Vec3f>(y, x)[channel]);
          picture.counts.push_back(counts_.at<float>(y, x));
        }
    return picture;
  }

 private:
  // Converts an LF image once, as if on loading: mosaics stay as they are, RGB becomes float.
  static cv::Mat Prepare(const LfPixels& pixels) {
    const Image<uint16_t>& image = pixels.radiance;
    const cv::Mat stored(image.height(), image.width(), CV_16UC(image.channels()),
                         const_cast<uint16_t*>(image.pixels().data()));
    if (pixels.bayer != BayerPattern::kNone) return stored;
    cv::Mat rgb(stored.size(), CV_16UC3), prepared;
    const int channels[] = {0, 0, 1, 1, 2, 2};
    cv::mixChannels(&stored, 1, &rgb, 1, channels, 3);
    rgb.convertTo(prepared, CV_32F);
    return prepared;
  }

  // Makes the maps from the ideal image, large enough for all rays, to the recorded image.
  void MakeMaps() {
    const Intrinsics& k = case_.cameras[0].intrinsics;
    const DistortionMap distortion(k.distortion);
    border_ = Border(distortion, k);
    const int reach = k.width_px;
    ideal_ = BoundsOf(border_, cv::Rect(-reach, -reach, 3 * reach, 3 * reach));
    cv::Mat map_x(ideal_.size(), CV_32FC1), map_y(ideal_.size(), CV_32FC1);
    for (int y = 0; y < ideal_.height; ++y)
      for (int x = 0; x < ideal_.width; ++x) {
        const Vec3 q(ideal_.x + x + 0.5, ideal_.y + y + 0.5, 1);
        const std::optional<Vec2> d = distortion.Distort(k.InverseMatrix() * q);
        map_x.at<float>(y, x) = d ? static_cast<float>(k.fx_px * d->x() + k.cx_px - 0.5) : -9.F;
        map_y.at<float>(y, x) = d ? static_cast<float>(k.fy_px * d->y() + k.cy_px - 0.5) : -9.F;
      }
    cv::convertMaps(map_x, map_y, map_1_, map_2_, CV_16SC2);
  }

  // Returns the border of the image, through the outermost pixel centres, as ideal positions.
  static Polygon Border(const DistortionMap& distortion, const Intrinsics& k) {
    constexpr int kSteps = 64;
    Polygon border;
    const double w = k.width_px - 1, h = k.height_px - 1;
    const Vec2 corners[] = {{0.5, 0.5}, {0.5 + w, 0.5}, {0.5 + w, 0.5 + h}, {0.5, 0.5 + h}};
    for (int side = 0; side < 4; ++side)
      for (int i = 0; i < kSteps; ++i) {
        const Vec2 p = corners[side] + (corners[(side + 1) % 4] - corners[side]) * i / kSteps;
        const std::optional<Vec3> q = IdealPosition(k, distortion, p.x(), p.y());
        LF_CHECK(q && q->z() > 0);
        border.emplace_back(q->head<2>() / q->z());
      }
    return border;
  }

  // Returns the region of accepted rays, in ideal positions.
  Polygon AcceptedRegion(const RayForms& forms, const PixelRect& rect) const {
    Polygon region = border_;
    if (region.empty())
      region = {{rect.x_begin + 0.5, rect.y_begin + 0.5},
                {rect.x_end - 0.5, rect.y_begin + 0.5},
                {rect.x_end - 0.5, rect.y_end - 0.5},
                {rect.x_begin + 0.5, rect.y_end - 0.5}};
    const int sign = Value(forms.plane, region[0].x(), region[0].y()) > 0 ? 1 : -1;
    for (const PixelForm& form : PlateHalfPlanes(forms, case_.frame, sign, 0))
      region = Clip(region, form);
    for (const ApertureEdge& edge : Edges(case_.frame.aperture, kDiskEdges))
      region = Clip(region, edge.normal.x() * forms.lens_right + edge.normal.y() * forms.lens_up -
                                edge.distance_w * forms.forward);
    return region;
  }

  // Fills the elements whose centre is in the polygon; `origin` is the first element of `mask`.
  void FillMask(const Polygon& region, const cv::Point& origin, cv::Mat* mask) const {
    constexpr int kFractionBits = 8;
    std::vector<cv::Point> points;
    for (const Vec2& p : region)
      points.emplace_back(static_cast<int>(std::lround((p.x() - 0.5 - origin.x) * 256)),
                          static_cast<int>(std::lround((p.y() - 0.5 - origin.y) * 256)));
    mask->setTo(0);
    if (border_.empty())
      cv::fillConvexPoly(*mask, points, cv::Scalar(1), cv::LINE_8, kFractionBits);
    else
      cv::fillPoly(*mask, std::vector<std::vector<cv::Point>>{points}, cv::Scalar(1), cv::LINE_8,
                   kFractionBits);
  }

  // Returns the part of the image that ideal pixels `part` need, demosaicked and undistorted.
  cv::Mat RgbOf(size_t index, const cv::Rect& part, const PixelRect& rect) {
    const LfPixels& pixels = case_.images[index];
    if (map_1_.empty() && pixels.bayer == BayerPattern::kNone) return images_[index](part);
    if (map_1_.empty()) {
      cv::cvtColor(images_[index](part), rgb_, DemosaicCode(pixels.bayer));
      return rgb_;
    }
    LF_CHECK(pixels.bayer != BayerPattern::kNone);
    // Only the recorded rectangle is demosaicked, at its place in the whole image, so that the maps
    // stay valid.
    rgb_.create(images_[index].size(), CV_16UC3);
    const cv::Rect recorded = Even({rect.x_begin, rect.y_begin, rect.width(), rect.height()});
    cv::Mat to = rgb_(recorded);
    cv::cvtColor(images_[index](recorded), to, DemosaicCode(pixels.bayer));
    const cv::Rect in_maps = part - ideal_.tl();
    cv::remap(rgb_, undistorted_, map_1_(in_maps), map_2_(in_maps), interpolation_,
              cv::BORDER_CONSTANT);
    return undistorted_;
  }

  // Grows the rectangle by the two pixels that demosaicking and interpolation reach, aligned with
  // the mosaic.
  cv::Rect Even(const cv::Rect& rect) const {
    const int size = case_.spec.image_size_px;
    const int x = std::max(0, rect.x - 2) & ~1, y = std::max(0, rect.y - 2) & ~1;
    return {x, y, std::min(size, rect.br().x + 2) - x, std::min(size, rect.br().y + 2) - y};
  }

  void Add(size_t index) {
    const RayForms forms = MakeRayForms(case_.cameras[index], case_.frame);
    const Polygon region = AcceptedRegion(forms, case_.rects[index]);
    if (region.empty()) return;
    Polygon on_plate;
    for (const Vec2& p : region) {
      const double scale = 1 / Value(forms.front, p.x(), p.y());
      on_plate.emplace_back(Value(forms.sensor_x, p.x(), p.y()) * scale,
                            Value(forms.sensor_y, p.x(), p.y()) * scale);
    }
    const cv::Rect elements = BoundsOf(on_plate, plate_);
    const bool is_distorted = !border_.empty();
    const int size = case_.spec.image_size_px;
    const cv::Rect part = is_distorted ? Grown(BoundsOf(region, ideal_)) & ideal_
                                       : Even(BoundsOf(region, cv::Rect(0, 0, size, size)));
    const cv::Mat rgb = RgbOf(index, part, case_.rects[index]);

    // OpenCV's indices of pixels and elements have their centres at whole numbers.
    Mat3 element_from_pixel;
    element_from_pixel << forms.sensor_x, forms.sensor_y, forms.front;
    Mat3 to_centre = Mat3::Identity(), from_centre = Mat3::Identity();
    to_centre.topRightCorner<2, 1>() = Vec2(part.x + 0.5, part.y + 0.5);
    from_centre.topRightCorner<2, 1>() = -Vec2(elements.x + 0.5, elements.y + 0.5);
    const Mat3 pixel_from_element =
        (from_centre * element_from_pixel * to_centre).inverse().transpose();
    const cv::Matx33d warp(pixel_from_element.data());
    cv::warpPerspective(rgb, warped_, warp, elements.size(), interpolation_ | cv::WARP_INVERSE_MAP,
                        cv::BORDER_CONSTANT);

    cv::Mat mask = mask_(elements), sums = sums_(elements), counts = counts_(elements);
    FillMask(on_plate, elements.tl(), &mask);
    cv::accumulate(warped_, sums, mask);
    cv::accumulate(mask, counts);
  }

  static cv::Rect Grown(const cv::Rect& r) { return {r.x - 2, r.y - 2, r.width + 4, r.height + 4}; }

  const KernelCase& case_;
  const int interpolation_;
  cv::Rect plate_;
  cv::Mat sums_, counts_, mask_;
  std::vector<cv::Mat> images_;
  // For lens distortion: the border, the part of the ideal image that the recorded image fills, and
  // the maps that find the recorded position of each ideal pixel.
  Polygon border_;
  cv::Rect ideal_;
  cv::Mat map_1_, map_2_;
  cv::Mat rgb_, undistorted_, warped_;
};

}  // namespace

std::unique_ptr<Contender> MakeOpenCv(const KernelCase& kernel_case, bool is_cubic) {
  return std::make_unique<OpenCv>(kernel_case, is_cubic);
}

}  // namespace lf::bench
