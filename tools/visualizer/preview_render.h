// A render of one frame while somebody looks: lfrenderer with a small plate, in a folder that is
// removed in the end.
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
  // Posts "preview" to the board: {"frame": 7, "state": "rendering", "changed": "..."}; states are
  // rendering, finished, stopped, failed with a message.
  PreviewRender(const PageArguments& arguments, EventBoard& events);
  ~PreviewRender();  // stops it
  PreviewRender(const PreviewRender&) = delete;
  PreviewRender& operator=(const PreviewRender&) = delete;

  // In place of the one that is at work.
  //   text  a path, checked
  void Start(const std::string& text, FrameId frame);
  void Stop();

  // Of its frames; empty before the first.
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
  bool is_stopped_ = false;  // what is at work is to be left
  bool is_ending_ = false;
  std::filesystem::path root_, folder_;
  int count_ = 0;
  std::thread thread_;  // lfrenderer dies with the thread that started it
};

}  // namespace lf
