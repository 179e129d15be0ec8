// What a YAML text may hold: typed values of maps whose every key is known. Errors are collected,
// so that readers go on with a default and the file's author sees how many there are.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/result.h"
#include "lf/path/yaml_tree.h"

namespace lf {

class YamlErrors {
 public:
  explicit YamlErrors(std::string_view file_name) : file_name_(file_name) {}

  // "file:line:column: message"
  void Add(const YamlPlace& place, std::string message);
  // Before all others: a misspelt key explains why another one is missing.
  void AddFirst(const YamlPlace& place, std::string message);

  bool empty() const { return errors_.empty(); }
  // What follows is dropped: the rest of a file this wrong is not worth reading.
  bool full() const { return errors_.size() >= 20; }
  const std::string& file_name() const { return file_name_; }

  // One line: the first error, and where the others are. Only if there is one.
  Error First() const;

 private:
  struct Entry {
    YamlPlace place;
    std::string message;
  };
  std::string file_name_;
  std::vector<Entry> errors_;
  size_t first_count_ = 0;  // of errors_, those of AddFirst()
};

// Values a number may take, in the units of the file.
struct NumberRange {
  double min = -kLargest;
  double max = kLargest;
  bool open = false;  // min and max themselves are excluded

  // What is larger is taken for a mistake.
  static constexpr double kLargest = 1e9;
  static constexpr NumberRange Any() { return {}; }
  static constexpr NumberRange AtLeast(double min) { return {min, kLargest, false}; }
  static constexpr NumberRange Above(double min) { return {min, kLargest, true}; }
  static constexpr NumberRange Within(double min, double max) { return {min, max, false}; }
  static constexpr NumberRange Between(double min, double max) { return {min, max, true}; }

  bool Holds(double value) const;  // false for NaN
  std::string Describe() const;    // "above 0 (below 1e+09)", "from 1 to 3", ...
};

// A map of the file. Each key asked for becomes an allowed one; CheckKeys() reports the others.
class YamlMap {
 public:
  // title   for messages: "camera"; the empty title is the whole file
  // Not a map, or a key twice: an error, and the map is empty or keeps the first.
  YamlMap(const YamlNode& node, std::string title, YamlErrors* errors);
  // A map that was not given; has no key.
  YamlMap(std::string title, YamlErrors* errors) : title_(std::move(title)), errors_(errors) {}

  const YamlPlace& place() const { return place_; }
  YamlErrors* errors() const { return errors_; }
  // "camera.speed"
  std::string Label(std::string_view key) const;

  // The entry, or null.
  const YamlEntry* Find(std::string_view key);
  // The same, an error if there is none. `example`: what to write, "fps: 30".
  const YamlEntry* Require(std::string_view key, std::string_view example);

  // Keys that are allowed so far, in the order they were asked for.
  const std::vector<std::string>& asked() const { return asked_; }
  // Reports the keys nobody asked for, with the nearest allowed one.
  void CheckKeys();

 private:
  std::string title_;
  YamlErrors* errors_;
  YamlPlace place_;
  std::vector<const YamlEntry*> entries_;
  std::vector<std::string> asked_;
};

// "unknown key 'fsp' in camera; did you mean 'fps'? Known are: ..."
std::string UnknownWord(std::string_view kind, std::string_view word, std::string_view where,
                        const std::vector<std::string>& known);

// The value of a node, or none and an error that begins with the label.
std::optional<double> ReadNumber(const YamlNode& node, std::string_view label,
                                 const NumberRange& range, YamlErrors* errors);
std::optional<int> ReadInteger(const YamlNode& node, std::string_view label, int min, int max,
                               YamlErrors* errors);
std::optional<bool> ReadBool(const YamlNode& node, std::string_view label, YamlErrors* errors);
std::optional<std::string> ReadWord(const YamlNode& node, std::string_view label,
                                    const std::vector<std::string>& allowed, YamlErrors* errors);
// A list of exactly `count` numbers.
std::optional<std::vector<double>> ReadNumbers(const YamlNode& node, std::string_view label,
                                               size_t count, const NumberRange& range,
                                               YamlErrors* errors);

}  // namespace lf
