// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/json_list.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "lf/camera/path/camera_path.h"
#include "lf/core/byte_stream.h"
#include "lf/light_field/transforms_json/frame_cutter.h"
#include "lf/light_field/transforms_json/json_syntax.h"

namespace lf {
namespace {

Error SyntaxErrorIn(std::string_view text, const std::filesystem::path& file) {
  ByteStream stream(text, file);
  return JsonSyntaxError(&stream);
}

// Returns kInput unless the list has `count` entries, all of them objects.
Result<void> CheckList(const JsonFields& top, const char* key, size_t count) {
  const std::optional<size_t> size = top.ListSize(key);
  if (!size) return top.Wrong(key, "a list of objects, one for each frame");
  if (count == 0)
    return top.Fault(fmt::format(
        "\"{}\" holds no objects: expected at least one, because a path needs a frame", key));
  if (*size < count)
    return top.Fault(fmt::format("the key \"{}\" occurs twice: remove one of the two", key));
  if (*size > count)
    return top.Fault(
        fmt::format("\"{}\" has {} entries, {} of which are no objects: expected only objects", key,
                    *size, *size - count));
  if (count > kMostFrames)
    return top.Fault(
        fmt::format("\"{}\" has {} entries: expected at most {}", key, count, kMostFrames));
  return {};
}

}  // namespace

Result<void> ReadJsonList(std::string_view text, const std::filesystem::path& file,
                          const char* list_key, const ReadFields& read_top,
                          const ReadFields& read_entry) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // some editors begin a text in UTF-8 with it
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  // The parts of the text: a list is wrapped into an object.
  const bool is_list = text.find_first_not_of(" \t\r\n") == text.find('[');
  const std::string opening = is_list ? fmt::format("{{\"{}\":", list_key) : "";
  const auto add_to = [&](FrameCutter* cutter) {
    cutter->Add(opening);
    cutter->Add(text);
    if (is_list) cutter->Add("}");
  };
  size_t count = 0;
  FrameCutter counter(list_key, [&](const std::string&) { ++count; });
  add_to(&counter);
  JsonObject object;
  if (counter.is_not_json() || counter.is_in_frame() || !object.Parse(counter.rest()))
    return SyntaxErrorIn(text, file);
  const JsonFields top(object, file);
  LF_RETURN_IF_ERROR(CheckList(top, list_key, count));
  LF_RETURN_IF_ERROR(read_top(top));

  JsonObject entry;
  size_t index = 0;
  bool is_json = true;
  std::optional<Error> first_error;
  FrameCutter cutter(list_key, [&](const std::string& entry_text) {
    is_json = is_json && entry.Parse(entry_text);
    // After an error, the text is parsed only to see if the file is JSON.
    if (!is_json || first_error) return;
    const Result<void> read = read_entry(JsonFields(entry, file, index++, "", list_key));
    if (!read) first_error = read.error();
  });
  add_to(&cutter);
  if (!is_json) return SyntaxErrorIn(text, file);
  if (first_error) return *first_error;
  return {};
}

Result<void> ReadTopLevel(const std::filesystem::path& file, const char* list_key,
                          JsonObject* top) {
  LF_ASSIGN_OR_RETURN(ByteStream stream, ByteStream::Open(file));
  FrameCutter cutter(list_key, [](const std::string&) {});
  LF_RETURN_IF_ERROR(AddFile(
      &stream, [] { return true; }, &cutter));
  if (cutter.is_not_json() || cutter.is_in_frame() || !top->Parse(cutter.rest())) {
    LF_ASSIGN_OR_RETURN(ByteStream again, ByteStream::Open(file));
    return JsonSyntaxError(&again);
  }
  return {};
}

}  // namespace lf
