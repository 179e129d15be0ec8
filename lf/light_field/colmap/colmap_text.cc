// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/colmap_text.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "lf/core/log.h"
#include "lf/light_field/colmap/points_seen.h"
#include "lf/light_field/colmap/text_words.h"

namespace lf {
namespace {

Result<uint32_t> TakeId(TextWords* words, const char* name) {
  LF_ASSIGN_OR_RETURN(const uint64_t id, words->Whole(name, UINT32_MAX));
  return static_cast<uint32_t>(id);
}

Result<void> TakeCamera(TextWords* words, ColmapScene* scene) {
  LF_ASSIGN_OR_RETURN(const uint32_t id, TakeId(words, "CAMERA_ID"));
  const auto fault = [&](const std::string& message) {
    return words->Fault(fmt::format("camera {} {}", id, message));
  };
  const Result<ColmapCameraModel> model = FindColmapCameraModel(words->Word());
  if (!model) return fault(model.error().message);
  LF_ASSIGN_OR_RETURN(const uint64_t width, words->Whole("WIDTH", UINT64_MAX));
  LF_ASSIGN_OR_RETURN(const uint64_t height, words->Whole("HEIGHT", UINT64_MAX));
  std::array<double, kMaxColmapParameterCount> parameters;
  const std::span used(parameters.data(), static_cast<size_t>(model->parameter_count));
  for (size_t i = 0; i < used.size(); ++i) {
    const std::string name = fmt::format("PARAMS[{}] of {} {}", i, used.size(), model->name);
    LF_ASSIGN_OR_RETURN(used[i], words->Number(name.c_str()));
  }
  if (!words->Word().empty())
    return fault(fmt::format("has more parameters than the {} of {}", used.size(), model->name));
  if (Result<void> added = scene->AddCamera(id, *model, width, height, used); !added)
    return fault(added.error().message);
  return {};
}

// Reads the first of the two lines of an image.
Result<ColmapImage> TakeImage(TextWords* words) {
  ColmapImage image;
  LF_ASSIGN_OR_RETURN(image.id, TakeId(words, "IMAGE_ID"));
  constexpr const char* kQuaternion[] = {"QW", "QX", "QY", "QZ"};
  for (size_t i = 0; i < 4; ++i) {
    LF_ASSIGN_OR_RETURN(image.quaternion[i], words->Number(kQuaternion[i]));
  }
  constexpr const char* kTranslation[] = {"TX", "TY", "TZ"};
  for (size_t i = 0; i < 3; ++i) {
    LF_ASSIGN_OR_RETURN(image.translation[i], words->Number(kTranslation[i]));
  }
  LF_ASSIGN_OR_RETURN(image.camera_id, TakeId(words, "CAMERA_ID"));
  image.name = words->Rest(kMaxColmapNameSize);
  return image;
}

// Skips the second of the two lines of an image. The last image of a file may lack it.
Result<void> SkipPoints2D(TextWords* words, uint32_t image_id) {
  if (!words->NextLine()) return {};
  const std::optional<uint64_t> count = words->SkipNumbers();
  if (!count || *count % 3 != 0)
    return words->Fault(
        fmt::format("expected the 2D points of the image with ID {} (three numbers X Y POINT3D_ID "
                    "for each point), or an empty line if it has none",
                    image_id));
  return {};
}

template <class Sink>
Result<void> TakePoint(TextWords* words, Sink* sink) {
  LF_ASSIGN_OR_RETURN(const uint64_t id, words->Whole("POINT3D_ID", UINT64_MAX));
  Vec3 point_world;
  constexpr const char* kPosition[] = {"X", "Y", "Z"};
  for (int i = 0; i < 3; ++i) {
    LF_ASSIGN_OR_RETURN(point_world[i], words->Number(kPosition[i]));
  }
  for (const char* colour : {"R", "G", "B"}) LF_RETURN_IF_ERROR(words->Whole(colour, 255));
  LF_RETURN_IF_ERROR(words->Number("ERROR"));
  if (Result<void> added = sink->AddPoint(id, point_world, !words->AtLineEnd()); !added)
    return words->Fault(fmt::format("point {} {}", id, added.error().message));
  while (!words->AtLineEnd()) {
    LF_ASSIGN_OR_RETURN(const uint32_t image_id, TakeId(words, "IMAGE_ID of a track"));
    LF_RETURN_IF_ERROR(TakeId(words, "POINT2D_IDX of a track"));
    if (Result<void> added = sink->AddObservation(id, point_world, image_id); !added)
      return words->Fault(fmt::format("point {} {}", id, added.error().message));
  }
  return {};
}

}  // namespace

Result<void> ReadColmapCamerasText(ByteStream* stream, ColmapScene* scene) {
  TextWords words(stream);
  while (words.NextEntry()) LF_RETURN_IF_ERROR(TakeCamera(&words, scene));
  LF_RETURN_IF_ERROR(stream->Status());
  if (Result<void> ended = scene->EndCameras(); !ended)
    return InputError(fmt::format("{}: {}", stream->path().string(), ended.error().message));
  return {};
}

Result<void> ReadColmapImagesText(ByteStream* stream, ColmapScene* scene) {
  TextWords words(stream);
  while (words.NextEntry()) {
    LF_ASSIGN_OR_RETURN(ColmapImage image, TakeImage(&words));
    const uint32_t id = image.id;
    if (Result<void> added = scene->AddImage(std::move(image)); !added)
      return words.Fault(fmt::format("image {} {}", id, added.error().message));
    LF_RETURN_IF_ERROR(SkipPoints2D(&words, id));
  }
  LF_RETURN_IF_ERROR(stream->Status());
  if (Result<void> ended = scene->EndImages(); !ended)
    return InputError(fmt::format("{}: {}", stream->path().string(), ended.error().message));
  // If a file was cut off between two images, only the number of images at its start reveals it.
  if (words.announced_count().value_or(scene->image_count()) != scene->image_count())
    LogWarning(
        "{}: holds {} images, but the comment at its start states {}: was it edited, or is it cut "
        "off?",
        stream->path().string(), scene->image_count(), *words.announced_count());
  return {};
}

template <class Sink>
Result<void> ReadColmapPointsText(ByteStream* stream, Sink* sink) {
  TextWords words(stream);
  while (words.NextEntry()) LF_RETURN_IF_ERROR(TakePoint(&words, sink));
  return stream->Status();
}
template Result<void> ReadColmapPointsText(ByteStream*, ColmapScene*);
template Result<void> ReadColmapPointsText(ByteStream*, ColmapPointsSeen*);

Result<uint64_t> CountColmapImagesText(ByteStream* stream) {
  TextWords words(stream);
  uint64_t count = 0;
  while (words.NextEntry()) {
    ++count;
    words.NextLine();
  }
  LF_RETURN_IF_ERROR(stream->Status());
  return count;
}

}  // namespace lf
