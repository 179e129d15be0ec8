// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/tables/settings_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "lf/core/parse_number.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {

Result<void> WriteSettings(const SettingList& settings, Database* database) {
  LF_ASSIGN_OR_RETURN(Statement insert, database->Prepare("insert into settings values (?, ?)"));
  for (const auto& [key, value] : settings)
    LF_RETURN_IF_ERROR(
        insert.Bind(0, std::string_view(key)).Bind(1, std::string_view(value)).Run());
  return {};
}

Result<Settings> Settings::Read(Database& database, const char* what) {
  Settings settings;
  settings.file_ = database.name();
  settings.what_ = what;
  LF_RETURN_IF_ERROR(ForEachRow(database, "select key, value from settings",
                                [&settings](const Statement& row) -> Result<void> {
                                  LF_ASSIGN_OR_RETURN(const std::string key, row.Text(0));
                                  LF_ASSIGN_OR_RETURN(settings.texts_[key], row.Text(1));
                                  return {};
                                }));
  return settings;
}

Error Settings::Damaged(const std::string& what) const {
  return InputError(
      fmt::format("{}: is a damaged {}: {}; copy or make it again", file_, what_, what));
}

Error Settings::Wrong(const std::string& key, std::string_view expected) const {
  return Damaged(fmt::format("setting {} is '{}', expected {}", key, Text(key), expected));
}

std::string Settings::Text(const std::string& key) const {
  const auto found = texts_.find(key);
  return found == texts_.end() ? std::string() : found->second;
}

Result<std::vector<double>> Settings::Numbers(const std::string& key, size_t count_min,
                                              size_t count_max) const {
  auto numbers = ParseNumbers(Text(key));
  if (!numbers || numbers->size() < count_min || numbers->size() > count_max)
    return Wrong(key,
                 fmt::format("finite numbers (at least {}, at most {})", count_min, count_max));
  return *std::move(numbers);
}

Result<double> Settings::Number(const std::string& key, double low, double high) const {
  LF_ASSIGN_OR_RETURN(const std::vector<double> numbers, Numbers(key, 1, 1));
  if (!IsWithin(numbers[0], low, high))
    return Wrong(key, fmt::format("a number from {:g} to {:g}", low, high));
  return numbers[0];
}

Result<uint64_t> Settings::Whole(const std::string& key) const {
  const std::string text = Text(key);
  const std::optional<uint64_t> number = ParseWhole<uint64_t>(text);
  if (!number) return Wrong(key, "a whole number");
  return *number;
}

Result<int> Settings::Word(const std::string& key, std::span<const char* const> words) const {
  for (size_t i = 0; i < words.size(); ++i)
    if (Text(key) == words[i]) return static_cast<int>(i);
  return Wrong(key, fmt::format("{}", fmt::join(words, " or ")));
}

}  // namespace lf
