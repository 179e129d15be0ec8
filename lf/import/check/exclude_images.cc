// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/exclude_images.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <string_view>
#include <unordered_map>

#include "lf/core/file.h"
#include "lf/light_field/model/brackets.h"
#include "lf/light_field/model/keep_images.h"

namespace lf {
namespace {

constexpr size_t kMaxListSize_bytes = 64 << 20;

void AddEntries(std::string_view text, std::string_view separators,
                std::vector<std::string>* entries) {
  while (!text.empty()) {
    const size_t end = std::min(text.size(), text.find_first_of(separators));
    if (end > 0) entries->emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end + 1));
  }
}

std::string_view BaseName(std::string_view name) { return name.substr(name.rfind('/') + 1); }

// Patterns with which names of LF images are compared. A name is looked up in a table of all
// patterns; only patterns with wildcards are tried one by one.
class PatternSet {
 public:
  explicit PatternSet(std::span<const std::string> patterns)
      : patterns_(patterns), used_(patterns.size()) {
    for (size_t i = 0; i < patterns.size(); ++i) {
      exact_.try_emplace(patterns[i], i);
      if (patterns[i].find_first_of("*?[") != std::string::npos) wildcards_.push_back(i);
    }
  }

  bool Matches(const std::string& name) {
    const std::string base(BaseName(name));
    bool matches = false;
    for (const std::string* text : {&name, &base}) {
      if (const auto found = exact_.find(*text); found != exact_.end()) {
        used_[found->second] = true;
        matches = true;
      }
      for (const size_t i : wildcards_)
        if (::fnmatch(patterns_[i].c_str(), text->c_str(), 0) == 0) {
          used_[i] = true;
          matches = true;
        }
    }
    return matches;
  }

  // Returns the first pattern that matched no name; null if all matched. If a pattern was given
  // twice, a match counts for both.
  const std::string* FirstUnused() const {
    for (size_t i = 0; i < used_.size(); ++i)
      if (!used_[i] && !used_[exact_.at(patterns_[i])]) return &patterns_[i];
    return nullptr;
  }

 private:
  std::span<const std::string> patterns_;
  std::unordered_map<std::string, size_t> exact_;
  std::vector<size_t> wildcards_;
  std::vector<bool> used_;
};

// Keeps these LF images alone. Returns the number of those that are removed.
size_t Keep(const std::vector<size_t>& kept, LightField* light_field) {
  const size_t removed = light_field->size() - kept.size();
  KeepImages(kept, light_field);
  // If only one exposure of the brackets is left, the light field has no brackets any more.
  RadianceEncoding& encoding = light_field->encoding;
  if (encoding.masks_clipped && ApplyBrackets(light_field) == 0) encoding.masks_clipped = false;
  return removed;
}

}  // namespace

Result<size_t> ExcludeFaulty(const ImageFaults& faults, LightField* light_field) {
  std::vector<bool> is_faulty(light_field->size());
  for (const auto* const list : {&faults.missing, &faults.broken})
    for (const ImageFault& fault : *list) is_faulty[fault.id.value] = true;
  std::vector<size_t> kept;
  for (size_t i = 0; i < is_faulty.size(); ++i)
    if (!is_faulty[i]) kept.push_back(i);
  if (kept.empty()) {
    const auto& first = faults.missing.empty() ? faults.broken : faults.missing;
    return InputError(
        fmt::format("{{exclude {}}}: all {} images are missing or broken; the first: {}",
                    kMissingPattern, light_field->size(), first[0].reason));
  }
  return Keep(kept, light_field);
}

Result<std::vector<std::string>> ReadPatterns(std::span<const std::string> options) {
  std::vector<std::string> patterns;
  for (const std::string& option : options) {
    if (!option.starts_with('@')) {
      AddEntries(option, ",", &patterns);
      continue;
    }
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(option.substr(1), kMaxListSize_bytes));
    AddEntries(text, "\r\n", &patterns);
  }
  return patterns;
}

Result<size_t> ExcludeImages(std::span<const std::string> patterns, LightField* light_field) {
  PatternSet set(patterns);
  std::vector<size_t> kept;
  for (size_t i = 0; i < light_field->size(); ++i)
    if (!set.Matches(light_field->image_names[i])) kept.push_back(i);
  if (const std::string* unused = set.FirstUnused())
    return InputError(
        fmt::format("{{exclude}}: \"{}\" matches none of the {} image names, of which the first is "
                    "{}: correct the name or pattern",
                    *unused, light_field->size(), light_field->image_names[0]));
  if (kept.empty())
    return InputError(fmt::format(
        "{{exclude}}: the names and patterns match all {} images: exclude fewer, because "
        "a light field needs at least one",
        light_field->size()));
  return Keep(kept, light_field);
}

}  // namespace lf
