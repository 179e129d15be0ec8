// SPDX-License-Identifier: Apache-2.0
#include "lf/api/frame.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "lf/core/version.h"
#include "lf/render/pipeline/frame_output.h"

namespace lf {

Result<Frame> RenderFrame(const Film& film, uint32_t number) {
  if (number < 1 || number > film.path.frame_count())
    return UsageError(
        fmt::format("frame {}: expected a number from 1 to {}, as the path has frames", number,
                    film.path.frame_count()));
  ThreadPool pool(film.work.threads);
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<FilmRenderer> renderer,
                      OpenRenderer(film, {FrameId{number}}, pool));
  LF_RETURN_IF_ERROR(renderer->CheckAnyContributes());
  for (bool is_going_on = true; is_going_on;) {
    LF_ASSIGN_OR_RETURN(is_going_on, renderer->Step());
  }
  LF_RETURN_IF_ERROR(renderer->CheckNotAllBroken());
  Frame frame;
  constexpr bool kWithEffective = true;
  RenderedFrame rendered = renderer->Develop(0, renderer->Complete(0), kWithEffective, {});
  frame.picture = std::move(rendered.picture);
  frame.report = std::move(rendered.report);
  LF_RETURN_IF_ERROR(renderer->Measure(0, &frame.report));
  frame.skipped.assign(renderer->skipped().begin(), renderer->skipped().end());
  frame.notes = renderer->NotesOf(0);
  frame.notes.version = Version();
  return frame;
}

Result<void> SaveFrame(const Frame& frame, const std::filesystem::path& file,
                       std::optional<FrameFormat> format, const PictureOptions& picture) {
  const bool is_exr = file.extension() == ".exr";
  if (!is_exr && file.extension() != ".png")
    return UsageError(fmt::format("{}: expected a name that ends in .exr or .png", file.string()));
  if (!format) format = is_exr ? FrameFormat::kExrHalf : FrameFormat::kPng8;
  if (IsExr(*format) != is_exr)
    return UsageError(
        fmt::format("{}: has not the suffix of the format {}", file.string(), NameOf(*format)));
  return WritePicture(frame.notes, frame.picture, file, *format, picture, {});
}

}  // namespace lf
