// SPDX-License-Identifier: Apache-2.0
// A YAML text as a tree of our own types, with the position of every key and value. No other file
// uses yaml-cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"

namespace lf {

struct YamlPlace {
  int line = 1;    // counted from 1
  int column = 1;  // counted from 1
};

struct YamlNode;
using YamlNodePtr = std::shared_ptr<const YamlNode>;

struct YamlEntry {
  std::string key;
  YamlPlace place;  // position of the key
  YamlNodePtr value;
};

struct YamlNode {
  enum class Kind { kNull, kPlain, kQuoted, kSequence, kMap };

  Kind kind = Kind::kNull;
  YamlPlace place;
  std::string text;                // content of a kPlain or kQuoted node
  std::vector<YamlNodePtr> items;  // items of a kSequence
  std::vector<YamlEntry> entries;  // entries of a kMap, in the order of the file; keys may repeat
};

// Limits of the text of a camera path. The first two are checked before the text is parsed, the
// depth of nesting while it is parsed. No path made by people or programs comes near these limits,
// and parsing the worst text within them takes about 350 MB and 2 s.
inline constexpr size_t kMaxYamlBytes = size_t{8} << 20;
inline constexpr size_t kMaxYamlMarks = 1'000'000;  // number of characters such as : [ {
inline constexpr size_t kMaxYamlDepth = 16;

// Returns the only document of the text. Aliases share the node of their anchor.
//
// name   name of the file in messages: "name:line:column: ..."
//
// kInput: the text is empty or not YAML, exceeds a limit, or has several documents, keys that are
// not words, tags, or an alias inside its own anchor.
Result<YamlNodePtr> ParseYaml(std::string_view text, std::string_view name);

// Returns the text in quotes, for a message. Cuts it after 40 bytes, and replaces control
// characters by "?".
std::string QuoteForMessage(std::string_view text);

}  // namespace lf
