// Reads the keys of a JSON object as checked values; errors name file, frame, key, value and
// expectation. For the readers of calibrations.
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

// The condition on a number. `expected` completes "expected ..." in the message.
struct NumberRule {
  const char* expected;
  bool (*holds)(double);
};

// A view of one object of a file; object, file and file_path must outlive it.
class JsonFields {
 public:
  // Views the top level of the file.
  JsonFields(const JsonObject& object, const std::filesystem::path& file)
      : object_(object), file_(file) {}
  // Views frames[frame_index], which describes the image file_path ("" until that is known).
  JsonFields(const JsonObject& object, const std::filesystem::path& file, size_t frame_index,
             std::string_view file_path)
      : object_(object), file_(file), frame_index_(frame_index), file_path_(file_path) {}

  bool Has(const char* key) const;  // false also for null
  bool HasList(const char* key) const;
  // nullopt if the key is missing or null. kInput if the value has another type or breaks the rule.
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
  // Reads rows_min to rows_max lists of `columns` numbers each; returned row by row.
  Result<std::optional<std::vector<double>>> Matrix(const char* key, size_t rows_min,
                                                    size_t rows_max, size_t columns,
                                                    const NumberRule& rule) const;

  // kInput if a key that starts with lf_ is not in `known`. The message names the nearest known
  // key, or says that the key belongs to `elsewhere_place` if it is in `known_elsewhere`.
  Result<void> CheckLfKeys(std::span<const char* const> known,
                           std::span<const char* const> known_elsewhere,
                           const char* elsewhere_place) const;

  // "a/transforms.json: frames[3] (images/3.png): " + message
  Error Fault(std::string_view message) const;
  // "... "key" is VALUE: expected ..."
  Error Wrong(const char* key, std::string_view expected) const;

 private:
  std::optional<simdjson::dom::element> Find(const char* key) const;

  const JsonObject& object_;
  const std::filesystem::path& file_;
  std::optional<size_t> frame_index_;
  std::string_view file_path_;
};

}  // namespace lf
