// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/depth_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "lf/analysis/depth/lens_views.h"
#include "lf/core/file.h"
#include "lf/core/value_named.h"
#include "lf/film/develop/display.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/pipeline/frame_metadata.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little);

// Returns the depths to write: infinity where unknown.
Image<float> DepthsOf(const DepthMap& map, bool is_filled) {
  if (is_filled) return map.filled_w;
  Image<float> depths = map.depth_w;
  for (float& depth : depths.pixels())
    if (std::isnan(depth)) depth = std::numeric_limits<float>::infinity();
  return depths;
}

template <class T>
void Append(T value, std::string* bytes) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes->append(raw, sizeof(T));
}

std::string PfmOf(const Image<float>& depths) {
  std::string bytes = fmt::format("Pf\n{} {}\n-1\n", depths.width(), depths.height());
  for (int y = depths.height() - 1; y >= 0; --y)
    for (int x = 0; x < depths.width(); ++x) Append(depths.at(x, y), &bytes);
  return bytes;
}

std::string PlyOf(const DepthMap& map, const Image<float>& depths, const Image<float>& rgb) {
  static const Display8 display8;
  size_t count = 0;
  std::string points;
  for (int y = 0; y < depths.height(); ++y)
    for (int x = 0; x < depths.width(); ++x) {
      const float depth = depths.at(x, y);
      if (!std::isfinite(depth)) continue;
      const Vec3 point = PointAt(map.notes.camera, x + 0.5, y + 0.5, double{depth});
      for (int i = 0; i < 3; ++i) Append(static_cast<float>(point[i]), &points);
      for (int c = 0; c < 3; ++c) Append(display8(rgb.at(x, y, c)), &points);
      Append(map.confidence.at(x, y), &points);
      ++count;
    }
  return fmt::format(
             "ply\nformat binary_little_endian 1.0\ncomment world units; {} m each\nelement vertex "
             "{}\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
             "property uchar green\nproperty uchar blue\nproperty float confidence\nend_header\n",
             map.notes.camera.unit_m, count) +
         points;
}

// Returns values from 0 (far or unknown) to 1 (near).
Image<float> Nearness(const DepthMap& map, const Image<float>& depths) {
  const double near = 1 / map.planes_w[1], far = 1 / map.planes_w[map.planes_w.size() - 2];
  Image<float> grey(depths.width(), depths.height());
  for (int y = 0; y < grey.height(); ++y)
    for (int x = 0; x < grey.width(); ++x)
      grey.at(x, y) = static_cast<float>(
          std::clamp((1 / double{depths.at(x, y)} - far) / (near - far), 0.0, 1.0));
  return grey;
}

}  // namespace

std::optional<DepthFormat> DepthFormatOf(const fs::path& file) {
  const std::array names = {".exr", ".pfm", ".ply", ".png"};
  for (size_t i = 0; i < names.size(); ++i)
    if (file.extension() == names[i]) return static_cast<DepthFormat>(i);
  return std::nullopt;
}

Result<void> WriteDepth(const fs::path& file, const DepthMap& map, const DevelopedFrame& picture,
                        bool is_filled) {
  const Image<float> depths = DepthsOf(map, is_filled);
  switch (*DepthFormatOf(file)) {
    case DepthFormat::kExr: {
      std::vector<ExrChannel> channels;
      for (const auto& [name, channel] : {std::pair("R", 0), std::pair("G", 1), std::pair("B", 2)})
        channels.push_back({name, picture.rgb.view(), channel, true});
      channels.push_back({"Z", depths.view(), 0, false});
      channels.push_back({"confidence", map.confidence.view(), 0, true});
      return WriteExr(file, channels,
                      FileMetadata(map.notes, FrameFormat::kExrHalf, ColourSpace::kRec709));
    }
    case DepthFormat::kPfm:
      return WriteFileAtomically(file, PfmOf(depths));
    case DepthFormat::kPly:
      return WriteFileAtomically(file, PlyOf(map, depths, picture.rgb));
    case DepthFormat::kPng:
      break;
  }
  return WriteImage(file, Nearness(map, depths).view(), {"Y"}, PixelType::kUint8);
}

}  // namespace lf
