// SPDX-License-Identifier: Apache-2.0
// Reads values of JSON files that other programs exported. Errors name the file, the place in it,
// the value found and what was expected:
//
//   a/reconstruction.json: shots.b.jpg.rotation is "north": expected a list of 3 numbers
#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/result.h"

namespace lf {

// Parses a file. Members with one of the keys in `left_out`, at any depth, take no memory: exports
// often hold points of the scene beside the cameras. NaN and Infinity, which Python writes, become
// texts, which no reader of a number accepts. A byte order mark at the beginning is skipped.
//   file  for messages
// kInput if the text is not JSON.
Result<nlohmann::json> ParseExportJson(std::string_view text, const std::filesystem::path& file,
                                       std::initializer_list<std::string_view> left_out = {});

// A value in a file. The file's json and its path must outlive the value.
class JsonValue {
 public:
  // Views the whole file.
  JsonValue(const nlohmann::json& json, const std::filesystem::path& file)
      : json_(&json), file_(&file) {}

  // Returns true if this is an object whose member `key` is there and not null.
  bool Has(std::string_view key) const;
  // Returns a member of an object. kInput if this is no object, or has no such member.
  Result<JsonValue> At(std::string_view key) const;
  // Returns the entries of a list, in their order. kInput if this is no list, or longer than
  // kMaxImageCount.
  Result<std::vector<JsonValue>> Entries() const;
  // Returns the members of an object with their keys, sorted by key. kInput if this is no object.
  Result<std::vector<std::pair<std::string, JsonValue>>> Members() const;

  // The next four return a value, which must have the right type. A number may be written as a
  // text, as Meshroom writes it.
  Result<double> Number(double least, double most) const;
  Result<int> Whole(int least, int most) const;
  // Reads a list of `count` numbers within +-most. Lists of numbers in it are read one after the
  // other: the rows of a matrix.
  Result<std::vector<double>> Numbers(size_t count, double most) const;
  Result<std::string> Text() const;
  // Returns what a text or whole number says, for keys that some versions write as one and some as
  // the other.
  Result<std::string> Label() const;

  // Return the value of a member. kInput if it is missing, null or of the wrong type.
  Result<double> NumberAt(std::string_view key, double least, double most) const;
  Result<int> WholeAt(std::string_view key, int least, int most) const;
  Result<std::vector<double>> NumbersAt(std::string_view key, size_t count, double most) const;
  Result<std::string> TextAt(std::string_view key) const;
  Result<std::string> LabelAt(std::string_view key) const;
  // Returns `otherwise` if the member is missing or null.
  Result<double> NumberOr(std::string_view key, double otherwise, double least, double most) const;

  // Returns the error "FILE: PLACE is VALUE: expected EXPECTED".
  Error Wrong(std::string_view expected) const;
  // Returns the error "FILE: PLACE MESSAGE".
  Error Fault(std::string_view message) const;

 private:
  JsonValue(const nlohmann::json& json, const std::filesystem::path& file, std::string place)
      : json_(&json), file_(&file), place_(std::move(place)) {}
  std::optional<double> AsNumber() const;
  std::string PlaceOf(std::string_view key) const;
  bool AppendNumbers(double most, size_t count, std::vector<double>* numbers) const;

  const nlohmann::json* json_;
  const std::filesystem::path* file_;
  std::string place_;  // "shots.b.jpg.rotation"; empty: the whole file
};

}  // namespace lf
