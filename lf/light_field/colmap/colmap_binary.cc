// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_binary.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "lf/light_field/colmap/points_seen.h"

namespace lf {
namespace {

// Smallest sizes of entries, in bytes: a camera with two parameters (EQUIRECTANGULAR), an image
// with an empty name and without 2D points, a point with an empty track.
constexpr uint64_t kMinCameraSize = 4 + 4 + 8 + 8 + 2 * 8;
constexpr uint64_t kMinImageSize = 4 + 7 * 8 + 4 + 1 + 8;
constexpr uint64_t kMinPointSize = 8 + 3 * 8 + 3 + 8 + 8;
constexpr uint64_t kPoint2DSize = 8 + 8 + 8;
constexpr uint64_t kTrackEntrySize = 4 + 4;

// Makes errors that name the file, and the entry if the fault is in an entry.
class Place {
 public:
  Place(const ByteStream& stream, const char* kind) : stream_(stream), kind_(kind) {}

  Error Fault(std::string_view message) const {
    return InputError(fmt::format("{}: {}", stream_.path().string(), message));
  }
  Error EntryFault(uint64_t id, std::string_view message) const {
    return Fault(fmt::format("{} {} {}", kind_, id, message));
  }
  // Returns the error of a stream that ends within entry `index` of `count`, or that cannot be
  // read.
  Error CutOff(uint64_t index, uint64_t count) const {
    if (Result<void> status = stream_.Status(); !status) return status.error();
    return Fault(fmt::format("ends within {} {} of {}, at byte {}: it is cut off; copy it again",
                             kind_, index + 1, count, stream_.position() + stream_.remaining()));
  }

