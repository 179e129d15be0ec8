// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/path_kind.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <system_error>

#include "lf/camera/path/yaml_tree.h"
#include "lf/core/byte_stream.h"
#include "lf/core/parse_number.h"
#include "lf/light_field/colmap/read_colmap.h"

namespace lf {
namespace {

constexpr std::string_view kWhiteSpace = " \t\r\n";

// Returns the text behind blanks, line ends, and the mark of UTF-8 that some editors write.
std::string_view WithoutStart(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(kWhiteSpace)));
  return text;
}

// Returns the position behind the string in quotation marks that begins at `begin`.
size_t EndOfString(std::string_view text, size_t begin) {
  size_t at = begin + 1;
  while (at < text.size() && text[at] != '"') at += text[at] == '\\' ? 2 : 1;
  return std::min(at + 1, text.size());
}

// Returns true if the text is an object or a list in the syntax of JSON. A YAML text in flow style
// begins with a bracket as well, but its keys need no quotation marks.
bool LooksLikeJson(std::string_view text) {
  text = WithoutStart(text);
  if (!text.starts_with('{') && !text.starts_with('[')) return false;
  const std::string_view inner = WithoutStart(text.substr(1));
  return inner.empty() || std::string_view("\"{}[]").find(inner.front()) != std::string_view::npos;
}

// Returns true if a list of objects states cameras as programs of 3D Gaussian splatting do.
bool HoldsSplatCameras(std::string_view text) {
  const auto has = [text](std::string_view key) { return text.find(key) != text.npos; };
  return WithoutStart(text).starts_with('[') && has("\"rotation\"") && has("\"position\"");
}

// Returns true if the first line that is neither blank nor a comment begins with a number, as in a
// .chan. YAML paths begin with a key.
bool LooksLikeLinesOfNumbers(std::string_view text) {
  text = WithoutStart(text);
  while (text.starts_with('#'))
    text = WithoutStart(text.substr(std::min(text.find('\n'), text.size())));
  return ParseNumber(text.substr(0, text.find_first_of(kWhiteSpace))).has_value();
}

// Returns an error for files of ours that are no camera paths, and for USD.
Result<void> CheckIsNoOtherFile(std::string_view text, const std::string& name) {
  if (text.starts_with("SQLite format 3"))
    return InputError(fmt::format(
        "{}: is a packed store or a package, but no camera path: give a camera path, "
        "such as lfexample writes, or the transforms.json whose LF cameras shall become "
        "frames",
        name));
  if (text.starts_with("#usda") || text.starts_with("PXR-USDC"))
    return InputError(
        fmt::format("{}: is a USD scene, which is written but not read as a camera path: give the "
                    "path that it was made from, or let the other program export a .chan",
                    name));
  return {};
}

}  // namespace

std::vector<std::string> TopLevelKeys(std::string_view text) {
  std::vector<std::string> keys;
  text = WithoutStart(text);
  if (!text.starts_with('{')) return keys;
  int depth = 0;
  for (size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '{' || c == '[') ++depth;
    if ((c == '}' || c == ']') && --depth == 0) break;
    if (c != '"') continue;
    const size_t end = EndOfString(text, at);
    const size_t next = text.find_first_not_of(kWhiteSpace, end);
    if (depth == 1 && next != std::string_view::npos && text[next] == ':')
      keys.emplace_back(text.substr(at + 1, end - at - 2));
    at = end - 1;
  }
  return keys;
}

Result<PathKind> PathKindOf(std::string_view text, const std::filesystem::path& file) {
  LF_RETURN_IF_ERROR(CheckIsNoOtherFile(text, file.string()));
  if (!LooksLikeJson(text))
    return LooksLikeLinesOfNumbers(text) ? PathKind::kChan : PathKind::kYaml;
  std::vector<std::string> keys = TopLevelKeys(text);
  const auto has = [&](const char* key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  if (has("camera_path")) return PathKind::kNerfstudio;
  if (has("path")) return PathKind::kNgp;
  if (has("frames")) return PathKind::kTransforms;
  if (has("format")) return PathKind::kYaml;
  if (HoldsSplatCameras(text)) return PathKind::kSplatCameras;
  constexpr size_t kMostShown = 8;
  const size_t count = keys.size();
  keys.resize(std::min(count, kMostShown));
  for (std::string& key : keys) key = QuoteForMessage(key);
  return InputError(fmt::format(
      "{}: is JSON, but no camera path: expected the key camera_path (nerfstudio), path "
      "(instant-ngp) or frames (transforms.json) at its top level, or a list of cameras with "
      "position and rotation (3D Gaussian splatting); found {}{}",
      file.string(), keys.empty() ? "no key" : fmt::format("{}", fmt::join(keys, ", ")),
      count > kMostShown ? ", ..." : ""));
}

Result<PathPlace> FindPath(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    const std::filesystem::path transforms = path / "transforms.json";
    if (std::filesystem::exists(transforms, error))
      return PathPlace{PathKind::kTransforms, transforms};
    LF_ASSIGN_OR_RETURN(const std::optional<std::filesystem::path> model, FindColmapModel(path));
    if (model) return PathPlace{PathKind::kColmap, *model};
    return InputError(
        fmt::format("{}: holds no camera path: looked for transforms.json, and for a COLMAP model "
                    "in it or in sparse/0, whose cameras become frames; give the file of the path",
                    path.string()));
  }
  Result<ByteStream> stream = ByteStream::Open(path);
  if (!stream) return PathPlace{PathKind::kYaml, path};
  LF_ASSIGN_OR_RETURN(const PathKind kind, PathKindOf(stream->Window(), path));
  return PathPlace{kind, path};
}

}  // namespace lf
