// Cuts the text of a transforms.json into its frames and the rest, without understanding either:
// it sees brackets and quotation marks only. Internal to native.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace lf {

// Of a text that is JSON, the frames are the objects {...} in the lists of the top level's keys
// "frames". Of any other text: if the rest is JSON and every frame is, so is the whole.
class FrameCutter {
 public:
  // `take` is called with each frame when its text is complete.
  explicit FrameCutter(std::function<void(const std::string& frame)> take);

  // The text comes in pieces of any size, from front to back.
  void Add(std::string_view piece);

  // What is not of frames so far; {} stands for each of them.
  const std::string& rest() const { return rest_; }
  // Whether the text so far ends within a frame.
  bool is_in_frame() const { return frame_depth_ > 0; }
  // Bytes of the rest and of the frame that has begun: all that is kept.
  size_t held_bytes() const { return rest_.size() + frame_.size(); }

 private:
  size_t AddToString(std::string_view piece, std::string* text);
  size_t AddToFrame(std::string_view piece);
  size_t AddToRest(std::string_view piece);
  void Enter(char bracket);
  bool BeginsFrame() const { return depth_ == 2 && is_frames_list_; }

  std::function<void(const std::string&)> take_;
  std::string rest_, frame_;
  bool in_string_ = false;
  bool is_escaped_ = false;      // by a backslash before this character
  size_t frame_depth_ = 0;       // brackets {} that are open in the frame
  size_t depth_ = 0;             // brackets of both kinds that are open in the rest
  size_t key_begin_ = 0;         // the last string of the top level, in rest_
  size_t key_size_ = 0;          // without its quotation marks
  bool is_frames_list_ = false;  // the bracket at depth 1 -> 2 is that of "frames": [
  bool is_over_ = false;         // the top level was closed, or is no object: no frames any more
};

}  // namespace lf
