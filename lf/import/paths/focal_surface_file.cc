// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/focal_surface_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "lf/camera/fit_surface.h"
#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr int64_t kMostPlaces = int64_t{1} << 28;
constexpr uint64_t kMostFileBytes = uint64_t{4} << 30;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// Returns the index of the channel that holds the numbers; -1 if there is none.
int ChannelOf(const ImageFileInfo& info) {
  const auto z = std::find(info.channel_names.begin(), info.channel_names.end(), "Z");
  if (z != info.channel_names.end()) return static_cast<int>(z - info.channel_names.begin());
  return info.channels == 1 ? 0 : -1;
}

template <class T>
Image<float> ChannelAsFloats(const Image<T>& picture, int channel) {
  Image<float> numbers(picture.width(), picture.height());
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x)
      numbers.at(x, y) = static_cast<float>(picture.at(x, y, channel));
  return numbers;
}

Result<void> CheckPlaces(int64_t width, int64_t height, const std::string& name) {
  if (width < 1 || height < 1 || width > kMostPlaces || height > kMostPlaces / width)
    return InputError(fmt::format("{}: {} x {} places; expected 1 to {} in all", name, width,
                                  height, kMostPlaces));
  return {};
}

// A height map in coordinates in which sample (column, row) is at x = column and y = row, and z is
// the height in world units.
class HeightMap {
 public:
  HeightMap(const Image<float>& values, const FocalSurfaceSource& source)
      : heights_(values.width(), values.height()), origin_(source.origin_w) {
    for (int y = 0; y < values.height(); ++y)
      for (int x = 0; x < values.width(); ++x) {
        const double height = source.scale * values.at(x, y) + source.offset_w;
        heights_.at(x, y) = std::isfinite(height) ? static_cast<float>(height) : kUnknown;
        if (!std::isfinite(height)) continue;
        low_ = std::min(low_, height);
        high_ = std::max(high_, height);
      }
    Mat3 axes;
    axes.col(0) = source.right_w;
    axes.col(1) = source.down_w;
    axes.col(2) = source.up;
    map_from_world_ = axes.inverse();
  }

  bool is_known() const { return low_ <= high_; }

  // Returns the depth z at which ray.At(z) meets the surface from above; none if it does not.
  std::optional<double> DepthOf(const Ray& ray) const {
    const Vec3 begin = map_from_world_ * (ray.origin - origin_);
    const Vec3 along = map_from_world_ * ray.direction;
    // The part of the ray within the box of the map.
    const double rim = 1e-6 + 1e-9 * (std::abs(low_) + std::abs(high_));
    const Vec3 low(0, 0, low_ - rim),
        high(heights_.width() - 1, heights_.height() - 1, high_ + rim);
    double z_begin = 0, z_end = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (along[axis] == 0) {
        if (begin[axis] < low[axis] || begin[axis] > high[axis]) return std::nullopt;
        continue;
      }
      const double a = (low[axis] - begin[axis]) / along[axis];
      const double b = (high[axis] - begin[axis]) / along[axis];
      z_begin = std::max(z_begin, std::min(a, b));
      z_end = std::min(z_end, std::max(a, b));
    }
    if (!(z_begin <= z_end) || !std::isfinite(z_end)) return std::nullopt;
    const auto above = [&](double z) {
      const Vec3 p = begin + z * along;
      return p.z() - HeightAt(p.x(), p.y());
    };
    // Steps of half a cell, so that no cell is passed over.
    const double cells = std::max(std::abs(along.x()), std::abs(along.y())) * (z_end - z_begin);
    const double count = std::clamp(std::ceil(2 * cells), 1.0, 1e6);
    double last = std::numeric_limits<double>::quiet_NaN(), last_z = z_begin;
    for (double i = 0; i <= count; ++i) {
      const double z = z_begin + (z_end - z_begin) * (i / count);
      const double here = above(z);
      if (last >= 0 && here <= 0) return Crossing(above, last_z, z);
      last = here;
      last_z = z;
    }
    return std::nullopt;
  }

 private:
  // Returns the height at a position of the map, interpolated between four samples. NaN where one
  // of them is unknown.
  double HeightAt(double x, double y) const {
    const int column = std::clamp(static_cast<int>(x), 0, std::max(0, heights_.width() - 2));
    const int row = std::clamp(static_cast<int>(y), 0, std::max(0, heights_.height() - 2));
    const int right = std::min(column + 1, heights_.width() - 1);
    const int below = std::min(row + 1, heights_.height() - 1);
    const double s = std::clamp(x - column, 0.0, 1.0), t = std::clamp(y - row, 0.0, 1.0);
    return (1 - t) * ((1 - s) * heights_.at(column, row) + s * heights_.at(right, row)) +
           t * ((1 - s) * heights_.at(column, below) + s * heights_.at(right, below));
  }

  template <class Above>
  static double Crossing(const Above& above, double z_above, double z_below) {
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (z_above + z_below);
      (above(middle) > 0 ? z_above : z_below) = middle;
    }
    return 0.5 * (z_above + z_below);
  }

  Image<float> heights_;
  Vec3 origin_;
  Mat3 map_from_world_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

