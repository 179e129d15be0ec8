// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/preview_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "lf/core/spelling.h"
#include "lf/import/paths/open_path.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/render.h"
#include "lf/view/scene_bytes.h"

namespace lf {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr size_t kMemory_bytes = size_t{1} << 30;
constexpr int kPictureSide_px = 1280;
// Time between pictures: at least kBetweenPictures, and at least kPictureTimes times the time that
// the last picture took.
constexpr milliseconds kBetweenPictures(250);
constexpr int kPictureTimes = 3;

//   encoding  of the light field; the frames of mosaics cannot be guarded
FilmSettings SettingsOf(const PageArguments& arguments, const RadianceEncoding& encoding) {
  FilmSettings film = arguments.film;
  film.guard = encoding.bayer == BayerPattern::kNone;
  return film;
}

}  // namespace

PreviewRender::PreviewRender(PageScene& scene)
    : scene_(scene), pool_(scene.arguments().threads), thread_([this] { Run(); }) {}

PreviewRender::~PreviewRender() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
    interrupted_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void PreviewRender::Start(std::shared_ptr<const PathFrames> path, FrameId frame,
                          bool recorded_only) {
  const std::lock_guard lock(mutex_);
  wish_ = {std::move(path), frame, recorded_only};
  interrupted_ = true;
  changed_.notify_all();
}

void PreviewRender::Stop() {
  const std::lock_guard lock(mutex_);
  wish_.reset();
  interrupted_ = true;
}

void PreviewRender::Run() {
  while (true) {
    Wish wish;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_ending_ || wish_; });
      if (is_ending_) return;
      wish = *std::exchange(wish_, std::nullopt);
      interrupted_ = false;
      shown_ = wish.frame;
      picture_.reset();
    }
    Render(wish);
  }
}

void PreviewRender::Render(const Wish& wish) {
  Say(wish, "rendering", "");
  Result<std::string> end = std::string();
  try {
    end = RenderFrame(wish);
  } catch (const std::exception& error) {  // such as lack of memory
    end = OutputError(error.what());
  }
  if (end)
    Say(wish, "finished", *end);
  else if (end.error().kind == ErrorKind::kInterrupted)
    Say(wish, "stopped", "");
  else
    Say(wish, "failed", end.error().message);
}

// Renders the frame and shows pictures of it. Returns a text about LF images that the last picture
// lacks; "" if it lacks none.
Result<std::string> PreviewRender::RenderFrame(const Wish& wish) {
  const PageArguments& arguments = scene_.arguments();
  LightField light_field = scene_.light_field();
  if (wish.recorded_only) light_field = RecordedPart(std::move(light_field));
  FilmSettings film = SettingsOf(arguments, light_field.encoding);
  // The frame is rendered as a film of its own.
  LF_ASSIGN_OR_RETURN(CameraPath path, wish.path->Some(wish.frame, 1));
  if (path.focal_surface) {
    path.focal_surface->file = FileOfFrame(*path.focal_surface, wish.frame.value);
    film.guard = false;  // frames with a focal surface cannot be guarded
  }
  LF_RETURN_IF_ERROR(
      AddFocalSurfaces(arguments.path, light_field, {{wish.frame}, &pool_, &interrupted_}, &path));
  RenderOptions options;
  options.film = std::move(film);
  options.work.memory_bytes = kMemory_bytes;
  options.work.interrupted = options.work.stop = &interrupted_;
  LF_ASSIGN_OR_RETURN(Package package,
                      PackageOfFilm(std::move(light_field), std::move(path), options, pool_));
  LF_ASSIGN_OR_RETURN(
      const std::unique_ptr<FilmRenderer> renderer,
      FilmRenderer::Open(std::move(package), options.film, options.work, {wish.frame}, pool_));
  LF_RETURN_IF_ERROR(renderer->CheckAnyContributes());
  Clock::time_point next_picture = Clock::now();  // the first picture is made at once
  for (bool is_going_on = true; is_going_on;) {
    LF_ASSIGN_OR_RETURN(is_going_on, renderer->Step());
    const Clock::time_point begin = Clock::now();
    if (!is_going_on || begin < next_picture) continue;
    LF_RETURN_IF_ERROR(Show(*renderer));
    Say(wish, "rendering", "");
    next_picture = Clock::now() + std::max<Clock::duration>(kBetweenPictures,
                                                            kPictureTimes * (Clock::now() - begin));
  }
  if (interrupted_) return Error{ErrorKind::kInterrupted, "interrupted"};
  LF_RETURN_IF_ERROR(renderer->CheckNotAllBroken());
  LF_RETURN_IF_ERROR(Show(*renderer));
  if (renderer->skipped().empty()) return std::string();
  return fmt::format("{} of {} LF images were left out, missing or broken; the first: {}",
                     renderer->skipped().size(), renderer->images().size(),
                     renderer->skipped().front().reason);
}

Result<void> PreviewRender::Show(FilmRenderer& renderer) {
  LF_ASSIGN_OR_RETURN(const RenderedFrame frame, renderer.Develop(0));
  auto picture = std::make_shared<const GrowingPicture>(PictureOf(frame.picture, kPictureSide_px));
  const std::lock_guard lock(mutex_);
  picture_ = std::move(picture);
  ++picture_count_;
  return {};
}

PageAnswer PreviewRender::Answer(std::string_view name) const {
  std::shared_ptr<const GrowingPicture> picture;
  {
    const std::lock_guard lock(mutex_);
    if (name == fmt::format("{}.bin", shown_.value)) picture = picture_;
  }
  if (!picture) return Refusal(404, "there is no such frame yet");
  return {200, "application/octet-stream", PictureBytes(*picture)};
}

void PreviewRender::Say(const Wish& wish, const std::string& state, const std::string& message) {
  std::string changed;
  {
    const std::lock_guard lock(mutex_);
    if (picture_) changed = std::to_string(picture_count_);
  }
  const nlohmann::ordered_json json = {{"frame", wish.frame.value},
                                       {"state", state},
                                       {"message", Spelled(message)},
                                       {"changed", changed}};
  scene_.events().Post("preview",
                       json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace lf
