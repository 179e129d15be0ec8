#include "lf/pixels/files/picture_encoder.h"

#include <fmt/format.h>

namespace lf {

std::string TextOf(const std::variant<std::string, double, int>& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return fmt::format("{}", std::get<int>(value));
}

std::string LinesOf(const ImageMetadata& metadata) {
  std::string lines;
  for (const auto& [key, value] : metadata) lines += fmt::format("{}: {}\n", key, TextOf(value));
  return lines;
}

}  // namespace lf
