// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/json_syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

namespace lf {
namespace {

using nlohmann::json;

// Iterates over the characters of a stream, as nlohmann's parser needs it.
class StreamIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  // `stream` is null for the iterator that stands for the end.
  explicit StreamIterator(ByteStream* stream = nullptr) : stream_(stream) {}
  char operator*() const { return stream_->Window().front(); }
  StreamIterator& operator++() {
    stream_->Skip(1);
    return *this;
  }
  // Returns true at the end of the stream, because the parser compares only with the end iterator.
  bool operator==(const StreamIterator&) const { return stream_->Window().empty(); }

 private:
  ByteStream* stream_;
};

// Returns advice on the usual mistakes. `what` is the parser's message, which ends with the text
// that it read last.
std::string_view AdviceOn(std::string_view what) {
  const auto has = [what](std::string_view part) { return what.find(part) != what.npos; };
  if (has("unexpected end of input") && has("line 1, column 1:")) return "; the file is empty";
  if (has("unexpected ']'") || has("unexpected '}'; expected string literal"))
    return "; is there a comma too many before it?";
  if (has("invalid literal") && (has(" N'") || has(",N'") || has("[N'")))
    return "; NaN is no number of JSON: a program has written a pose or calibration that it could "
           "not compute";
  if (has("line 1, column 1:") && has("invalid literal"))
    return "; it has to be text in UTF-8 that begins with {";
  return "";
}

}  // namespace

Error IsNotJson(const std::filesystem::path& file, std::string_view what) {
  what.remove_prefix(std::min(what.size(), what.find("] ") + 2));  // drops "[json.exception...] "
  const std::string_view advice = AdviceOn(what);
  // If the first character is already wrong, the text is left out of the message, because it may
  // not be UTF-8 and then cannot be shown.
  if (advice.find("UTF-8") != advice.npos) what = what.substr(0, what.find("; last read"));
  return InputError(fmt::format("{}: is not JSON: {}{}", file.string(), what, advice));
}

std::string WithQuotedNan(std::string_view text) {
  constexpr std::string_view kWords[] = {"NaN", "Infinity", "-Infinity"};
  std::string quoted;
  bool in_string = false;
  while (!text.empty()) {
    size_t size = 1;
    std::string_view mark;
    if (in_string) {
      size = std::min(text.size(), size_t{text[0] == '\\' ? 2u : 1u});  // an escape hides a quote
    } else {
      for (const std::string_view word : kWords)
        if (text.starts_with(word)) {
          mark = "\"";
          size = word.size();
        }
    }
    if (text[0] == '"') in_string = !in_string;
    quoted += mark;
    quoted += text.substr(0, size);
    quoted += mark;
    text.remove_prefix(size);
  }
  return quoted;
}

Error JsonSyntaxError(ByteStream* stream) {
  std::optional<Error> error;
  try {
    const auto keep_nothing = [](int, json::parse_event_t, const json&) { return false; };
    const json nothing = json::parse(StreamIterator(stream), StreamIterator(), keep_nothing);
  } catch (const json::exception& exception) {
    error = IsNotJson(stream->path(), exception.what());
    // The parser takes a NUL byte for the end of the text.
    if (stream->remaining() > 0 &&
        std::string_view(exception.what()).find("unexpected end") != std::string_view::npos)
      error = InputError(fmt::format(
          "{}: is not JSON: byte {} is a NUL byte, which no text has: was the file cut off, or not "
          "copied to its end?",
          stream->path().string(), stream->position()));
  }
  if (Result<void> status = stream->Status(); !status) return status.error();
  if (error) return *error;
  return InputError(
      fmt::format("{}: changed while it was read; try again when no other program writes it",
                  stream->path().string()));
}

}  // namespace lf
