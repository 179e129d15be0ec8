// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/yaml_schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <unordered_map>

#include "lf/camera/path/spelling.h"
#include "lf/core/check.h"
#include "lf/core/parse_number.h"

namespace lf {
namespace {

std::string Describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return "nothing";
    case YamlNode::Kind::kPlain:
      return QuoteForMessage(node.text);
    case YamlNode::Kind::kQuoted:
      return fmt::format("the quoted text {}", QuoteForMessage(node.text));
    case YamlNode::Kind::kSequence:
      return fmt::format("a list of {}", node.items.size());
    case YamlNode::Kind::kMap:
      return "a map";
  }
  return {};
}

}  // namespace

void AddExpected(const YamlNode& node, std::string_view label, std::string_view expected,
                 YamlErrors* errors) {
  errors->Add(node.place,
              fmt::format("{}: expected {}, found {}", label, expected, Describe(node)));
}

void YamlErrors::Add(const YamlPlace& place, std::string message) {
  if (!full()) errors_.push_back({place, std::move(message)});
}

void YamlErrors::AddFirst(const YamlPlace& place, std::string message) {
  if (full()) return;
  const auto position = errors_.begin() + static_cast<std::ptrdiff_t>(first_count_++);
  errors_.insert(position, Entry{place, std::move(message)});
}

Error YamlErrors::First() const {
  LF_CHECK(!errors_.empty());
  const Entry& first = errors_.front();
  std::string message =
      fmt::format("{}:{}:{}: {}", file_name_, first.place.line, first.place.column, first.message);
  std::set<int> lines;
  for (const Entry& entry : errors_) lines.insert(entry.place.line);
  lines.erase(first.place.line);
  if (!lines.empty())
    message += fmt::format(" (also wrong: line{} {})", lines.size() > 1 ? "s" : "",
                           fmt::join(lines, ", "));
  return InputError(message);
}

bool NumberRange::Holds(double value) const {
  return open ? value > min && value < max : value >= min && value <= max;
}

std::string NumberRange::Describe() const {
  if (max < kLargest && open) return fmt::format("above {} and below {}", min, max);
  if (max < kLargest) return fmt::format("from {} to {}", min, max);
  if (min > -kLargest && open) return fmt::format("above {} (below {:g})", min, kLargest);
  if (min > -kLargest) return fmt::format("at least {} (at most {:g})", min, kLargest);
  return fmt::format("within +-{:g}", kLargest);
}

YamlMap::YamlMap(const YamlNode& node, std::string title, YamlErrors* errors)
    : title_(std::move(title)), errors_(errors), place_(node.place) {
  if (node.kind != YamlNode::Kind::kMap) {
    AddExpected(node, title_.empty() ? "a camera path" : title_, "a map of 'key: value'", errors_);
    return;
  }
  std::unordered_map<std::string_view, int> line_of_key;
  for (const YamlEntry& entry : node.entries) {
    const auto [first, is_new] = line_of_key.emplace(entry.key, entry.place.line);
    if (is_new)
      entries_.push_back(&entry);
    else
      errors_->AddFirst(entry.place,
                        fmt::format("key {} is given twice, first in line {}; remove one",
                                    QuoteForMessage(entry.key), first->second));
  }
}

std::string YamlMap::Label(std::string_view key) const {
  return title_.empty() ? std::string(key) : fmt::format("{}.{}", title_, key);
}

const YamlEntry* YamlMap::Find(std::string_view key) {
  if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) asked_.emplace_back(key);
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const YamlEntry* entry) { return entry->key == key; });
  return found == entries_.end() ? nullptr : *found;
}

const YamlEntry* YamlMap::Require(std::string_view key, std::string_view example) {
  const YamlEntry* entry = Find(key);
  if (!entry)
    errors_->Add(place_,
                 fmt::format("{} is missing; write for instance '{}'", Label(key), example));
  return entry;
}

void YamlMap::CheckKeys() {
  for (const YamlEntry* entry : entries_)
    if (!errors_->full() && std::find(asked_.begin(), asked_.end(), entry->key) == asked_.end())
      errors_->AddFirst(entry->place, UnknownWord("key", entry->key, title_, asked_));
}

std::string UnknownWord(std::string_view kind, std::string_view word, std::string_view where,
                        const std::vector<std::string>& known) {
  const std::string nearest = NearestWord(word, known);
  return fmt::format("unknown {} {}{}{}{} known are: {}", kind, QuoteForMessage(word),
                     where.empty() ? "" : " in ", where,
                     nearest.empty() ? ";" : fmt::format("; did you mean '{}'?", nearest),
                     fmt::join(known, ", "));
}

std::optional<double> ReadNumber(const YamlNode& node, std::string_view label,
                                 const NumberRange& range, YamlErrors* errors) {
  std::string_view text = node.text;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (node.kind != YamlNode::Kind::kPlain || end != text.data() + text.size() ||
      error == std::errc::invalid_argument) {
    AddExpected(node, label, "a number", errors);
    return std::nullopt;
  }
  if (error != std::errc() || !range.Holds(value)) {
    AddExpected(node, label, "a number " + range.Describe(), errors);
    return std::nullopt;
  }
  return value;
}

std::optional<int> ReadInteger(const YamlNode& node, std::string_view label, int min, int max,
                               YamlErrors* errors) {
  const std::optional<int> value = ParseWhole<int>(node.text);
  if (node.kind != YamlNode::Kind::kPlain || !value || *value < min || *value > max) {
    AddExpected(node, label, fmt::format("a whole number from {} to {}", min, max), errors);
    return std::nullopt;
  }
  return value;
}

std::optional<bool> ReadBool(const YamlNode& node, std::string_view label, YamlErrors* errors) {
  if (node.kind == YamlNode::Kind::kPlain && node.text == "true") return true;
  if (node.kind == YamlNode::Kind::kPlain && node.text == "false") return false;
  AddExpected(node, label, "true or false", errors);
  return std::nullopt;
}

std::optional<std::string> ReadWord(const YamlNode& node, std::string_view label,
                                    const std::vector<std::string>& allowed, YamlErrors* errors) {
  const bool is_text = node.kind == YamlNode::Kind::kPlain || node.kind == YamlNode::Kind::kQuoted;
  if (is_text && std::find(allowed.begin(), allowed.end(), node.text) != allowed.end())
    return node.text;
  AddExpected(node, label, fmt::format("{}", fmt::join(allowed, " or ")), errors);
  return std::nullopt;
}

std::optional<std::vector<double>> ReadNumbers(const YamlNode& node, std::string_view label,
                                               size_t count, const NumberRange& range,
                                               YamlErrors* errors) {
  if (node.kind != YamlNode::Kind::kSequence || node.items.size() != count) {
    AddExpected(node, label, fmt::format("a list of {} numbers", count), errors);
    return std::nullopt;
  }
  std::vector<double> numbers;
  for (const YamlNodePtr& item : node.items)
    if (const auto number = ReadNumber(*item, label, range, errors)) numbers.push_back(*number);
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

}  // namespace lf
