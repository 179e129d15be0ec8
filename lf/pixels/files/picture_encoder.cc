// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/picture_encoder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

namespace lf {
namespace {

struct TextStep {
  std::string operator()(const std::string& text) const { return text; }
  std::string operator()(const FrameRate& rate) const { return fmt::format("{}", rate.per_second); }
  template <size_t kCount>
  std::string operator()(const std::array<float, kCount>& numbers) const {
    return fmt::format("{}", fmt::join(numbers, " "));
  }
  template <class Number>
  std::string operator()(Number number) const {
    return fmt::format("{}", number);
  }
};

}  // namespace

std::string TextOf(const MetadataValue& value) { return std::visit(TextStep(), value); }

std::string LinesOf(const ImageMetadata& metadata) {
  std::string lines;
  for (const auto& [key, value] : metadata) lines += fmt::format("{}: {}\n", key, TextOf(value));
  return lines;
}

}  // namespace lf
