// SPDX-License-Identifier: Apache-2.0
// Writes and reads the table `settings`, which maps keys to text, of packages and packed stores.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/result.h"
#include "lf/storage/sqlite/database.h"

namespace lf {

inline constexpr const char* kSettingsTable =
    "create table settings (key text primary key, value text not null) without rowid;";

using SettingList = std::vector<std::pair<std::string, std::string>>;

// Writes the settings in their order into the table `settings`, which must exist. Passes on the
// errors of the database.
Result<void> WriteSettings(const SettingList& settings, Database* database);

// All settings of one file, as text or converted to the type that the text should have. Errors are
// kInput, and name file and key.
class Settings {
 public:
  // what  name of this kind of file in messages, such as "package"
  static Result<Settings> Read(Database& database, const char* what);

  // Returns the text of a setting; "" if the key does not exist.
  std::string Text(const std::string& key) const;
  // Returns finite numbers, at least count_min and at most count_max.
  Result<std::vector<double>> Numbers(const std::string& key, size_t count_min,
                                      size_t count_max) const;
  // Returns a number in [low, high].
  Result<double> Number(const std::string& key, double low, double high) const;
  // Returns a whole number of up to 2^64 - 1.
  Result<uint64_t> Whole(const std::string& key) const;
  // Returns the index of the setting's text in `words`; kInput if `words` does not contain the
  // text.
  Result<int> Word(const std::string& key, std::span<const char* const> words) const;

  // Returns the error "package-0000.lfp: is a damaged package: WHAT; copy or make it again", with
  // `what` in place of WHAT.
  Error Damaged(const std::string& what) const;
  // Returns Damaged() with the setting's text and the text that was expected.
  Error Wrong(const std::string& key, std::string_view expected) const;

 private:
  std::string file_, what_;
  std::map<std::string, std::string> texts_;
};

}  // namespace lf