// A surface picture in memory.
struct SurfacePicture {
  fs::path file;
  Image<float> values;           // of depths
  std::optional<HeightMap> map;  // of heights
};

Result<SurfacePicture> LoadPicture(const fs::path& file, const FocalSurfaceSource& source) {
  SurfacePicture picture;
  picture.file = file;
  LF_ASSIGN_OR_RETURN(picture.values, ReadSurfaceFile(file, source));
  if (source.nodata)
    for (float& value : picture.values.pixels())
      if (value == static_cast<float>(*source.nodata)) value = kUnknown;
  if (source.kind == FocalSurfaceSource::Kind::kHeights) {
    picture.map.emplace(picture.values, source);
    picture.values = {};
  }
  return picture;
}

Result<void> CheckShape(const SurfacePicture& picture, const Intrinsics& k) {
  constexpr double kMostDifference = 0.01;
  const double across = static_cast<double>(picture.values.width()) / k.width_px;
  const double down = static_cast<double>(picture.values.height()) / k.height_px;
  if (std::abs(across / down - 1) <= kMostDifference) return {};
  return InputError(
      fmt::format("{}: {} x {} depths, but the frame has {} x {} elements: expected a picture of "
                  "the same shape, seen from the camera of the frame",
                  picture.file.string(), picture.values.width(), picture.values.height(),
                  k.width_px, k.height_px));
}

Image<float> InverseDepthsOfMap(const PinholeCamera& camera, const HeightMap& map) {
  const Intrinsics& k = camera.intrinsics;
  Image<float> inverse(k.width_px, k.height_px);
  if (!map.is_known()) return inverse;
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < k.width_px; ++x) {
      const std::optional<double> depth = map.DepthOf(RayOfPixel(camera, x + 0.5, y + 0.5));
      inverse.at(x, y) = depth && *depth > 0 ? static_cast<float>(1 / *depth) : 0;
    }
  return inverse;
}

// Makes the surfaces of the cameras of a path.
class SurfaceMaker {
 public:
  SurfaceMaker(const fs::path& folder, double camera_distance_w, const SurfaceWork& work,
               CameraPath* path)
      : folder_(folder),
        camera_distance_w_(camera_distance_w),
        work_(work),
        source_(*path->focal_surface),
        path_(path) {}

