// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/frame_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "lf/film/develop/contact_sheet.h"
#include "lf/film/develop/frame_file.h"
#include "lf/film/develop/video.h"
#include "lf/render/pipeline/frame_metadata.h"

namespace lf {
namespace {

// Returns the depth, along the optical axis, at which each element is in focus; infinity where the
// line through its centre and the lens centre does not meet the focus plane in front of the lens.
// Its inverse is a linear form on element positions.
Image<float> FocusDepths(const RenderCamera& camera) {
  const Intrinsics& sensor = camera.pinhole.intrinsics;
  const Plane& plane = camera.focus_plane;
  const double distance_w = plane.offset_w - plane.normal.dot(camera.pinhole.CentreWorld());
  const PixelForm inverse_depth = plane.normal.transpose() *
                                  camera.pinhole.cam_from_world.rotation.transpose() *
                                  sensor.InverseMatrix() / distance_w;
  Image<float> depths(sensor.width_px, sensor.height_px);
  for (int y = 0; y < depths.height(); ++y)
    for (int x = 0; x < depths.width(); ++x) {
      const double inverse = camera.surface ? camera.surface->PieceAt(x, y).At(x + 0.5, y + 0.5)
                                            : Value(inverse_depth, x + 0.5, y + 0.5);
      depths.at(x, y) =
          inverse > 0 ? static_cast<float>(1 / inverse) : std::numeric_limits<float>::infinity();
    }
  return depths;
}

}  // namespace

Result<void> WritePicture(const PlateNotes& notes, DevelopedFrame picture,
                          const std::filesystem::path& to, FrameFormat format,
                          const PictureOptions& options,
                          const std::function<bool()>& is_interrupted, const ImageMetadata& more) {
  if (is_interrupted && is_interrupted())
    return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", to.string())};
  if (options.has_focus_depth && !notes.camera.surface && !notes.FocalSurface().empty())
    return UsageError(
        fmt::format("{}: {{z}}: the frame has a focal surface, which plates only name: leave {{z}} "
                    "out, or render "
                    "the frame as a whole",
                    to.string()));
  ConvertFromRec709(options.colours, &picture.rgb);
  if (options.has_focus_depth) picture.focus_depth_w = FocusDepths(notes.camera);
  ImageMetadata metadata = FileMetadata(notes, format, options.colours);
  metadata.insert(metadata.end(), more.begin(), more.end());
  return WriteFrame(to, picture, format, metadata, is_interrupted, options);
}

FilmFiles FilesOfFilm(const CameraPath& path, const RenderOptions& options) {
  const Intrinsics& plate = path.cameras.front().pinhole.intrinsics;
  return {options.folder.output_folder,
          options.folder.format,
          options.folder.picture.colours,
          plate.width_px,
          plate.height_px,
          path.fps,
          options.signals == nullptr ? nullptr : &options.signals->stop};
}

std::filesystem::path FilmFiles::PathOf(FrameId frame) const {
  return FramePath(folder, frame, format);
}

Result<Image<uint8_t>> FilmFiles::ReadPicture(FrameId frame) const {
  LF_ASSIGN_OR_RETURN(Image<uint8_t> picture, ReadDisplayImage(PathOf(frame), colours));
  if (picture.width() != width_px || picture.height() != height_px)
    return InputError(fmt::format(
        "{}: has {} x {} pixels, expected {} x {}: remove the file, and render this frame again "
        "with {{resume}}",
        PathOf(frame).string(), picture.width(), picture.height(), width_px, height_px));
  return picture;
}

Result<void> FilmFiles::WriteContactSheet(const std::vector<FrameId>& frames, size_t at_once,
                                          ThreadPool& pool, const std::string& name) const {
  const std::vector<size_t> shown = ContactSheetFrames(frames.size());
  ContactSheet sheet(shown.size(), width_px, height_px);
  for (size_t begin = 0; begin < shown.size(); begin += at_once) {
    if (stop != nullptr && *stop)
      return Error{ErrorKind::kInterrupted, "interrupted at the contact sheet"};
    std::vector<std::optional<Error>> errors(std::min(at_once, shown.size() - begin));
    pool.ForEach(errors.size(), [&](size_t i) {
      if (const auto picture = ReadPicture(frames[shown[begin + i]]); picture)
        sheet.Place(begin + i, *picture);
      else
        errors[i] = picture.error();
    });
    for (const std::optional<Error>& error : errors)
      if (error) return *error;
  }
  return sheet.Write(folder / name);
}

Result<void> FilmFiles::WriteVideo(const std::vector<FrameId>& frames,
                                   const std::filesystem::path& video) const {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<VideoWriter> writer,
                      VideoWriter::Open(video, width_px, height_px, fps));
  for (const FrameId frame : frames) {
    if (stop != nullptr && *stop) return Error{ErrorKind::kInterrupted, "interrupted at the video"};
    LF_ASSIGN_OR_RETURN(const Image<uint8_t> picture, ReadPicture(frame));
    LF_RETURN_IF_ERROR(writer->Add(picture));
  }
  return writer->Close();
}

}  // namespace lf
