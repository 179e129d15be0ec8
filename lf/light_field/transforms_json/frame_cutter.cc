// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/frame_cutter.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace lf {
namespace {

using Characters = std::array<bool, 256>;

constexpr Characters CharactersOf(std::string_view list) {
  Characters table = {};
  for (const char c : list) table[static_cast<unsigned char>(c)] = true;
  return table;
}

// The characters that FrameCutter looks for in strings, in frames, and outside of both.
constexpr Characters kOfStrings = CharactersOf("\"\\");
constexpr Characters kOfFrames = CharactersOf("\"{}");
constexpr Characters kOfRest = CharactersOf("\"{}[]");

size_t Find(const Characters& characters, std::string_view text) {
  size_t i = 0;
  while (i < text.size() && !characters[static_cast<unsigned char>(text[i])]) ++i;
  return i;
}

// Returns true if the key is `wanted`. `key` is the text between the quotation marks, escapes
// included.
bool IsKey(std::string_view key, std::string_view wanted) {
  if (key.find('\\') == std::string_view::npos) return key == wanted;
  const std::string quoted = '"' + std::string(key) + '"';
  return nlohmann::json::parse(quoted, nullptr, false) == wanted;
}

}  // namespace

FrameCutter::FrameCutter(std::string_view list_key, std::function<void(const std::string&)> take)
    : list_key_(list_key), take_(std::move(take)) {}

void FrameCutter::LookForJson(std::string_view piece) {
  if (piece.find('\0') != std::string_view::npos) is_not_json_ = true;
  if (has_begun_) return;
  // Some editors begin a text with the byte order mark of UTF-8.
  constexpr std::string_view kBlanksAndMark = " \t\r\n\xEF\xBB\xBF";
  const size_t begin = piece.find_first_not_of(kBlanksAndMark);
  if (begin == std::string_view::npos) return;
  has_begun_ = true;
  constexpr std::string_view kBeginnings = "{[\"-0123456789tfn";
  if (kBeginnings.find(piece[begin]) == std::string_view::npos) is_not_json_ = true;
}

void FrameCutter::Add(std::string_view piece) {
  LookForJson(piece);
  while (!piece.empty()) {
    size_t taken = 0;
    if (in_string_)
      taken = AddToString(piece, is_in_frame() ? &frame_ : &rest_);
    else
      taken = is_in_frame() ? AddToFrame(piece) : AddToRest(piece);
    piece.remove_prefix(taken);
  }
}

// AddToString(), AddToFrame() and AddToRest() consume `piece` up to and including the next
// character of kOfStrings, kOfFrames or kOfRest, respectively, or all of it if there is none. After
// a backslash in a string, they consume one character. They return the number of consumed bytes.
size_t FrameCutter::AddToString(std::string_view piece, std::string* text) {
  size_t size = 0;
  if (is_escaped_) {
    is_escaped_ = false;
    size = 1;
  } else {
    size = Find(kOfStrings, piece);
    if (size < piece.size()) {
      is_escaped_ = piece[size] == '\\';
      in_string_ = is_escaped_;
      ++size;
    }
  }
  text->append(piece.substr(0, size));
  if (!in_string_ && !is_in_frame() && depth_ == 1) key_size_ = rest_.size() - 1 - key_begin_;
  return size;
}

size_t FrameCutter::AddToFrame(std::string_view piece) {
  size_t size = Find(kOfFrames, piece);
  if (size == piece.size()) {
    frame_.append(piece);
    return size;
  }
  const char c = piece[size++];
  frame_.append(piece.substr(0, size));
  if (c == '"') in_string_ = true;
  if (c == '{') ++frame_depth_;
  if (c == '}' && --frame_depth_ == 0) {
    take_(frame_);
    frame_.clear();
    rest_ += "{}";
  }
  return size;
}

size_t FrameCutter::AddToRest(std::string_view piece) {
  size_t size = Find(kOfRest, piece);
  if (size < piece.size() && piece[size] == '{' && BeginsFrame()) {
    rest_.append(piece.substr(0, size));
    frame_ = '{';
    frame_depth_ = 1;
    return size + 1;
  }
  if (size == piece.size()) {
    rest_.append(piece);
    return size;
  }
  const char c = piece[size++];
  rest_.append(piece.substr(0, size));
  if (c == '"') {
    in_string_ = true;
    if (depth_ == 1) key_begin_ = rest_.size();
  } else if (c == '{' || c == '[') {
    Enter(c);
  } else if (depth_ > 0 && --depth_ == 0) {
    is_over_ = true;
  }
  return size;
}

void FrameCutter::Enter(char bracket) {
  if (depth_ == 0 && bracket == '[') is_over_ = true;
  if (depth_ == 1)
    is_frames_list_ = bracket == '[' && !is_over_ &&
                      IsKey(std::string_view(rest_).substr(key_begin_, key_size_), list_key_);
  ++depth_;
}

Result<void> AddFile(ByteStream* stream, const std::function<bool()>& goes_on,
                     FrameCutter* cutter) {
  if (stream->remaining() > kMostJsonBytes)
    return InputError(fmt::format("{}: has {} bytes: expected a JSON file of at most {}",
                                  stream->path().string(), stream->remaining(), kMostJsonBytes));
  for (std::string_view piece = stream->Window(); !piece.empty(); piece = stream->Window()) {
    cutter->Add(piece);
    stream->Skip(piece.size());
    if (cutter->is_not_json() || !goes_on()) return {};
    if (cutter->held_bytes() > kMostHeldBytes)
      return InputError(
          fmt::format("{}: holds more than {} bytes in one frame or outside of all frames: is it "
                      "another file?",
                      stream->path().string(), kMostHeldBytes));
  }
  return stream->Status();
}

}  // namespace lf
