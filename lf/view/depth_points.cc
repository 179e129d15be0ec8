// SPDX-License-Identifier: Apache-2.0
#include "lf/view/depth_points.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>
#include <variant>

#include "lf/core/file.h"
#include "lf/film/develop/display.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_header.h"
#include "lf/view/chosen_points.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr uint64_t kMostFileBytes = uint64_t{4} << 30;

// The channels of a depth map, as indices; -1: the file lacks the channel.
struct DepthChannels {
  int z = -1, confidence = -1;
  std::array<int, 3> rgb = {-1, -1, -1};
  bool has_colours() const { return rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0; }
};

Result<DepthChannels> ChannelsOf(const ImageFileInfo& info, const std::string& name) {
  const auto index_of = [&](const char* wanted) {
    const auto at = std::find(info.channel_names.begin(), info.channel_names.end(), wanted);
    return at == info.channel_names.end() ? -1 : static_cast<int>(at - info.channel_names.begin());
  };
  DepthChannels channels = {
      index_of("Z"), index_of("confidence"), {index_of("R"), index_of("G"), index_of("B")}};
  if (channels.z >= 0) return channels;
  std::string all;
  for (const std::string& channel : info.channel_names) all += (all.empty() ? "" : ", ") + channel;
  return InputError(
      fmt::format("{}: has the channels {}, but no channel Z of depths: give a depth map that "
                  "lffocus depth has written",
                  name, all));
}

// Converts elements and depths to places.
struct DepthCamera {
  Mat3 world_from_ndc = Mat3::Identity();  // maps (u Z, v Z, Z) to the world
  Vec3 centre = Vec3::Zero();
  double width = 0, height = 0;  // of the display window, elements
  double left = 0, top = 0;      // of the picture in the display window

  Vec3 PlaceOf(int x, int y, double z) const {
    return centre +
           z * (world_from_ndc * Vec3((left + x + 0.5) / width, (top + y + 0.5) / height, 1));
  }
};

Result<DepthCamera> CameraOf(const StatedProjection& facts, double unit_m,
                             const std::string& name) {
  if (!facts.world_to_ndc)
    return InputError(
        fmt::format("{}: has no attribute worldToNDC, so that its camera is not known: give a "
                    "depth map that lffocus depth has written, and that no other program has "
                    "converted",
                    name));
  if (facts.unit_m && !IsSameUnit(*facts.unit_m, unit_m))
    return InputError(fmt::format(
        "{}: its attribute lf:unit_m states world units of {:g} m, but those of the light field "
        "are {:g} m: give a depth map of this light field",
        name, *facts.unit_m, unit_m));
  // (x, y, z, 1) times the matrix is (u w, v w, ..., w), and w is the depth.
  const std::array<float, 16>& m = *facts.world_to_ndc;
  Mat3 ndc_from_world;
  Vec3 offset;
  for (int row = 0; row < 3; ++row) {
    const size_t column = row == 2 ? 3 : static_cast<size_t>(row);
    for (size_t axis = 0; axis < 3; ++axis)
      ndc_from_world(row, static_cast<int>(axis)) = double{m[4 * axis + column]};
    offset[row] = double{m[12 + column]};
  }
  DepthCamera camera;
  camera.world_from_ndc = ndc_from_world.inverse();
  camera.centre = -(camera.world_from_ndc * offset);
  camera.width = facts.display_width;
  camera.height = facts.display_height;
  camera.left = facts.left;
  camera.top = facts.top;
  constexpr double kRounding = 1e-4;
  const bool is_depth = std::abs(ndc_from_world.row(2).norm() - 1) < kRounding;
  if (is_depth && camera.world_from_ndc.allFinite() && camera.centre.allFinite() &&
      camera.width > 0 && camera.height > 0)
    return camera;
  return InputError(
      fmt::format("{}: its attribute worldToNDC is not the matrix of a camera whose w is the depth "
                  "in world units, as lffocus depth writes it: give a file of lffocus depth",
                  name));
}

