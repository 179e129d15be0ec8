// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/view/chosen_points.h"
#include "lf/view/depth_points.h"

namespace lf {
namespace {

constexpr size_t kMostHeadBytes = 1 << 16;

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct PlyTypeName {
  const char* name;
  PlyType type;
  size_t size_bytes;
};
constexpr PlyTypeName kTypes[] = {
    {"char", PlyType::kInt8, 1},     {"int8", PlyType::kInt8, 1},
    {"uchar", PlyType::kUint8, 1},   {"uint8", PlyType::kUint8, 1},
    {"short", PlyType::kInt16, 2},   {"int16", PlyType::kInt16, 2},
    {"ushort", PlyType::kUint16, 2}, {"uint16", PlyType::kUint16, 2},
    {"int", PlyType::kInt32, 4},     {"int32", PlyType::kInt32, 4},
    {"uint", PlyType::kUint32, 4},   {"uint32", PlyType::kUint32, 4},
    {"float", PlyType::kFloat, 4},   {"float32", PlyType::kFloat, 4},
    {"double", PlyType::kDouble, 8}, {"float64", PlyType::kDouble, 8}};

// A property of a vertex that is used: its type, and where it is in the bytes of a vertex.
struct Property {
  PlyType type = PlyType::kFloat;
  size_t offset = 0;
};

constexpr std::array<const char*, 7> kUsed = {"x", "y", "z", "red", "green", "blue", "confidence"};

struct PlyHead {
  size_t vertex_count = 0;
  size_t vertex_bytes = 0;
  std::array<std::optional<Property>, kUsed.size()> used;  // in the order of kUsed
  std::optional<double> unit_m;                            // as lffocus depth states it
  size_t size_bytes = 0;                                   // of the head
};

// Returns the words of a line.
std::vector<std::string_view> WordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kSpaces = " \t\r";
  for (size_t at = line.find_first_not_of(kSpaces); at != std::string_view::npos;) {
    const size_t end = std::min(line.find_first_of(kSpaces, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kSpaces, end);
  }
  return words;
}

class HeadParser {
 public:
  HeadParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Result<PlyHead> Parse() {
    LF_ASSIGN_OR_RETURN(const std::string_view first, NextLine());
    if (WordsOf(first) != std::vector<std::string_view>{"ply"})
      return Fault("is no PLY file: expected `ply` in the first line");
    while (true) {
      LF_ASSIGN_OR_RETURN(const std::string_view line, NextLine());
      const std::vector<std::string_view> words = WordsOf(line);
      if (words.empty()) continue;
      if (words[0] == "end_header") break;
      LF_RETURN_IF_ERROR(TakeLine(words, line));
    }
    head_.size_bytes = at_;
    return Checked();
  }

 private:
  Error Fault(const std::string& fault) const { return InputError(name_ + ": " + fault); }

  Result<std::string_view> NextLine() {
    const size_t end = bytes_.substr(0, kMostHeadBytes).find('\n', at_);
    if (end == std::string_view::npos)
      return Fault(at_ == 0 ? "is no PLY file: expected `ply` in the first line"
                            : "is truncated or damaged: its head has no line end_header");
    const std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return line;
  }

  Result<void> TakeLine(const std::vector<std::string_view>& words, std::string_view line) {
    if (words[0] == "format") return TakeFormat(words);
    if (words[0] == "element") return TakeElement(words, line);
    if (words[0] == "property" && element_ == 1) return TakeProperty(words, line);
    // As lffocus depth writes it: comment world units; 0.001 m each
    if (words.size() == 6 && words[0] == "comment" && words[2] == "units;")
      head_.unit_m = NumberOf<double>(words[3]);
    return {};
  }

  Result<void> TakeFormat(const std::vector<std::string_view>& words) {
    has_format_ = words.size() == 3 && words[1] == "binary_little_endian" && words[2] == "1.0";
    if (has_format_) return {};
    return Fault(fmt::format(
        "has the format {}: expected binary_little_endian 1.0, as lffocus depth writes it; convert "
        "the file",
        words.size() > 1 ? words[1].substr(0, 40) : "of an unknown kind"));
  }

  Result<void> TakeElement(const std::vector<std::string_view>& words, std::string_view line) {
    if (++element_ > 1) return {};
    const auto count = words.size() == 3 ? NumberOf<uint64_t>(words[2]) : std::nullopt;
    if (words.size() < 2 || words[1] != "vertex" || !count)
      return Fault(fmt::format("its first element is `{}`: expected `element vertex COUNT`",
                               line.substr(0, 60)));
    head_.vertex_count = *count;
    return {};
  }