 private:
  const ByteStream& stream_;
  const char* kind_;
};

// Reads the count at the start of a file.
Result<uint64_t> TakeCount(ByteStream* stream, const Place& place, const char* things,
                           uint64_t min_entry_size) {
  uint64_t count = 0;
  if (!stream->Take(&count)) {
    LF_RETURN_IF_ERROR(stream->Status());
    return place.Fault(
        fmt::format("has {} bytes: expected at least 8, which hold the number of {}; copy it again",
                    stream->remaining(), things));
  }
  if (count > stream->remaining() / min_entry_size)
    return place.Fault(
        fmt::format("says that it holds {} {}, but has only {} bytes for them: it is cut off, or "
                    "not a binary file of COLMAP; copy it again",
                    count, things, stream->remaining()));
  return count;
}

Result<void> CheckEnd(const ByteStream& stream, const Place& place, const char* things,
                      uint64_t count) {
  if (stream.remaining() == 0) return {};
  return place.Fault(fmt::format(
      "has {} bytes after the last of its {} {}: it is damaged, or of an unsupported version; copy "
      "it again, or convert the model to text (colmap model_converter --output_type TXT)",
      stream.remaining(), count, things));
}

// Reads a name and the 0 that ends it; nullopt if the stream ends before the 0. If a name is too
// long, returns a part of it that is still too long, and AddImage() refuses it.
std::optional<std::string> TakeName(ByteStream* stream) {
  std::string name;
  while (name.size() <= kMaxColmapNameSize) {
    const std::string_view window = stream->Window();
    if (window.empty()) return std::nullopt;
    const size_t end = window.find('\0');
    const size_t taken = std::min(end, window.size());
    name.append(window.substr(0, std::min(taken, kMaxColmapNameSize + 1)));
    stream->Skip(end == std::string_view::npos ? taken : taken + 1);
    if (end != std::string_view::npos) break;
  }
  return name;
}

// Reads an image without its 2D points. Returns false if the stream ends.
bool TakeImage(ByteStream* stream, ColmapImage* image) {
  if (!stream->Take(&image->id) || !stream->Take(&image->quaternion) ||
      !stream->Take(&image->translation) || !stream->Take(&image->camera_id))
    return false;
  std::optional<std::string> name = TakeName(stream);
  if (!name) return false;
  image->name = *std::move(name);
  return true;
}

}  // namespace

Result<void> ReadColmapCamerasBinary(ByteStream* stream, ColmapScene* scene) {
  const Place place(*stream, "camera");
  LF_ASSIGN_OR_RETURN(const uint64_t count, TakeCount(stream, place, "cameras", kMinCameraSize));
  for (uint64_t i = 0; i < count; ++i) {
    uint32_t id = 0;
    int32_t number = 0;
    uint64_t width = 0, height = 0;
    if (!stream->Take(&id) || !stream->Take(&number) || !stream->Take(&width) ||
        !stream->Take(&height))
      return place.CutOff(i, count);
    const Result<ColmapCameraModel> model = FindColmapCameraModel(number);
    if (!model) return place.EntryFault(id, model.error().message);
    std::array<double, kMaxColmapParameterCount> parameters;
    const std::span used(parameters.data(), static_cast<size_t>(model->parameter_count));
    for (double& parameter : used)
      if (!stream->Take(&parameter)) return place.CutOff(i, count);
    if (Result<void> added = scene->AddCamera(id, *model, width, height, used); !added)
      return place.EntryFault(id, added.error().message);
  }
  LF_RETURN_IF_ERROR(CheckEnd(*stream, place, "cameras", count));
  if (Result<void> ended = scene->EndCameras(); !ended) return place.Fault(ended.error().message);
  return {};
}

Result<void> ReadColmapImagesBinary(ByteStream* stream, ColmapScene* scene) {
  const Place place(*stream, "image");
  LF_ASSIGN_OR_RETURN(const uint64_t count, TakeCount(stream, place, "images", kMinImageSize));
  scene->ReserveImages(std::min<uint64_t>(count, kMaxColmapEntryCount));
  for (uint64_t i = 0; i < count; ++i) {
    ColmapImage image;
    if (!TakeImage(stream, &image)) return place.CutOff(i, count);
    const uint32_t id = image.id;
    if (Result<void> added = scene->AddImage(std::move(image)); !added)
      return place.EntryFault(id, added.error().message);
    uint64_t point_count = 0;
    if (!stream->Take(&point_count)) return place.CutOff(i, count);
    if (point_count > stream->remaining() / kPoint2DSize)
      return place.EntryFault(id, fmt::format("says that it has {} 2D points, but only {} bytes "
                                              "are left: the file is damaged; copy it again",
                                              point_count, stream->remaining()));
    stream->Skip(point_count * kPoint2DSize);
  }
  LF_RETURN_IF_ERROR(CheckEnd(*stream, place, "images", count));
  if (Result<void> ended = scene->EndImages(); !ended) return place.Fault(ended.error().message);
  return {};
}

template <class Sink>
Result<void> ReadColmapPointsBinary(ByteStream* stream, Sink* sink) {
  const Place place(*stream, "point");
  LF_ASSIGN_OR_RETURN(const uint64_t count, TakeCount(stream, place, "points", kMinPointSize));
  for (uint64_t i = 0; i < count; ++i) {
    uint64_t id = 0, track_length = 0;
    std::array<double, 3> xyz;
    std::array<uint8_t, 3> rgb;
    double error = 0;
    if (!stream->Take(&id) || !stream->Take(&xyz) || !stream->Take(&rgb) || !stream->Take(&error) ||
        !stream->Take(&track_length))
      return place.CutOff(i, count);
    const Vec3 point_world(xyz.data());
    if (!point_world.allFinite())
      return place.EntryFault(
          id, fmt::format("lies at {}: expected finite numbers", fmt::join(xyz, " ")));
    if (track_length > stream->remaining() / kTrackEntrySize)
      return place.EntryFault(id, fmt::format("says that {} images see it, but only {} bytes are "
                                              "left: the file is damaged; copy it again",
                                              track_length, stream->remaining()));
    if (Result<void> added = sink->AddPoint(id, point_world, track_length > 0); !added)
      return place.EntryFault(id, added.error().message);
    for (uint64_t entry = 0; entry < track_length; ++entry) {
      std::array<uint32_t, 2> image_and_point2d;
      if (!stream->Take(&image_and_point2d)) return place.CutOff(i, count);
      if (Result<void> added = sink->AddObservation(id, point_world, image_and_point2d[0]); !added)
        return place.EntryFault(id, added.error().message);
    }
  }
  return CheckEnd(*stream, place, "points", count);
}
template Result<void> ReadColmapPointsBinary(ByteStream*, ColmapScene*);
template Result<void> ReadColmapPointsBinary(ByteStream*, ColmapPointsSeen*);

Result<uint64_t> CountColmapImagesBinary(ByteStream* stream) {
  return TakeCount(stream, Place(*stream, "image"), "images", kMinImageSize);
}

}  // namespace lf
