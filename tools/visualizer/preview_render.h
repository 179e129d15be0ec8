// Renders one frame while the user looks at it: lfrenderer with a small plate, in a folder that is
// removed at the end.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tools/visualizer/event_board.h"
#include "tools/visualizer/page_scene.h"

#include "lf/core/ids.h"
#include "lf/core/result.h"

namespace lf {

class PreviewRender {
 public:
  // Posts "preview" to the board: {"frame": 7, "state": "rendering", "changed": "..."}. States are
  // rendering, finished, stopped, and failed with a message.
  PreviewRender(const PageArguments& arguments, EventBoard& events);
  ~PreviewRender();  // stops the render
  PreviewRender(const PreviewRender&) = delete;
  PreviewRender& operator=(const PreviewRender&) = delete;

  // Starts a render, and stops the current one.
  //   text  a path, checked
  void Start(const std::string& text, FrameId frame);
  void Stop();

  // Returns the folder of the frames; empty before the first render.
  std::filesystem::path folder() const;

 private:
  struct Wish {
    std::string text;
    FrameId frame;
  };
  void Run();
  void Render(const Wish& wish);
  bool IsSuperseded();
  void Say(const Wish& wish, const std::string& state, const std::string& message);

  const PageArguments arguments_;
  EventBoard& events_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Wish> wish_;
  bool is_stopped_ = false;  // the current render is to be stopped
  bool is_ending_ = false;
  std::filesystem::path root_, folder_;
  int count_ = 0;
  std::thread thread_;  // lfrenderer dies with this thread, which starts it
};

}  // namespace lf
