// SPDX-License-Identifier: Apache-2.0
// The loop of thesis 4.3.1 in a straightforward form with Eigen: for every pixel, the ray by K^-1
// and the inverse of [R|t] (Eq. 4.1, 4.2), its intersections with lens plane and focus plane, the
// projection by K'[R'|t'], and one addition to a plate of float sums and counts,
// [height][width][6]. All matrices are computed once for each LF image, and a ray that misses the
// lens is abandoned at once.
//
// Scalars are float, which is a tenth faster than double and puts a few rays in 10^4 into other
// elements. The file is compiled twice: like the rest of the project, and for the machine that it
// is built on (-march=native, with fused multiply-adds), where floor is one instruction instead of
// a call.
#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "bench/contender.h"

#include "lf/core/check.h"

namespace lf::bench {
namespace {

using Scalar = float;
using Vector2 = Eigen::Matrix<Scalar, 2, 1>;
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
using Vector4 = Eigen::Matrix<Scalar, 4, 1>;
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
using Matrix4 = Eigen::Matrix<Scalar, 4, 4>;
using Projection = Eigen::Matrix<Scalar, 3, 4>;

constexpr size_t kPlateChannels = 6;  // sums of R G B, counts of R G B
constexpr int kLanes = LfPixels::kRgbLanes;

Eigen::Matrix4d Extrinsics(const RigidTransform& cam_from_world) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = cam_from_world.rotation;
  m.topRightCorner<3, 1>() = cam_from_world.translation;
  return m;
}

Projection ProjectionOf(const PinholeCamera& camera) {
  return (camera.intrinsics.Matrix() * Extrinsics(camera.cam_from_world).topRows<3>())
      .cast<Scalar>();
}

class ThesisLoop final : public Contender {
 public:
  explicit ThesisLoop(const KernelCase& kernel_case)
      : case_(kernel_case),
        width_(kernel_case.spec.plate_width),
        height_(kernel_case.spec.plate_height),
        plate_(static_cast<size_t>(width_) * static_cast<size_t>(height_) * kPlateChannels),
        lens_centre_(kernel_case.frame.pinhole.CentreWorld().cast<Scalar>()),
        right_(kernel_case.frame.pinhole.RightWorld().cast<Scalar>()),
        up_(kernel_case.frame.pinhole.UpWorld().cast<Scalar>()),
        forward_(kernel_case.frame.pinhole.ForwardWorld().cast<Scalar>()),
        plane_normal_(kernel_case.frame.focus_plane.normal.cast<Scalar>()),
        plane_offset_(static_cast<Scalar>(kernel_case.frame.focus_plane.offset_w)),
        radius2_(static_cast<Scalar>(std::pow(kernel_case.frame.aperture.radius_w, 2))) {
    if (kernel_case.frame.aperture.blades > 0)
      for (const ApertureEdge& edge : Edges(kernel_case.frame.aperture)) {
        edge_normals_.push_back(edge.normal.cast<Scalar>());
        edge_distances_.push_back(static_cast<Scalar>(edge.distance_w));
      }
  }

  void Collect(int image_count) override {
    for (size_t i = 0; i < static_cast<size_t>(image_count); ++i) {
      if (case_.spec.estimator == Estimator::kBilinear)
        Gather(i);
      else if (case_.spec.bayer == BayerPattern::kNone)
        Scatter<true>(i);
      else
        Scatter<false>(i);
    }
  }

  Picture Develop() const override {
    Picture picture{width_, height_, {}, {}};
    for (size_t i = 0; i < plate_.size(); ++i)
      (i % kPlateChannels < 3 ? picture.sums : picture.counts).push_back(plate_[i]);
    return picture;
  }

 private:
  bool PassesLens(const Vector3& centre, const Vector3& direction) const {
    const Scalar along = forward_.dot(direction);
    if (!(along > 0)) return false;
    const Vector3 point = centre + direction * (forward_.dot(lens_centre_ - centre) / along);
    const Vector3 on_lens = point - lens_centre_;
    if (edge_normals_.empty()) return on_lens.squaredNorm() <= radius2_;
    const Vector2 position(right_.dot(on_lens), up_.dot(on_lens));
    for (size_t i = 0; i < edge_normals_.size(); ++i)
      if (edge_normals_[i].dot(position) > edge_distances_[i]) return false;
    return true;
  }

  Scalar* Element(int x, int y) {
    return plate_.data() +
           (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)) *
               kPlateChannels;
  }

