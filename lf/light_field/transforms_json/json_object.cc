// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/json_object.h"

#include <simdjson.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "lf/core/check.h"

namespace lf {
namespace {

using nlohmann::json;

constexpr int kMaxRewrittenDepth = 1000;  // largest depth of rewritten text; simdjson accepts 1024

// Returns true if the text has escapes from \ud800 to \udfff. simdjson accepts some of them that do
// not form a pair.
bool HasSurrogates(std::string_view text) {
  for (size_t at = text.find('\\'); at != std::string_view::npos; at = text.find('\\', at + 1)) {
    const std::string_view escape = text.substr(at, 4);
    if (escape.size() == 4 && escape[1] == 'u' && (escape[2] == 'd' || escape[2] == 'D') &&
        escape[3] >= '8')
      return true;
  }
  return false;
}

// Returns text of the same JSON value in a form that simdjson accepts, or "" if `text` is not JSON.
std::string WrittenAnew(const std::string& text) {
  try {
    const auto keep = [](int depth, json::parse_event_t, json&) {
      return depth <= kMaxRewrittenDepth;
    };
    return json::parse(text, keep).dump();
  } catch (const json::exception&) {
    return "";
  }
}

}  // namespace

JsonObject::JsonObject()
    : parser_(std::make_unique<simdjson::dom::parser>()),
      object_(std::make_unique<simdjson::dom::object>()) {
  LF_CHECK(ParseFast("{}"));
}

JsonObject::~JsonObject() = default;

bool JsonObject::Parse(const std::string& text) {
  if (!HasSurrogates(text) && ParseFast(text)) return true;
  if (ParseFast(WrittenAnew(text))) return true;
  LF_CHECK(ParseFast("{}"));
  return false;
}

bool JsonObject::ParseFast(const std::string& text) {
  return parser_->parse(text).get(*object_) == simdjson::SUCCESS;
}

}  // namespace lf
