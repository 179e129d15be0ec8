// SPDX-License-Identifier: Apache-2.0
// Reads typed values from a YAML text, in whose maps every key must be known. Errors are collected:
// readers continue with a default, so that the author of the file sees how many errors there are.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/camera/path/yaml_tree.h"
#include "lf/core/result.h"

namespace lf {

class YamlErrors {
 public:
  explicit YamlErrors(std::string_view file_name) : file_name_(file_name) {}

  // Adds the error "file:line:column: message".
  void Add(const YamlPlace& place, std::string message);
  // Adds an error in front of the errors of Add(), because a misspelt key explains why another key
  // is missing.
  void AddFirst(const YamlPlace& place, std::string message);

  bool empty() const { return errors_.empty(); }
  // Returns true if there are 20 errors. Further errors are dropped, because they would not help
  // the author.
  bool full() const { return errors_.size() >= 20; }
  const std::string& file_name() const { return file_name_; }

  // Returns the first error and the line numbers of the others, in one line of text. There must be
  // an error.
  Error First() const;

 private:
  struct Entry {
    YamlPlace place;
    std::string message;
  };
  std::string file_name_;
  std::vector<Entry> errors_;
  size_t first_count_ = 0;  // number of errors added by AddFirst(), at the front of errors_
};

// Range of a number, in the units of the file.
struct NumberRange {
  double min = -kLargest;
  double max = kLargest;
  bool open = false;  // true: min and max themselves are excluded

  // Largest absolute value of a number in the file; larger numbers are considered mistakes.
  static constexpr double kLargest = 1e9;
  static constexpr NumberRange Any() { return {}; }
  static constexpr NumberRange AtLeast(double min) { return {min, kLargest, false}; }
  static constexpr NumberRange Above(double min) { return {min, kLargest, true}; }
  static constexpr NumberRange Within(double min, double max) { return {min, max, false}; }
  static constexpr NumberRange Between(double min, double max) { return {min, max, true}; }

  bool Holds(double value) const;  // true if the value is within the range; false for NaN
  std::string Describe() const;    // text for messages: "above 0 (below 1e+09)", "from 1 to 3", ...
};

// A map of the file. A key is allowed once Find() or Require() has looked it up; CheckKeys()
// reports the other keys.
class YamlMap {
 public:
  // title: name of the map in messages, such as "camera"; empty for the whole file. If the node is
  // not a map, an error is added, and the map is empty. If a key occurs twice, an error is added,
  // and the first is kept.
  YamlMap(const YamlNode& node, std::string title, YamlErrors* errors);
  // Makes a map without keys, in place of a map that the file does not have.
  YamlMap(std::string title, YamlErrors* errors) : title_(std::move(title)), errors_(errors) {}

  const YamlPlace& place() const { return place_; }
  YamlErrors* errors() const { return errors_; }
  // Returns the name of a key in messages: "camera.speed".
  std::string Label(std::string_view key) const;

  // Returns the entry of a key; null if there is none.
  const YamlEntry* Find(std::string_view key);
  // Returns the entry of a key; null, with an error, if there is none. `example` shows in the
  // message what to write, such as "fps: 30".
  const YamlEntry* Require(std::string_view key, std::string_view example);

  // Returns the keys that are allowed so far, in the order in which they were looked up.
  const std::vector<std::string>& asked() const { return asked_; }
  // Reports each key that is not allowed, with the nearest allowed key.
  void CheckKeys();

 private:
  std::string title_;
  YamlErrors* errors_;
  YamlPlace place_;
  std::vector<const YamlEntry*> entries_;
  std::vector<std::string> asked_;
};

// Returns the message "unknown key 'fsp' in camera; did you mean 'fps'? known are: ...".
std::string UnknownWord(std::string_view kind, std::string_view word, std::string_view where,
                        const std::vector<std::string>& known);

// The next four functions return the value of a node; none, with an error that begins with the
// label, if it is invalid.
std::optional<double> ReadNumber(const YamlNode& node, std::string_view label,
                                 const NumberRange& range, YamlErrors* errors);
std::optional<int> ReadInteger(const YamlNode& node, std::string_view label, int min, int max,
                               YamlErrors* errors);
std::optional<bool> ReadBool(const YamlNode& node, std::string_view label, YamlErrors* errors);
std::optional<std::string> ReadWord(const YamlNode& node, std::string_view label,
                                    const std::vector<std::string>& allowed, YamlErrors* errors);
// Adds the error that `expected` was expected, and what was found instead: the kind or the text of
// the node.
void AddExpected(const YamlNode& node, std::string_view label, std::string_view expected,
                 YamlErrors* errors);
// Returns a list of exactly `count` numbers; none, with an error, if the node is no such list.
std::optional<std::vector<double>> ReadNumbers(const YamlNode& node, std::string_view label,
                                               size_t count, const NumberRange& range,
                                               YamlErrors* errors);

}  // namespace lf