  template <bool kIsRgb>
  void Scatter(size_t index) {
    const PinholeCamera& camera = case_.cameras[index];
    const LfPixels& pixels = case_.images[index];
    const PixelRect& rect = case_.rects[index];
    const Matrix3 k_inverse = camera.intrinsics.InverseMatrix().cast<Scalar>();
    const Matrix4 world_from_cam = Extrinsics(camera.cam_from_world).inverse().cast<Scalar>();
    const Vector3 centre = camera.CentreWorld().cast<Scalar>();
    const Projection projection = ProjectionOf(case_.frame.pinhole);
    const bool is_distorted = case_.ideal_pixels.has_value();
    for (int y = rect.y_begin; y < rect.y_end; ++y) {
      const uint16_t* const row = pixels.radiance.row(y);
      const float* const ideal = is_distorted ? case_.ideal_positions.row(y) : nullptr;
      for (int x = rect.x_begin; x < rect.x_end; ++x) {
        Vector3 p(static_cast<Scalar>(x) + Scalar(0.5), static_cast<Scalar>(y) + Scalar(0.5), 1);
        if (is_distorted) p = Vector3(ideal[2 * x], ideal[2 * x + 1], 1);
        const Vector3 p_camera = k_inverse * p;
        const Vector4 p_world = world_from_cam * p_camera.homogeneous();
        const Vector3 direction = p_world.template head<3>() - centre;
        if (!PassesLens(centre, direction)) continue;
        const Scalar distance =
            (plane_offset_ - plane_normal_.dot(centre)) / plane_normal_.dot(direction);
        const Vector3 focus_point = centre + distance * direction;
        if (!(forward_.dot(focus_point - lens_centre_) > 0)) continue;
        const Vector3 q = projection * focus_point.homogeneous();
        const int element_x = static_cast<int>(std::floor(q.x() / q.z()));
        const int element_y = static_cast<int>(std::floor(q.y() / q.z()));
        if (element_x < 0 || element_x >= width_ || element_y < 0 || element_y >= height_) continue;
        Scalar* const element = Element(element_x, element_y);
        if constexpr (kIsRgb) {
          for (int channel = 0; channel < 3; ++channel) {
            element[channel] += static_cast<Scalar>(row[x * kLanes + channel]);
            element[channel + 3] += 1;
          }
        } else {
          const int channel = BayerChannel(pixels.bayer, x, y);
          element[channel] += static_cast<Scalar>(row[x]);
          element[channel + 3] += 1;
        }
      }
    }
  }

  // The loop in the other direction: every element looks up its ray in the LF image.
  void Gather(size_t index) {
    const PinholeCamera& camera = case_.cameras[index];
    const LfPixels& pixels = case_.images[index];
    LF_CHECK(!case_.ideal_pixels);
    const Matrix3 k_inverse = case_.frame.pinhole.intrinsics.InverseMatrix().cast<Scalar>();
    const Matrix4 world_from_cam =
        Extrinsics(case_.frame.pinhole.cam_from_world).inverse().cast<Scalar>();
    const Vector3 centre = camera.CentreWorld().cast<Scalar>();
    const Projection projection = ProjectionOf(camera);
    const Scalar x_end = static_cast<Scalar>(camera.intrinsics.width_px - 1);
    const Scalar y_end = static_cast<Scalar>(camera.intrinsics.height_px - 1);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const Vector3 p(static_cast<Scalar>(x) + Scalar(0.5), static_cast<Scalar>(y) + Scalar(0.5),
                        1);
        const Vector3 p_camera = k_inverse * p;
        const Vector4 p_world = world_from_cam * p_camera.homogeneous();
        const Vector3 to_element = p_world.head<3>() - lens_centre_;
        const Scalar distance =
            (plane_offset_ - plane_normal_.dot(lens_centre_)) / plane_normal_.dot(to_element);
        const Vector3 focus_point = lens_centre_ + distance * to_element;
        if (!(distance > 0) || !PassesLens(centre, focus_point - centre)) continue;
        const Vector3 q = projection * focus_point.homogeneous();
        // Position among the four surrounding pixels, relative to their centres.
        const Scalar column = q.x() / q.z() - Scalar(0.5), row = q.y() / q.z() - Scalar(0.5);
        if (!(column >= 0 && column < x_end && row >= 0 && row < y_end)) continue;
        const int left = static_cast<int>(column), top = static_cast<int>(row);
        const Scalar a = column - static_cast<Scalar>(left), b = row - static_cast<Scalar>(top);
        const uint16_t* const upper = pixels.radiance.row(top) + left * kLanes;
        const uint16_t* const lower = pixels.radiance.row(top + 1) + left * kLanes;
        Scalar* const element = Element(x, y);
        for (int channel = 0; channel < 3; ++channel) {
          const Scalar above = (1 - a) * static_cast<Scalar>(upper[channel]) +
                               a * static_cast<Scalar>(upper[channel + kLanes]);
          const Scalar below = (1 - a) * static_cast<Scalar>(lower[channel]) +
                               a * static_cast<Scalar>(lower[channel + kLanes]);
          element[channel] += (1 - b) * above + b * below;
          element[channel + 3] += 1;
        }
      }
  }

  const KernelCase& case_;
  int width_, height_;
  std::vector<Scalar> plate_;
  Vector3 lens_centre_, right_, up_, forward_, plane_normal_;
  Scalar plane_offset_, radius2_;
  std::vector<Vector2> edge_normals_;
  std::vector<Scalar> edge_distances_;
};

}  // namespace

std::unique_ptr<Contender> LF_BENCH_MAKE_THESIS_LOOP(const KernelCase& kernel_case) {
  return std::make_unique<ThesisLoop>(kernel_case);
}

}  // namespace lf::bench
