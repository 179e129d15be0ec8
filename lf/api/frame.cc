// SPDX-License-Identifier: Apache-2.0
#include "lf/api/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "lf/core/check.h"
#include "lf/core/parallel.h"
#include "lf/core/version.h"
#include "lf/film/develop/frame_file.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/pipeline/render.h"

namespace lf {

struct FrameRenderer::State {
  ThreadPool pool;
  std::unique_ptr<FilmRenderer> renderer = nullptr;
};

FrameRenderer::FrameRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
FrameRenderer::FrameRenderer(FrameRenderer&&) noexcept = default;
FrameRenderer& FrameRenderer::operator=(FrameRenderer&&) noexcept = default;
FrameRenderer::~FrameRenderer() = default;

Result<FrameRenderer> FrameRenderer::Open(const Film& film, std::vector<FrameId> frames) {
  for (const FrameId frame : frames)
    if (!film.path.frames().Has(frame))
      return UsageError(
          fmt::format("frame {}: expected a number from {} to {}, as the path has frames",
                      frame.value, film.path.frames().first, film.path.frames().last()));
  if (std::adjacent_find(frames.begin(), frames.end(), std::greater_equal<>()) != frames.end())
    return UsageError("the numbers of frames are not in ascending order: sort them");
  std::unique_ptr<State> state(new State{ThreadPool(film.work.threads)});
  const RenderOptions options = {
      .frames = frames, .film = film.settings, .work = film.work, .folder = {}};
  LF_ASSIGN_OR_RETURN(Package package,
                      PackageOfFilm(film.light_field, film.path, options, state->pool));
  LF_ASSIGN_OR_RETURN(state->renderer,
                      FilmRenderer::Open(std::move(package), film.settings, film.work,
                                         std::move(frames), state->pool));
  LF_RETURN_IF_ERROR(state->renderer->CheckAnyContributes());
  return FrameRenderer(std::move(state));
}

Result<bool> FrameRenderer::Step() {
  LF_ASSIGN_OR_RETURN(const bool is_going_on, state_->renderer->Step());
  if (!is_going_on) LF_RETURN_IF_ERROR(state_->renderer->CheckNotAllBroken());
  return is_going_on;
}

double FrameRenderer::progress() const {
  const size_t count = state_->renderer->images().size();
  if (count == 0) return 1;
  return static_cast<double>(state_->renderer->progress().image_count) / static_cast<double>(count);
}

size_t FrameRenderer::size() const { return state_->renderer->frame_count(); }

Result<Frame> FrameRenderer::Develop(size_t index) {
  FilmRenderer& renderer = *state_->renderer;
  LF_CHECK(index < renderer.frame_count());
  const WorkSettings& work = renderer.setup().work();
  constexpr bool kWithEffective = true;
  LF_ASSIGN_OR_RETURN(const std::optional<Completion> completion, renderer.Complete(index, false));
  RenderedFrame rendered =
      renderer.Develop(index, completion, kWithEffective, [&] { return work.IsStopped(); });
  if (work.IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted"};
  Frame frame;
  frame.picture = std::move(rendered.picture);
  frame.report = std::move(rendered.report);
  LF_RETURN_IF_ERROR(renderer.Measure(index, &frame.report));
  frame.skipped.assign(renderer.skipped().begin(), renderer.skipped().end());
  PlateNotes notes = renderer.NotesOf(index);
  notes.version = Version();
  frame.notes = std::make_shared<const PlateNotes>(std::move(notes));
  return frame;
}

Result<Frame> RenderFrame(const Film& film, uint32_t number) {
  LF_ASSIGN_OR_RETURN(FrameRenderer renderer, FrameRenderer::Open(film, {FrameId{number}}));
  for (bool is_going_on = true; is_going_on;) {
    LF_ASSIGN_OR_RETURN(is_going_on, renderer.Step());
  }
  return renderer.Develop(0);
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
  if (frame.notes == nullptr)
    return UsageError(fmt::format(
        "{}: the frame has no notes, because RenderFrame() did not make it", file.string()));
  if (picture.channels == FrameChannels::kRgba && frame.picture.opacity.empty())
    return UsageError(fmt::format(
        "{}: the frame has no alpha: set FilmSettings::adds_opacity before it is rendered",
        file.string()));
  return WritePicture(*frame.notes, frame.picture, file, *format, picture, {});
}

}  // namespace lf
