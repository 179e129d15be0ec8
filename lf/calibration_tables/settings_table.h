// The table `settings` of our SQLite files: text by key.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/result.h"
#include "lf/database/database.h"

namespace lf {

inline constexpr const char* kSettingsTable =
    "create table settings (key text primary key, value text not null) without rowid;";

using SettingList = std::vector<std::pair<std::string, std::string>>;

// Writes the settings in their order. The table must exist. Errors are those of the database.
Result<void> WriteSettings(const SettingList& settings, Database* database);

// The settings of a file, as text or converted. Errors are kInput and name file and key.
class Settings {
 public:
  // what  the word for such a file in messages: "package"
  static Result<Settings> Read(Database& database, const char* what);

  // Returns "" if the key is missing.
  std::string Text(const std::string& key) const;
  Result<std::vector<double>> Numbers(const std::string& key, size_t count_min,
                                      size_t count_max) const;
  Result<double> Number(const std::string& key, double low, double high) const;
  // Reads a whole number up to 2^64 - 1.
  Result<uint64_t> Whole(const std::string& key) const;
  // Returns the index of the setting in `words`.
  Result<int> Word(const std::string& key, std::span<const char* const> words) const;

  // "package-0000.lfp: is a damaged package: " + what
  Error Damaged(const std::string& what) const;
  Error Wrong(const std::string& key, std::string_view expected) const;

 private:
  std::string file_, what_;
  std::map<std::string, std::string> texts_;
};

}  // namespace lf
