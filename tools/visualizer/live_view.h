// SPDX-License-Identifier: Apache-2.0
// Live pictures for the page: frames that are rendered while a person drags something.
#pragma once

#include <atomic>
#include <cstddef>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "tools/visualizer/page_answers.h"
#include "tools/visualizer/page_scene.h"

#include "lf/camera/render_camera.h"
#include "lf/core/parallel.h"
#include "lf/live/live_renderer.h"

namespace lf {

class LiveView {
 public:
  // Posts "live" to the scene's board when LF images have been loaded: {"resident": 60, "wanted":
  // 200, "done": 60, "broken": 0, "version": 17} (ResidentImages::Status).
  //   memory_bytes  LiveOptions::memory_bytes
  LiveView(PageScene& scene, size_t memory_bytes);

  // Answers with a picture of the frame (doc/formats/page_data.md, POST live).
  //   budget_s, recorded_only  as in LiveWish. A picture without a budget is a still one: it is
  //                            broken off by the next call, and then answered with
  //                            {"superseded": true}
  PageAnswer Answer(const RenderCamera& frame, std::optional<double> budget_s, bool recorded_only);

  // Answers with the lens of a picture that the browser renders, of at most `most_images` LF images
  // (doc/formats/page_data.md, POST lens).
  //   recorded_only  as in LiveWish
  PageAnswer AnswerLens(const RenderCamera& frame, size_t most_images, bool recorded_only);
  // Breaks off still pictures from now on, because the server ends. Any thread may call it.
  void End();
  // Answers GET live/NAME: the shrunken LF image "DIVISOR/ID.bin". 404 if it is not in memory.
  PageAnswer AnswerImage(std::string_view name);

 private:
  void Tell();
  std::atomic<bool>* BreakOffStillPictures(bool is_still);
  nlohmann::ordered_json FactsOfImages() const;
  std::string BytesOf(const LivePicture& live) const;

  PageScene& scene_;
  const size_t memory_bytes_;
  ThreadPool pool_;  // separate, so that the page's answers do not wait for pictures
  std::mutex mutex_;
  bool is_ending_ = false;  // guarded by mutex_
  // For each still picture that is waited for, a flag that breaks it off. Guarded by mutex_.
  std::list<std::atomic<bool>> still_;
  LiveRenderer renderer_;
};

}  // namespace lf
