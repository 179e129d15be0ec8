// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/export_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lf/core/parse_number.h"

namespace lf {
namespace {

constexpr size_t kMostXmlTags = size_t{1} << 24;
constexpr std::string_view kXmlBlanks = " \t\r\n";

std::string_view WithoutBlanks(std::string_view text) {
  const size_t begin = text.find_first_not_of(kXmlBlanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(kXmlBlanks) + 1 - begin);
}

// Returns a text in quotes, as messages show it, shortened if it is long.
std::string ShownText(std::string_view text) {
  constexpr size_t kLongest = 80;
  if (text.size() <= kLongest) return fmt::format("\"{}\"", text);
  return fmt::format("\"{}...\"", text.substr(0, kLongest));
}

// Returns the name of an element, with what tells it apart: "sensor 0" or "camera 3 (DSC_01)".
std::string NameInPlace(const pugi::xml_node& node) {
  std::string name = node.name();
  if (const pugi::xml_attribute id = node.attribute("id"))
    name += fmt::format(" {}", std::string_view(id.value()).substr(0, 80));
  if (const pugi::xml_attribute label = node.attribute("label"))
    name += fmt::format(" ({})", std::string_view(label.value()).substr(0, 80));
  return name;
}

// Returns the path of an element below the outermost one, at most its last eight parts.
std::string PlaceOf(pugi::xml_node node) {
  constexpr int kMostParts = 8;
  std::string place;
  for (int i = 0; i < kMostParts && node && node.parent() && node.parent().parent(); ++i) {
    place = place.empty() ? NameInPlace(node) : fmt::format("{}/{}", NameInPlace(node), place);
    node = node.parent();
  }
  return place.empty() ? "the file" : place;
}

}  // namespace

std::optional<std::vector<double>> NumbersIn(std::string_view text, size_t count, double most) {
  std::vector<double> numbers;
  for (text = WithoutBlanks(text); !text.empty();) {
    const std::string_view word = text.substr(0, text.find_first_of(kXmlBlanks));
    const std::optional<double> number = ParseNumber(word);
    if (!number || !(std::abs(*number) <= most) || numbers.size() == count) return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(word.size());
    text.remove_prefix(std::min(text.find_first_not_of(kXmlBlanks), text.size()));
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

std::vector<XmlElement> XmlElement::Children(const char* name) const {
  std::vector<XmlElement> children;
  for (const pugi::xml_node& node : node_.children(name)) children.push_back({node, file_});
  return children;
}

std::optional<std::string_view> XmlElement::Attribute(const char* name) const {
  const pugi::xml_attribute attribute = node_.attribute(name);
  if (!attribute) return std::nullopt;
  return std::string_view(attribute.value());
}

std::string_view XmlElement::Text() const { return WithoutBlanks(node_.child_value()); }

std::optional<std::string_view> XmlElement::Property(const char* name) const {
  if (const auto attribute = Attribute(name)) return WithoutBlanks(*attribute);
  const XmlElement child = Child(name);
  if (!child.exists()) return std::nullopt;
  return child.Text();
}

Result<double> XmlElement::Number(double most) const {
  const auto numbers = NumbersIn(Text(), 1, most);
  if (!numbers) return Wrong(fmt::format("a number within +-{:g}", most));
  return numbers->front();
}

Result<std::vector<double>> XmlElement::Numbers(size_t count, double most) const {
  auto numbers = NumbersIn(Text(), count, most);
  if (!numbers) return Wrong(fmt::format("{} numbers within +-{:g}", count, most));
  return *std::move(numbers);
}

Result<double> XmlElement::NumberOr(const char* name, double otherwise, double most) const {
  const XmlElement child = Child(name);
  if (!child.exists()) return otherwise;
  return child.Number(most);
}

Result<std::vector<double>> XmlElement::NumbersOfProperty(const char* name, size_t count,
                                                          double most) const {
  const std::optional<std::string_view> text = Property(name);
  if (!text) return Fault(fmt::format("has no {}", name));
  auto numbers = NumbersIn(*text, count, most);
  if (!numbers)
    return Fault(fmt::format("has the {} {}: expected {} within +-{:g}", name, ShownText(*text),
                             count == 1 ? "a number" : fmt::format("{} numbers", count), most));
  return *std::move(numbers);
}

Result<int> XmlElement::WholeAttribute(const char* name, int least, int most) const {
  const std::optional<std::string_view> text = Attribute(name);
  const std::optional<int> whole = text ? ParseWhole<int>(*text) : std::nullopt;
  if (!whole || *whole < least || *whole > most)
    return Fault(fmt::format("has {}: expected a whole number from {} to {}",
                             text ? fmt::format("the {} {}", name, ShownText(*text))
                                  : fmt::format("no attribute {}", name),
                             least, most));
  return *whole;
}

Error XmlElement::Wrong(std::string_view expected) const {
  return Fault(fmt::format("is {}: expected {}", ShownText(Text()), expected));
}

Error XmlElement::Fault(std::string_view message) const {
  return InputError(fmt::format("{}: {} {}", file_->string(), PlaceOf(node_), message));
}

Result<XmlFile> XmlFile::Parse(std::string_view text, const std::filesystem::path& file) {
  if (static_cast<size_t>(std::count(text.begin(), text.end(), '<')) > kMostXmlTags)
    return InputError(fmt::format("{}: holds more than {} tags", file.string(), kMostXmlTags));
  XmlFile parsed;
  parsed.text_ = std::make_unique<std::string>(text);
  parsed.file_ = std::make_unique<std::filesystem::path>(file);
  parsed.document_ = std::make_unique<pugi::xml_document>();
  const pugi::xml_parse_result result =
      parsed.document_->load_buffer_inplace(parsed.text_->data(), parsed.text_->size());
  if (result.status == pugi::status_out_of_memory)
    return OutputError(fmt::format("{}: the memory does not suffice to read it", file.string()));
  if (!result)
    return InputError(fmt::format("{}: is not XML: {} after {} bytes", file.string(),
                                  result.description(), result.offset));
  if (!parsed.Root().exists())
    return InputError(fmt::format("{}: is not XML: it holds no element", file.string()));
  return parsed;
}

}  // namespace lf
