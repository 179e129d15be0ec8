// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/yaml_tree.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace lf {
namespace {

std::string ErrorOf(const std::string& text) {
  const auto tree = ParseYaml(text, "p.yaml");
  return tree ? "" : tree.error().message;
}

std::string Repeated(const std::string& piece, size_t count) {
  std::string text;
  for (size_t i = 0; i < count; ++i) text += piece;
  return text;
}

TEST(YamlTree, KnowsThePlaceOfKeysAndValues) {
  const auto tree = ParseYaml("a: 1\nb:\n  - x\n  - [2, 'y']\n", "p.yaml");
  ASSERT_TRUE(tree);
  const YamlNode& root = **tree;
  ASSERT_EQ(root.entries.size(), 2u);
  EXPECT_EQ(root.entries[1].key, "b");
  EXPECT_EQ(root.entries[1].place.line, 2);
  const YamlNode& list = *root.entries[1].value->items[1];
  EXPECT_EQ(list.items[1]->text, "y");
  EXPECT_EQ(list.items[1]->kind, YamlNode::Kind::kQuoted);
  EXPECT_EQ(list.items[1]->place.line, 4);
  EXPECT_EQ(list.items[1]->place.column, 9);
}

TEST(YamlTree, AnAliasIsItsAnchorsValue) {
  const auto tree = ParseYaml("a: &point [1, 2]\nb: *point\n", "p.yaml");
  ASSERT_TRUE(tree);
  EXPECT_EQ((*tree)->entries[0].value, (*tree)->entries[1].value);
}

TEST(YamlTree, SaysWhereAnErrorIs) {
  EXPECT_TRUE(ErrorOf("a: [1, 2\nb: 3\n").starts_with("p.yaml:2:2: not YAML: "));
  EXPECT_TRUE(ErrorOf("a: 1\n\tb: 3\n").starts_with("p.yaml:2:"));
  EXPECT_EQ(ErrorOf(""),
            "p.yaml:1:1: the file is empty: expected a camera path (doc/formats/path.md)");
  EXPECT_EQ(ErrorOf("a: 1\n---\nb: 1\n"),
            "p.yaml:2:1: a second document starts here; a path is one document");
  EXPECT_EQ(ErrorOf("[a]: 1\n"), "p.yaml:1:1: expected a word as key");
  EXPECT_EQ(ErrorOf("a: !!int 1\n"),
            "p.yaml:1:4: unexpected tag 'tag:yaml.org,2002:int'; write the bare value");
}

TEST(YamlTree, RefusesNestingBeyondItsBound) {
  const std::string list = "a: " + Repeated("[", kMaxYamlDepth) + Repeated("]", kMaxYamlDepth);
  EXPECT_EQ(ErrorOf(list), "p.yaml:1:19: nested deeper than 16 levels");
  EXPECT_EQ(ErrorOf(Repeated("- ", 100'000)), "p.yaml:1:33: nested deeper than 16 levels");
}

TEST(YamlTree, RefusesTooMuchTextBeforeParsingIt) {
  EXPECT_NE(ErrorOf(std::string(kMaxYamlBytes + 1, ' ')).find("bytes"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string(kMaxYamlMarks + 1, '[')).find("brackets"), std::string::npos);
}

TEST(YamlTree, AliasBombsStaySmall) {
  std::string text = "a: &a0 [x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 30; ++i)
    text += fmt::format("b{}: &a{} [{}]\n", i, i, Repeated(fmt::format("*a{} , ", i - 1), 9));
  EXPECT_TRUE(ParseYaml(text, "p.yaml"));  // expanded, its aliases would be 9^30 words
  EXPECT_EQ(ErrorOf("a: &a [*a]\n"), "p.yaml:1:8: an alias is inside its own anchor; remove it");
}

TEST(YamlTree, QuotesOnlyWhatCanBePrinted) {
  EXPECT_EQ(QuoteForMessage("a\nb\x1b"), "'a?b?'");
  EXPECT_EQ(QuoteForMessage(std::string(50, 'x')), "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace lf
