// SPDX-License-Identifier: Apache-2.0
// Splits the text of a JSON file, such as a transforms.json, into the objects of one long list and
// the rest. It only looks at brackets and quotation marks and does not parse values. Used by the
// readers of calibrations and camera paths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "lf/core/byte_stream.h"
#include "lf/core/result.h"

namespace lf {

// If the text is JSON, the frames are the objects {...} in all lists with the given key of the top
// level, such as "frames". Conversely, the whole text is JSON if the rest and every frame are JSON.
class FrameCutter {
 public:
  // Calls `take` with each frame as soon as its text is complete.
  //   list_key  key of the list; must outlive this object
  FrameCutter(std::string_view list_key, std::function<void(const std::string& frame)> take);

  // Adds the next piece of the text, of any size.
  void Add(std::string_view piece);

  // Returns true if the text so far cannot be the beginning of JSON, because its first character
  // behind blanks begins no value, or because it holds a NUL byte, as the holes of a sparse file
  // do. The rest of the text need not be read.
  bool is_not_json() const { return is_not_json_; }

  // Returns the text outside frames so far, with {} in place of each frame.
  const std::string& rest() const { return rest_; }
  // Returns true if the text so far ends inside a frame.
  bool is_in_frame() const { return frame_depth_ > 0; }
  // Returns the size of all text that is kept in memory: the rest, and the frame that is not
  // complete yet.
  size_t held_bytes() const { return rest_.size() + frame_.size(); }

 private:
  size_t AddToString(std::string_view piece, std::string* text);
  size_t AddToFrame(std::string_view piece);
  size_t AddToRest(std::string_view piece);
  void Enter(char bracket);
  bool BeginsFrame() const { return depth_ == 2 && is_frames_list_; }

  void LookForJson(std::string_view piece);

  std::string_view list_key_;
  std::function<void(const std::string&)> take_;
  std::string rest_, frame_;
  bool in_string_ = false;
  bool is_escaped_ = false;  // true if a backslash in a string precedes the next character
  size_t frame_depth_ = 0;   // number of open brackets { in the frame; 0 outside frames
  size_t depth_ = 0;         // number of open brackets { and [ in rest_
  size_t key_begin_ = 0;     // index in rest_ at which the last string of the top level begins
  size_t key_size_ = 0;      // size of this string without quotation marks, in bytes
  bool is_frames_list_ =
      false;                // true if the last bracket that opened depth 2 is that of list_key_
  bool has_begun_ = false;  // true behind the blanks at the beginning
  bool is_not_json_ = false;
  bool is_over_ = false;  // true if no frame can follow: the top level ended or is no object
};

// Largest size of a file.
inline constexpr uint64_t kMostJsonBytes = uint64_t{4} << 30;
// Largest FrameCutter::held_bytes() while a file is added.
inline constexpr size_t kMostHeldBytes = size_t{256} << 20;

// Adds a file up to its end, or as far as it may be JSON. kInput if it cannot be read, is larger
// than kMostJsonBytes, or more than kMostHeldBytes would be held.
//   goes_on  called after each piece; false: the rest is not read
Result<void> AddFile(ByteStream* stream, const std::function<bool()>& goes_on, FrameCutter* cutter);

}  // namespace lf
