// SPDX-License-Identifier: Apache-2.0
// Renders one frame in this process while the user looks at it. The page sends a path with a small
// plate.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_scene.h"

#include "lf/camera/path/evaluate_path.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/view/watched_render.h"

namespace lf {

class PreviewRender {
 public:
  // Posts "preview" to the scene's board: {"frame": 7, "state": "rendering", "message": "",
  // "changed": "3"}. States are rendering, finished, stopped and failed. The message of a failed
  // render is its error, and of a finished one the LF images that it lacks. "changed" differs for
  // every picture, and is "" before the first picture of a render.
  explicit PreviewRender(PageScene& scene);
  ~PreviewRender();  // stops the render
  PreviewRender(const PreviewRender&) = delete;
  PreviewRender& operator=(const PreviewRender&) = delete;

  // Starts a render, and stops the current one.
  //   recorded_only  true: virtual LF images are left out
  void Start(std::shared_ptr<const PathFrames> path, FrameId frame, bool recorded_only);
  void Stop();

  // Answers the name "7.bin" with the newest picture of frame 7; with 404 if the current or last
  // render is not of frame 7, or has no picture yet.
  PageAnswer Answer(std::string_view name) const;

 private:
  struct Wish {
    std::shared_ptr<const PathFrames> path;
    FrameId frame;
    bool recorded_only = false;
  };
  void Run();
  void Render(const Wish& wish);
  Result<std::string> RenderFrame(const Wish& wish);
  Result<void> Show(FilmRenderer& renderer);
  void Say(const Wish& wish, const std::string& state, const std::string& message);

  PageScene& scene_;
  ThreadPool pool_;  // separate, so that the page's answers do not wait for the render
  std::atomic<bool> interrupted_ = false;  // true if the current render is to end
  mutable std::mutex mutex_;               // guards the members below, except thread_
  std::condition_variable changed_;
  std::optional<Wish> wish_;
  bool is_ending_ = false;
  FrameId shown_;
  std::shared_ptr<const GrowingPicture> picture_;  // picture of frame shown_; null before the first
  uint64_t picture_count_ = 0;
  std::thread thread_;
};

}  // namespace lf
