// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/yaml_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace lf {
namespace {

YamlPlace PlaceOf(const YAML::Mark& mark) { return {mark.line + 1, mark.column + 1}; }

// Thrown for YAML that is not allowed in a path. ParseYaml() catches it like the parser's own
// exceptions.
struct Rejected : YAML::ParserException {
  using YAML::ParserException::ParserException;
};

// Builds the tree from yaml-cpp's events. They arrive while the text is read, so an invalid text is
// not read further.
class TreeBuilder : public YAML::EventHandler {
 public:
  YamlNodePtr TakeRoot() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) Fail(mark, "a second document starts here; a path is one document");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Add(NewNode(mark, YamlNode::Kind::kNull, anchor), mark);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    // yaml-cpp gives scalars without a tag these tags: "?" if plain, "!" if quoted.
    if (tag != "?" && tag != "!" && !tag.empty()) FailForTag(mark, tag);
    const auto kind = tag == "!" ? YamlNode::Kind::kQuoted : YamlNode::Kind::kPlain;
    const std::shared_ptr<YamlNode> node = NewNode(mark, kind, anchor);
    node->text = value;
    Add(node, mark);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    for (const OpenNode& open : open_)
      if (open.node == anchors_[anchor]) Fail(mark, "an alias is inside its own anchor; remove it");
    Add(anchors_[anchor], mark);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, YamlNode::Kind::kSequence);
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    Open(mark, tag, anchor, YamlNode::Kind::kMap);
  }
  void OnMapEnd() override { Close(); }

 private:
  struct OpenNode {
    std::shared_ptr<YamlNode> node;
    std::optional<YamlEntry> entry;  // of a map: the entry whose value follows; none: a key follows
  };

  [[noreturn]] static void Fail(const YAML::Mark& mark, const std::string& message) {
    throw Rejected(mark, message);
  }
  [[noreturn]] static void FailForTag(const YAML::Mark& mark, const std::string& tag) {
    Fail(mark, fmt::format("unexpected tag {}; write the bare value", QuoteForMessage(tag)));
  }

  std::shared_ptr<YamlNode> NewNode(const YAML::Mark& mark, YamlNode::Kind kind,
                                    YAML::anchor_t anchor) {
    auto node = std::make_shared<YamlNode>();
    node->kind = kind;
    node->place = PlaceOf(mark);
    if (anchor != 0) anchors_[anchor] = node;
    return node;
  }

  void Open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            YamlNode::Kind kind) {
    if (tag != "?" && !tag.empty()) FailForTag(mark, tag);
    if (open_.size() >= kMaxYamlDepth)
      Fail(mark, fmt::format("nested deeper than {} levels", kMaxYamlDepth));
    const std::shared_ptr<YamlNode> node = NewNode(mark, kind, anchor);
    Add(node, mark);
    open_.push_back({node, std::nullopt});
  }

  void Close() { open_.pop_back(); }

  void Add(const std::shared_ptr<YamlNode>& node, const YAML::Mark& mark) {
    if (open_.empty()) {
      root_ = node;
      return;
    }
    OpenNode& parent = open_.back();
    if (parent.node->kind == YamlNode::Kind::kSequence) {
      parent.node->items.push_back(node);
    } else if (parent.entry) {
      parent.entry->value = node;
      parent.node->entries.push_back(*std::exchange(parent.entry, std::nullopt));
    } else {
      if (node->kind != YamlNode::Kind::kPlain && node->kind != YamlNode::Kind::kQuoted)
        Fail(mark, "expected a word as key");
      parent.entry = YamlEntry{node->text, PlaceOf(mark), nullptr};
    }
  }

  YamlNodePtr root_;
  std::vector<OpenNode> open_;
  std::map<YAML::anchor_t, std::shared_ptr<YamlNode>> anchors_;
};

std::string Printable(std::string_view text) {
  std::string printable(text);
  for (char& c : printable)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return printable;
}

Error ErrorAt(std::string_view name, const YAML::Exception& error, std::string_view message) {
  const YamlPlace place = error.mark.is_null() ? YamlPlace{} : PlaceOf(error.mark);
  return InputError(fmt::format("{}:{}:{}: {}", name, place.line, place.column, message));
}

// Limits the memory of the parser. Every token of YAML except the first follows one of the
// characters that this function counts, no matter what the parser considers a key, a quotation or a
// comment.
Result<void> CheckBounds(std::string_view text, std::string_view name) {
  if (text.size() > kMaxYamlBytes)
    return InputError(fmt::format(
        "{}: has {} bytes, but a camera path has at most {}: split it, or give fewer keyframes",
        name, text.size(), kMaxYamlBytes));
  const auto mark_count = static_cast<size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return std::string_view("[]{},:-?&*!|>%\"'").find(c) != std::string_view::npos;
  }));
  if (mark_count > kMaxYamlMarks)
    return InputError(
        fmt::format("{}: has {} brackets, commas and other marks of YAML, but a camera path has at "
                    "most {}: split it, or give fewer keyframes",
                    name, mark_count, kMaxYamlMarks));
  return {};
}

}  // namespace

Result<YamlNodePtr> ParseYaml(std::string_view text, std::string_view name) {
  LF_RETURN_IF_ERROR(CheckBounds(text, name));
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    TreeBuilder builder;
    while (parser.HandleNextDocument(builder)) {
    }
    if (YamlNodePtr root = builder.TakeRoot()) return root;
    return InputError(fmt::format(
        "{}:1:1: the file is empty: expected a camera path (doc/formats/path.md)", name));
  } catch (const Rejected& error) {
    return ErrorAt(name, error, error.msg);
  } catch (const YAML::Exception& error) {
    return ErrorAt(name, error,
                   fmt::format("not YAML: {} (is a bracket, colon or quote missing near here, or "
                               "the indentation uneven?)",
                               Printable(error.msg)));
  }
}

std::string QuoteForMessage(std::string_view text) {
  constexpr size_t kLongest = 40;
  return fmt::format("'{}{}'", Printable(text.substr(0, kLongest)),
                     text.size() > kLongest ? "..." : "");
}

}  // namespace lf
