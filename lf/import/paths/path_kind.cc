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
#include "lf/import/paths/other_files.h"
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

// Returns the text from the first line on that is neither blank nor a comment.
std::string_view FirstEntry(std::string_view text) {
  text = WithoutStart(text);
  while (text.starts_with('#'))
    text = WithoutStart(text.substr(std::min(text.find('\n'), text.size())));
  return text;
}

// Returns true if the first line that is neither blank nor a comment begins with a number, as in a
// .chan. YAML paths begin with a key.
bool LooksLikeLinesOfNumbers(std::string_view text) {
  text = FirstEntry(text);
  return ParseNumber(text.substr(0, text.find_first_of(kWhiteSpace))).has_value();
}

// Returns true if the first entry is that of a .chan: up to 8 numbers.
bool BeginsAsChan(std::string_view text) {
  text = FirstEntry(text);
  text = text.substr(0, text.find('\n'));
  constexpr int kMostColumns = 8;
  for (int count = 0; !text.empty(); ++count) {
    const size_t size = std::min(text.find_first_of(kWhiteSpace), text.size());
    if (count == kMostColumns || !ParseNumber(text.substr(0, size))) return false;
    text = WithoutStart(text.substr(size));
  }
  return true;
}

// Returns kInput for a text in UTF-16, which YAML may be, but no path of another program.
Result<void> CheckIsNoUtf16(std::string_view text, const std::filesystem::path& file) {
  if (!text.starts_with("\xFF\xFE") && !text.starts_with("\xFE\xFF")) return {};
  std::string narrow(text);
  std::erase(narrow, '\0');
  if (narrow.find("lfpath") != std::string::npos) return {};
  return InputError(fmt::format(
      "{}: is text in UTF-16, as Windows PowerShell writes it: save it as UTF-8", file.string()));
}

// Returns true if a list of objects states poses as `ns-export cameras` of nerfstudio does.
bool HoldsNerfstudioPoses(std::string_view text) {
  const auto has = [text](std::string_view key) { return text.find(key) != text.npos; };
  return WithoutStart(text).starts_with('[') && has("\"file_path\"") && has("\"transform\"");
}

// Returns the name of the file of a COLMAP model that begins as COLMAP writes it; "" for others.
std::string_view ColmapFileOf(std::string_view text) {
  text = WithoutStart(text);
  if (text.starts_with("# Image list with two lines of data per image")) return "images.txt";
  if (text.starts_with("# Camera list with one line of data per camera")) return "cameras.txt";
  if (text.starts_with("# 3D point list with one line of data per point")) return "points3D.txt";
  return "";
}

// Returns the model that a file is part of, by its name or content; nullopt if it is part of none.
// kInput: its other files are not beside it.
Result<std::optional<PathPlace>> ModelOfFile(std::string_view text,
                                             const std::filesystem::path& path) {
  const std::filesystem::path name = path.filename();
  std::string_view part = ColmapFileOf(text);
  for (const char* known : {"cameras", "images", "points3D"})
    for (const char* ending : {".txt", ".bin"})
      if (name == std::string(known) + ending) part = known;
  if (part.empty()) return std::optional<PathPlace>();
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code error;
  for (const char* ending : {".bin", ".txt"}) {
    const auto exists = [&](const char* file) {
      return std::filesystem::exists(folder / (std::string(file) + ending), error);
    };
    if (exists("cameras") && exists("images"))
      return std::optional(PathPlace{PathKind::kColmap, folder});
  }
  if (ColmapFileOf(text).empty() && BeginsAsChan(text))
    return std::optional<PathPlace>();  // a .chan may have this name
  return InputError(fmt::format(
      "{}: is one file of a COLMAP model ({}), but cameras and images, as .txt or .bin, "
      "are not both beside it: copy these files into one folder, with these names, and "
      "give this folder",
      path.string(), part));
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
  LF_RETURN_IF_ERROR(CheckContentIsNoOther(text, file));
  LF_RETURN_IF_ERROR(CheckIsNoUtf16(text, file));
  if (!LooksLikeJson(text)) {
    if (LooksLikeLinesOfNumbers(text)) return PathKind::kChan;
    LF_RETURN_IF_ERROR(CheckNameIsNoOther(text, file));
    return PathKind::kYaml;
  }
  std::vector<std::string> keys = TopLevelKeys(text);
  const auto has = [&](const char* key) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  if (has("camera_path")) return PathKind::kNerfstudio;
  if (has("path")) return PathKind::kNgp;
  if (has("frames")) return PathKind::kTransforms;
  if (has("format")) return PathKind::kYaml;
  if (HoldsSplatCameras(text)) return PathKind::kSplatCameras;
  if (HoldsNerfstudioPoses(text)) return PathKind::kNerfstudioPoses;
  LF_RETURN_IF_ERROR(CheckNameIsNoOther(text, file));
  constexpr size_t kMostShown = 8;
  const size_t count = keys.size();
  keys.resize(std::min(count, kMostShown));
  for (std::string& key : keys) key = QuoteForMessage(key);
  return InputError(fmt::format(
      "{}: is JSON, but no camera path: expected the key camera_path (nerfstudio), path "
      "(instant-ngp) or frames (transforms.json) at its top level, a list of cameras with "
      "position and rotation (3D Gaussian splatting), or one with file_path and transform "
      "(ns-export cameras); found {}{}",
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
  const std::string_view text = stream->Window();
  LF_ASSIGN_OR_RETURN(const std::optional<PathPlace> model, ModelOfFile(text, path));
  if (model) return *model;
  LF_ASSIGN_OR_RETURN(const PathKind kind, PathKindOf(text, path));
  return PathPlace{kind, path};
}

}  // namespace lf
