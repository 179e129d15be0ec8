// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/comma_fields.h"

#include <algorithm>

namespace lf {

std::string_view TakeLine(std::string_view* text) {
  const std::string_view line = text->substr(0, text->find('\n'));
  text->remove_prefix(std::min(text->size(), line.size() + 1));
  return line;
}

std::string_view TrimmedField(std::string_view text) {
  constexpr std::string_view kFieldBlanks = " \t\r\"";
  const size_t begin = text.find_first_not_of(kFieldBlanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kFieldBlanks) + 1 - begin);
}

std::vector<std::string_view> CommaFields(std::string_view line) {
  constexpr size_t kMostFields = 200;
  std::vector<std::string_view> fields;
  while (fields.size() < kMostFields) {
    const size_t comma = line.find(',');
    fields.push_back(TrimmedField(line.substr(0, comma)));
    if (comma == line.npos) break;
    line.remove_prefix(comma + 1);
  }
  return fields;
}

}  // namespace lf