  Result<void> TakeProperty(const std::vector<std::string_view>& words, std::string_view line) {
    const PlyTypeName* type = nullptr;
    for (const PlyTypeName& known : kTypes)
      if (words.size() == 3 && words[1] == known.name) type = &known;
    if (type == nullptr)
      return Fault(fmt::format(
          "its vertices have the line `{}`: expected `property TYPE NAME` with a type of PLY, such "
          "as float, and no list",
          line.substr(0, 60)));
    for (size_t i = 0; i < kUsed.size(); ++i) {
      if (words[2] != kUsed[i]) continue;
      const bool is_colour = i >= 3 && i < 6;
      const bool is_right = is_colour
                                ? type->type == PlyType::kUint8
                                : type->type == PlyType::kFloat || type->type == PlyType::kDouble;
      if (!is_right)
        return Fault(fmt::format("property {} is {}: expected {}", kUsed[i], type->name,
                                 is_colour ? "uchar" : "float or double"));
      head_.used[i] = Property{type->type, head_.vertex_bytes};
    }
    head_.vertex_bytes += type->size_bytes;
    return {};
  }

  Result<PlyHead> Checked() const {
    if (!has_format_) return Fault("its head states no format: expected binary_little_endian 1.0");
    for (size_t i = 0; i < 3; ++i)
      if (!head_.used[i])
        return Fault(
            fmt::format("its vertices have no property {}: expected x, y and z", kUsed[i]));
    const size_t rest = bytes_.size() - head_.size_bytes;
    if (head_.vertex_count == 0) return Fault("has no point");
    if (head_.vertex_count > rest / head_.vertex_bytes)
      return Fault(fmt::format(
          "is truncated: {} points of {} bytes each are stated, but there are {} bytes: copy the "
          "file again",
          head_.vertex_count, head_.vertex_bytes, rest));
    return head_;
  }

  template <class T>
  static std::optional<T> NumberOf(std::string_view word) {
    T number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return number;
  }

  const std::string_view bytes_;
  const std::string& name_;
  size_t at_ = 0;
  int element_ = 0;
  bool has_format_ = false;
  PlyHead head_;
};

// Returns a property of type float, double or uchar.
double ValueOf(const char* vertex, const Property& property) {
  const char* const from = vertex + property.offset;
  if (property.type == PlyType::kUint8) return static_cast<uint8_t>(*from);
  if (property.type == PlyType::kDouble) {
    double value = 0;
    std::memcpy(&value, from, sizeof(value));
    return value;
  }
  float value = 0;
  std::memcpy(&value, from, sizeof(value));
  return double{value};
}

}  // namespace

Result<DepthPoints> ReadPlyPoints(std::string_view bytes, const std::string& name,
                                  const Vec3& origin, double unit_m, size_t most) {
  LF_ASSIGN_OR_RETURN(const PlyHead head, HeadParser(bytes, name).Parse());
  if (head.unit_m && !IsSameUnit(*head.unit_m, unit_m))
    return InputError(fmt::format(
        "{}: states world units of {:g} m, but those of the light field are {:g} m: give a point "
        "cloud of this light field",
        name, *head.unit_m, unit_m));
  DepthPoints points;
  points.count_in_file = head.vertex_count;
  points.has_confidence = head.used[6].has_value();
  points.has_colours = head.used[3] && head.used[4] && head.used[5];
  ChosenPoints chosen(head.vertex_count, most);
  // A camera with a view of 50 degrees, about 0.87 wide at the distance 1, sees a square of points.
  points.spread =
      0.87 * std::sqrt(static_cast<double>(chosen.step()) / static_cast<double>(head.vertex_count));
  const char* vertex = bytes.data() + head.size_bytes;
  for (size_t i = 0; i < head.vertex_count; ++i, vertex += head.vertex_bytes) {
    const Vec3 place(ValueOf(vertex, *head.used[0]), ValueOf(vertex, *head.used[1]),
                     ValueOf(vertex, *head.used[2]));
    const double confidence = points.has_confidence ? ValueOf(vertex, *head.used[6]) : 1;
    if (!place.allFinite())
      return InputError(fmt::format("{}: point {} is at {:g}, {:g}, {:g}: expected finite numbers",
                                    name, i, place.x(), place.y(), place.z()));
    if (!(confidence >= 0 && confidence <= 1))
      return InputError(
          fmt::format("{}: the confidence of point {} is {:g}: expected a number from 0 to 1", name,
                      i, confidence));
    if (!chosen.TakesNext()) continue;
    const Vec3 relative = place - origin;
    points.places.push_back({static_cast<float>(relative.x()), static_cast<float>(relative.y()),
                             static_cast<float>(relative.z())});
    std::array<uint8_t, 4> colour = {kColourless, kColourless, kColourless,
                                     ByteOfConfidence(confidence)};
    for (size_t c = 0; c < 3 && points.has_colours; ++c)
      colour[c] = static_cast<uint8_t>(ValueOf(vertex, *head.used[3 + c]));
    points.colours.push_back(colour);
  }
  return points;
}

}  // namespace lf