Result<void> CheckElement(float z, float confidence, int x, int y, const std::string& name) {
  if (!(z > 0))
    return InputError(fmt::format(
        "{}: Z is {} in column {} of row {}: expected a depth above 0, or infinity where it is not "
        "known; give a depth map that lffocus depth has written",
        name, z, x, y));
  if (!(confidence >= 0 && confidence <= 1))
    return InputError(
        fmt::format("{}: confidence is {} in column {} of row {}: expected a number from 0 to 1",
                    name, confidence, x, y));
  return {};
}

Result<DepthPoints> ReadDepthMap(const fs::path& file, const Vec3& origin, double unit_m,
                                 size_t most) {
  const std::string name = file.string();
  LF_ASSIGN_OR_RETURN(const PictureHeader header, ReadPictureHeader(file));
  LF_ASSIGN_OR_RETURN(const DepthChannels channels, ChannelsOf(header.info, name));
  LF_ASSIGN_OR_RETURN(const DepthCamera camera, CameraOf(header.projection, unit_m, name));
  LF_ASSIGN_OR_RETURN(const StoredImage stored, ReadImage(file));
  const auto* const picture = std::get_if<Image<float>>(&stored);
  if (picture == nullptr)
    return InputError(
        fmt::format("{}: is no EXR file: expected one that lffocus depth has written", name));
  const auto confidence_at = [&](int x, int y) {
    return channels.confidence >= 0 ? picture->at(x, y, channels.confidence) : 1.0f;
  };
  DepthPoints points;
  for (int y = 0; y < picture->height(); ++y)
    for (int x = 0; x < picture->width(); ++x) {
      const float z = picture->at(x, y, channels.z);
      LF_RETURN_IF_ERROR(CheckElement(z, confidence_at(x, y), x, y, name));
      ++(std::isinf(z) ? points.unknown_count : points.count_in_file);
    }
  if (points.count_in_file == 0)
    return InputError(
        fmt::format("{}: no element has a depth: make the map with other distances ({{near}}, "
                    "{{far}}), a wider "
                    "lens or a lower {{confidence}} of lffocus depth",
                    name));
  points.has_confidence = channels.confidence >= 0;
  points.has_colours = channels.has_colours();
  points.centre = camera.centre - origin;
  ChosenPoints chosen(points.count_in_file, most);
  points.spread = camera.world_from_ndc.col(0).norm() / camera.width *
                  std::sqrt(static_cast<double>(chosen.step()));
  static const Display8 display8;
  for (int y = 0; y < picture->height(); ++y)
    for (int x = 0; x < picture->width(); ++x) {
      const float z = picture->at(x, y, channels.z);
      if (std::isinf(z) || !chosen.TakesNext()) continue;
      const Vec3 place = camera.PlaceOf(x, y, double{z}) - origin;
      points.places.push_back({static_cast<float>(place.x()), static_cast<float>(place.y()),
                               static_cast<float>(place.z())});
      std::array<uint8_t, 4> colour = {kColourless, kColourless, kColourless,
                                       ByteOfConfidence(double{confidence_at(x, y)})};
      for (size_t c = 0; c < 3 && points.has_colours; ++c)
        colour[c] = display8(picture->at(x, y, channels.rgb[c]));
      points.colours.push_back(colour);
    }
  return points;
}

}  // namespace

Result<DepthPoints> ReadDepthPoints(const fs::path& file, const Vec3& origin, double unit_m,
                                    size_t most) {
  if (file.extension() == ".exr") return ReadDepthMap(file, origin, unit_m, most);
  if (file.extension() != ".ply")
    return UsageError(
        fmt::format("{}: expected a depth map (.exr) or a point cloud (.ply) that lffocus depth "
                    "has written",
                    file.string()));
  LF_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(file, kMostFileBytes));
  return ReadPlyPoints(bytes, file.string(), origin, unit_m, most);
}

std::string DepthBytes(const DepthPoints& points) {
  const auto count = static_cast<uint32_t>(points.places.size());
  std::string bytes(sizeof(count), '\0');
  std::memcpy(bytes.data(), &count, sizeof(count));
  bytes.append(reinterpret_cast<const char*>(points.places.data()), 12 * points.places.size());
  bytes.append(reinterpret_cast<const char*>(points.colours.data()), 4 * points.colours.size());
  return bytes;
}

}  // namespace lf