  Result<void> Run() {
    std::vector<FrameId> frames = work_.frames;
    if (frames.empty()) frames = path_->frames().All();
    if (!HasFilePerFrame(source_)) {
      LF_ASSIGN_OR_RETURN(of_all_, LoadPicture(folder_ / source_.file, source_));
    }
    std::vector<std::optional<Error>> errors(frames.size());
    std::atomic<bool> has_failed = false;
    const auto make = [&](size_t i) {
      if (has_failed || IsStopped()) return;
      if (const Result<void> made = MakeFrame(frames[i]); !made) {
        errors[i] = made.error();
        has_failed = true;
      }
    };
    if (work_.pool != nullptr) {
      work_.pool->ForEach(frames.size(), make);
    } else {
      for (size_t i = 0; i < frames.size(); ++i) make(i);
    }
    if (IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
    for (const std::optional<Error>& error : errors)
      if (error) return *error;
    return {};
  }

 private:
  bool IsStopped() const { return work_.stop != nullptr && *work_.stop; }

  Result<void> MakeFrame(FrameId id) {
    const uint32_t frame = id.value;
    const size_t index = path_->frames().IndexOf(id);
    std::optional<SurfacePicture> of_frame;
    if (!of_all_) {
      LF_ASSIGN_OR_RETURN(of_frame, LoadPicture(folder_ / FileOfFrame(source_, frame), source_));
    }
    const SurfacePicture& picture = of_all_ ? *of_all_ : *of_frame;
    LF_RETURN_IF_ERROR(Make(picture, frame, &path_->cameras[index]));
    if (!path_->shutter.exists()) return {};
    const auto samples = static_cast<size_t>(path_->shutter.samples);
    for (size_t i = 0; i < samples; ++i)
      LF_RETURN_IF_ERROR(Make(picture, frame, &path_->instants[index * samples + i]));
    return {};
  }

  Result<void> Make(const SurfacePicture& picture, uint32_t frame, RenderCamera* camera) const {
    if (!picture.map) LF_RETURN_IF_ERROR(CheckShape(picture, camera->pinhole.intrinsics));
    const Intrinsics& k = camera->pinhole.intrinsics;
    Image<float> inverse = picture.map ? InverseDepthsOfMap(camera->pinhole, *picture.map)
                                       : InverseDepthsOfPicture(picture.values, source_.scale,
                                                                k.width_px, k.height_px);
    const size_t unknown_count = FillUnknown(&inverse);
    if (unknown_count == inverse.pixels().size())
      return InputError(
          source_.kind == FocalSurfaceSource::Kind::kDepths
              ? fmt::format("{}: frame {}: the picture holds no depth: expected finite numbers "
                            "above 0, in world units after focus.scale",
                            picture.file.string(), frame)
              : fmt::format("{}: no element of frame {} sees the height map from above: check "
                            "focus.origin, cell, right, down, up, scale and offset, and that the "
                            "light field and the map have one origin",
                            picture.file.string(), frame));
    const SurfaceFit fitted = SetSurface(inverse, source_.most_blur_px, camera_distance_w_, camera);
    LogDebug(
        "focal surface of frame {}: {} pieces; blur by their planes: {:.3g} elements in the mean, "
        "{:.3g} at most, more than {:g} for {:.2g} % of the elements; {} of {} elements unknown",
        frame, camera->surface->pieces().size(), fitted.mean_blur_px, fitted.most_blur_px,
        source_.most_blur_px,
        100.0 * static_cast<double>(fitted.beyond_count) /
            static_cast<double>(inverse.pixels().size()),
        unknown_count, inverse.pixels().size());
    return {};
  }

  const fs::path& folder_;
  const double camera_distance_w_;
  const SurfaceWork& work_;
  const FocalSurfaceSource& source_;
  CameraPath* const path_;
  std::optional<SurfacePicture> of_all_;  // unset if each frame has a file of its own
};

}  // namespace

