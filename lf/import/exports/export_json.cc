// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lf/core/parse_number.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/transforms_json/json_syntax.h"

namespace lf {
namespace {

using nlohmann::json;

constexpr int kMaxJsonDepth = 32;  // deepest nesting that is kept; deeper values take no memory
constexpr size_t kMostTextBytes = 4096;

// Returns a value in the form in which messages show it, shortened if it is long.
std::string ShownJson(const json& value) {
  constexpr size_t kLongest = 80;
  if (value.is_object()) return "an object";
  if (value.is_array() && value.size() > 4) return fmt::format("a list of {}", value.size());
  const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

}  // namespace

Result<json> ParseExportJson(std::string_view text, const std::filesystem::path& file,
                             std::initializer_list<std::string_view> left_out) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const auto keep = [&](int depth, json::parse_event_t event, json& value) {
    if (depth > kMaxJsonDepth) return false;
    return event != json::parse_event_t::key ||
           std::find(left_out.begin(), left_out.end(), value.get_ref<const std::string&>()) ==
               left_out.end();
  };
  const auto parse = [&](std::string_view what) -> Result<json> {
    try {
      return json::parse(what.begin(), what.end(), keep);
    } catch (const json::exception& exception) {
      return IsNotJson(file, exception.what());
    }
  };
  Result<json> parsed = parse(text);
  if (parsed || (text.find("NaN") == text.npos && text.find("Infinity") == text.npos))
    return parsed;
  return parse(WithQuotedNan(text));
}

bool JsonValue::Has(std::string_view key) const {
  if (!json_->is_object()) return false;
  const auto found = json_->find(std::string(key));
  return found != json_->end() && !found->is_null();
}

std::string JsonValue::PlaceOf(std::string_view key) const {
  return place_.empty() ? std::string(key) : fmt::format("{}.{}", place_, key);
}

Result<JsonValue> JsonValue::At(std::string_view key) const {
  if (!json_->is_object()) return Wrong(fmt::format("an object with the key \"{}\"", key));
  const auto found = json_->find(std::string(key));
  if (found == json_->end() || found->is_null())
    return Fault(fmt::format("has no key \"{}\"", key));
  return JsonValue(*found, *file_, PlaceOf(key));
}

Result<std::vector<JsonValue>> JsonValue::Entries() const {
  if (!json_->is_array()) return Wrong("a list");
  if (json_->size() > kMaxImageCount)
    return Fault(fmt::format("has {} entries: expected at most {}", json_->size(), kMaxImageCount));
  std::vector<JsonValue> entries;
  for (const json& entry : *json_)
    entries.push_back(JsonValue(entry, *file_, fmt::format("{}[{}]", place_, entries.size())));
  return entries;
}

Result<std::vector<std::pair<std::string, JsonValue>>> JsonValue::Members() const {
  if (!json_->is_object()) return Wrong("an object");
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& [key, value] : json_->items())
    members.emplace_back(key, JsonValue(value, *file_, PlaceOf(key)));
  return members;
}

std::optional<double> JsonValue::AsNumber() const {
  if (json_->is_string()) return ParseNumber(json_->get_ref<const std::string&>());
  if (!json_->is_number() || !std::isfinite(json_->get<double>())) return std::nullopt;
  return json_->get<double>();
}

Result<double> JsonValue::Number(double least, double most) const {
  const std::optional<double> number = AsNumber();
  if (!number || !(*number >= least && *number <= most))
    return Wrong(fmt::format("a number from {:g} to {:g}", least, most));
  return *number;
}

Result<int> JsonValue::Whole(int least, int most) const {
  const std::optional<double> number = AsNumber();
  if (!number || !(*number >= least && *number <= most) || *number != std::floor(*number))
    return Wrong(fmt::format("a whole number from {} to {}", least, most));
  return static_cast<int>(*number);
}

bool JsonValue::AppendNumbers(double most, size_t count, std::vector<double>* numbers) const {
  if (json_->is_array())
    return std::all_of(json_->begin(), json_->end(), [&](const json& entry) {
      return JsonValue(entry, *file_).AppendNumbers(most, count, numbers);
    });
  const std::optional<double> number = AsNumber();
  if (!number || !(std::abs(*number) <= most) || numbers->size() == count) return false;
  numbers->push_back(*number);
  return true;
}

Result<std::vector<double>> JsonValue::Numbers(size_t count, double most) const {
  std::vector<double> numbers;
  if (!json_->is_array() || !AppendNumbers(most, count, &numbers) || numbers.size() != count)
    return Wrong(fmt::format("a list of {} numbers within +-{:g}", count, most));
  return numbers;
}

Result<std::string> JsonValue::Text() const {
  if (!json_->is_string()) return Wrong("a text in quotes");
  const std::string& text = json_->get_ref<const std::string&>();
  if (text.size() > kMostTextBytes || text.find('\0') != text.npos)
    return Wrong(fmt::format("a text of at most {} bytes without NUL characters", kMostTextBytes));
  return text;
}

Result<std::string> JsonValue::Label() const {
  if (json_->is_number_unsigned()) return fmt::format("{}", json_->get<uint64_t>());
  if (json_->is_number_integer()) return fmt::format("{}", json_->get<int64_t>());
  return Text();
}

Result<double> JsonValue::NumberAt(std::string_view key, double least, double most) const {
  LF_ASSIGN_OR_RETURN(const JsonValue value, At(key));
  return value.Number(least, most);
}

Result<int> JsonValue::WholeAt(std::string_view key, int least, int most) const {
  LF_ASSIGN_OR_RETURN(const JsonValue value, At(key));
  return value.Whole(least, most);
}

Result<std::vector<double>> JsonValue::NumbersAt(std::string_view key, size_t count,
                                                 double most) const {
  LF_ASSIGN_OR_RETURN(const JsonValue value, At(key));
  return value.Numbers(count, most);
}

Result<std::string> JsonValue::TextAt(std::string_view key) const {
  LF_ASSIGN_OR_RETURN(const JsonValue value, At(key));
  return value.Text();
}

Result<std::string> JsonValue::LabelAt(std::string_view key) const {
  LF_ASSIGN_OR_RETURN(const JsonValue value, At(key));
  return value.Label();
}

Result<double> JsonValue::NumberOr(std::string_view key, double otherwise, double least,
                                   double most) const {
  if (!Has(key)) return otherwise;
  return NumberAt(key, least, most);
}

Error JsonValue::Wrong(std::string_view expected) const {
  return Fault(fmt::format("is {}: expected {}", ShownJson(*json_), expected));
}

Error JsonValue::Fault(std::string_view message) const {
  constexpr size_t kLongestPlace = 300;
  return InputError(fmt::format("{}: {} {}", file_->string(),
                                place_.empty() ? "the file" : place_.substr(0, kLongestPlace),
                                message));
}

}  // namespace lf
