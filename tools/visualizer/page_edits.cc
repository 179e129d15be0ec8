#include "tools/visualizer/page_edits.h"

#include <cctype>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>

#include "lf/core/file.h"

namespace lf {
namespace {

using Json = nlohmann::ordered_json;

PageAnswer JsonAnswer(const Json& json) {
  return {200, "application/json", json.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

std::string TextOf(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

double NumberOf(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : std::nan("");
}

std::optional<FrameId> FrameOf(const Json& json, const CameraPath& path) {
  const double number = NumberOf(json, "frame");
  if (!(number >= 1 && number <= static_cast<double>(path.frame_count()))) return std::nullopt;
  return FrameId{static_cast<uint32_t>(number)};
}

// With the line and column that the parser names: "path.yaml:12:5: ...".
PageAnswer Refused(const Error& error, const std::string& file) {
  Json json = {{"error", error.message}};
  if (error.message.starts_with(file + ":")) {
    const char* at = error.message.data() + file.size() + 1;
    const char* end = error.message.data() + error.message.size();
    for (const char* key : {"line", "column"}) {
      int number = 0;
      const auto [rest, fault] = std::from_chars(at, end, number);
      if (fault != std::errc() || rest == end || *rest != ':') break;
      json[key] = number;
      at = rest + 1;
    }
  }
  PageAnswer answer = JsonAnswer(json);
  answer.status = 422;
  return answer;
}

PageAnswer Save(PageScene& scene, const Json& json) {
  const std::string text = TextOf(json, "text");
  const auto draft = scene.AddDraft(text);
  if (!draft) return Refused(draft.error(), scene.arguments().path.filename().string());
  const auto force = json.find("force");
  const bool is_forced = force != json.end() && force->is_boolean() && force->get<bool>();
  const auto on_disk = scene.IdOnDisk();
  if (!is_forced && on_disk && *on_disk != TextOf(json, "expected"))
    return Refusal(409, scene.arguments().path.string() +
                            " has been changed by another program since it was opened here");
  if (const auto written = WriteFileAtomically(scene.arguments().path, text); !written)
    return Refusal(written.error());
  return JsonAnswer({{"id", (*draft)->id}});
}

PageAnswer StartPreview(PageScene& scene, PreviewRender& preview, const Json& json) {
  const std::string text = TextOf(json, "text");
  const auto draft = scene.AddDraft(text);
  if (!draft) return Refused(draft.error(), scene.arguments().path.filename().string());
  const auto frame = FrameOf(json, *(*draft)->path);
  if (!frame) return Refusal(422, "\"frame\": expected one of the path's");
  preview.Start(text, *frame);
  return JsonAnswer(Json::object());
}

}  // namespace

PageAnswer Edit(PageScene& scene, PreviewRender& preview, std::string_view name,
                const std::string& body) {
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object()) return Refusal(400, "expected a JSON object");
  if (name == "check") {
    const auto draft = scene.AddDraft(TextOf(json, "text"));
    if (!draft) return Refused(draft.error(), scene.arguments().path.filename().string());
    return {200, "application/json", PathHeadJson(**draft)};
  }
  if (name == "save") return Save(scene, json);
  if (name == "preview") return StartPreview(scene, preview, json);
  if (name == "preview/stop") {
    preview.Stop();
    return JsonAnswer(Json::object());
  }
  return Refusal(404, "there is nothing of this name");
}

}  // namespace lf
