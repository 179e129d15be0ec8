// SPDX-License-Identifier: Apache-2.0
// Reads the keys of a JSON object as checked values. Errors name the file, the frame, the key, the
// value and what was expected. Used by the readers of calibrations and camera paths.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/light_field/transforms_json/json_object.h"

namespace simdjson::dom {
class element;
}  // namespace simdjson::dom

namespace lf {

// A condition that a number must satisfy. `expected` completes "expected ..." in the message.
struct NumberRule {
  const char* expected;
  bool (*holds)(double);
};

// A view of one object of a file. The object, file and file_path must outlive the view.
class JsonFields {
 public:
  // Views the top level of the file.
  JsonFields(const JsonObject& object, const std::filesystem::path& file)
      : object_(object), file_(file) {}
  // Views frames[frame_index], which describes the image file_path ("" until that is known). `list`
  // is the name of the list in messages.
  JsonFields(const JsonObject& object, const std::filesystem::path& file, size_t frame_index,
             std::string_view file_path, std::string_view list = "frames")
      : object_(object),
        file_(file),
        frame_index_(frame_index),
        file_path_(file_path),
        list_(list) {}

  bool Has(const char* key) const;  // false if the key is missing or its value is null
  // Returns the number of entries of the list; nullopt if the value of the key is no list.
  std::optional<size_t> ListSize(const char* key) const;
  // Number() and the functions below up to Matrix() return nullopt if the key is missing or null,
  // and kInput if the value has another type or violates the rule.
  Result<std::optional<double>> Number(const char* key, const NumberRule& rule) const;
  // Reads a list of `count` numbers, or one number, which is repeated `count` times.
  Result<std::optional<std::vector<double>>> NumberOrNumbers(const char* key, size_t count,
                                                             const NumberRule& rule) const;
  Result<std::optional<bool>> Bool(const char* key) const;
  // Reads a text of at most 4096 bytes without NUL characters.
  Result<std::optional<std::string>> Text(const char* key) const;
  // Reads a list of count_min to count_max numbers.
  Result<std::optional<std::vector<double>>> Numbers(const char* key, size_t count_min,
                                                     size_t count_max,
                                                     const NumberRule& rule) const;
  // Reads rows_min to rows_max lists of `columns` numbers each. The result contains the rows one
  // after the other.
  Result<std::optional<std::vector<double>>> Matrix(const char* key, size_t rows_min,
                                                    size_t rows_max, size_t columns,
                                                    const NumberRule& rule) const;

  // Returns kInput if a key that starts with lf_ is not in `known`. If the key is in
  // `known_elsewhere`, the message says to move it `elsewhere_place`, such as "to the top
  // level"; otherwise the message names the nearest known key.
  Result<void> CheckLfKeys(std::span<const char* const> known,
                           std::span<const char* const> known_elsewhere,
                           const char* elsewhere_place) const;

  // Returns the error "a/transforms.json: frames[3] (images/3.png): MESSAGE".
  Error Fault(std::string_view message) const;
  // Returns the error "... "key" is VALUE: expected EXPECTED", or "... "key" is missing: expected
  // EXPECTED" if the object does not have the key.
  Error Wrong(const char* key, std::string_view expected) const;

 private:
  std::optional<simdjson::dom::element> Find(const char* key) const;

  const JsonObject& object_;
  const std::filesystem::path& file_;
  std::optional<size_t> frame_index_;
  std::string_view file_path_;
  std::string_view list_;
};

}  // namespace lf