Result<Image<float>> ReadSurfaceFile(const fs::path& file, const FocalSurfaceSource& source) {
  const std::string name = file.string();
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(file, kMostFileBytes));
  LF_ASSIGN_OR_RETURN(const ImageFileInfo info, ReadImageInfoBytes(bytes, name));
  LF_RETURN_IF_ERROR(CheckPlaces(info.width, info.height, name));
  const int channel = ChannelOf(info);
  if (channel < 0)
    return InputError(
        fmt::format("{}: has the channels {}; expected one channel, or a channel named Z", name,
                    fmt::join(info.channel_names, ", ")));
  constexpr int kBitsForPeople = 8;
  if (info.bits == kBitsForPeople && source.kind == FocalSurfaceSource::Kind::kDepths &&
      !source.has_scale)
    return InputError(
        fmt::format("{}: has 8 bits, as pictures of depths for people have, and focus.scale is not "
                    "stated: give the .exr or .pfm that lffocus depth writes, or add the scale to "
                    "'focus' in the path, the world units of one grey level",
                    name));
  LF_ASSIGN_OR_RETURN(const StoredImage stored, ReadImageBytes(bytes, name));
  return std::visit([&](const auto& picture) { return ChannelAsFloats(picture, channel); }, stored);
}

Image<float> InverseDepthsOfPicture(const Image<float>& depths, double scale, int width,
                                    int height) {
  Image<float> inverse(width, height);
  const auto inverse_at = [&](int column, int row) {
    const double depth_w = scale * depths.at(column, row);
    return depth_w > 0 && std::isfinite(depth_w) ? 1 / depth_w : 0;
  };
  constexpr double kOneSurface = 1.05;  // largest ratio of the inverse depths of one surface
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) * depths.width() / width - 0.5;
      const double v = (y + 0.5) * depths.height() / height - 0.5;
      const auto clamped = [](double at, int size) {
        return std::clamp(static_cast<int>(std::floor(at)), 0, size - 1);
      };
      const int left = clamped(u, depths.width()), right = clamped(u + 1, depths.width());
      const int top = clamped(v, depths.height()), bottom = clamped(v + 1, depths.height());
      const double s = std::clamp(u - left, 0.0, 1.0), t = std::clamp(v - top, 0.0, 1.0);
      const double q[4] = {inverse_at(left, top), inverse_at(right, top), inverse_at(left, bottom),
                           inverse_at(right, bottom)};
      const auto [least, most] = std::minmax_element(q, q + 4);
      inverse.at(x, y) = static_cast<float>(*least > 0 && *most <= kOneSurface * *least
                                                ? (1 - t) * ((1 - s) * q[0] + s * q[1]) +
                                                      t * ((1 - s) * q[2] + s * q[3])
                                                : q[(t < 0.5 ? 0 : 2) + (s < 0.5 ? 0 : 1)]);
    }
  return inverse;
}

Image<float> InverseDepthsOfHeights(const PinholeCamera& camera, const Image<float>& heights,
                                    const FocalSurfaceSource& source) {
  return InverseDepthsOfMap(camera, HeightMap(heights, source));
}

double NearestCameraDistance(const LightField& light_field) {
  constexpr size_t kSample = 64;
  const size_t count = light_field.size();
  if (count < 2) return 0;
  std::vector<double> nearest;
  const size_t step = std::max<size_t>(1, count / kSample);
  for (size_t i = 0; i < count; i += step) {
    const Vec3 centre = light_field.Camera(LfImageId{static_cast<uint32_t>(i)}).CentreWorld();
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t other = 0; other < count; ++other) {
      // LF images of a bracket have one pose.
      const double d = (light_field.Camera(LfImageId{other}).CentreWorld() - centre).norm();
      if (d > 0) least = std::min(least, d);
    }
    if (std::isfinite(least)) nearest.push_back(least);
  }
  if (nearest.empty()) return 0;
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return *middle;
}

Result<void> MakeFocalSurfaces(const fs::path& folder, double camera_distance_w,
                               const SurfaceWork& work, CameraPath* path) {
  if (!path->focal_surface) return {};
  if (path->shutter.exists() && path->focal_surface->kind == FocalSurfaceSource::Kind::kDepths)
    return InputError(
        "the path has a shutter and a depth picture as its focal surface, which is seen from the "
        "camera of one moment only: use a height map (focus.kind: height), or remove 'shutter'");
  return SurfaceMaker(folder, camera_distance_w, work, path).Run();
}

}  // namespace lf
