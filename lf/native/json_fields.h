// The keys of a JSON object as checked values, with errors that name file, frame, key, value and
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
#include "lf/native/json_object.h"

namespace simdjson::dom {
class element;
}  // namespace simdjson::dom

namespace lf {

// What a number must be: `expected` completes "expected ..." in the message.
struct NumberRule {
  const char* expected;
  bool (*holds)(double);
};

// A view of one object of a file; object, file and file_path must outlive it.
class JsonFields {
 public:
  // The top level of the file.
  JsonFields(const JsonObject& object, const std::filesystem::path& file)
      : object_(object), file_(file) {}
  // frames[frame_index], which describes the image file_path ("" while that is not known).
  JsonFields(const JsonObject& object, const std::filesystem::path& file, size_t frame_index,
             std::string_view file_path)
      : object_(object), file_(file), frame_index_(frame_index), file_path_(file_path) {}

  bool Has(const char* key) const;  // and it is not null
  bool HasList(const char* key) const;
  // None where the key is missing or null; kInput where the value has another type or breaks the
  // rule.
  Result<std::optional<double>> Number(const char* key, const NumberRule& rule) const;
  // A number, or a list of so many: then the list is the number that many times.
  Result<std::optional<std::vector<double>>> NumberOrNumbers(const char* key, size_t count,
                                                             const NumberRule& rule) const;
  Result<std::optional<bool>> Bool(const char* key) const;
  // At most 4096 bytes, without NUL characters.
  Result<std::optional<std::string>> Text(const char* key) const;
  // Lists of count_min to count_max numbers.
  Result<std::optional<std::vector<double>>> Numbers(const char* key, size_t count_min,
                                                     size_t count_max,
                                                     const NumberRule& rule) const;
  // rows_min to rows_max lists of `columns` numbers, row after row.
  Result<std::optional<std::vector<double>>> Matrix(const char* key, size_t rows_min,
                                                    size_t rows_max, size_t columns,
                                                    const NumberRule& rule) const;

  // kInput unless every key that starts with lf_ is among `known`; the message names the nearest
  // one, or says that the key belongs to `elsewhere_place`.
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
