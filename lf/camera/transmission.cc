// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/transmission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace lf {
namespace {

// Returns true if a place touches the circle that the picture encloses.
bool IsInCircle(int column, int row, int side) {
  const double middle = 0.5 * side;
  const double across = std::max(0.0, std::abs(column + 0.5 - middle) - 0.5);
  const double down = std::max(0.0, std::abs(row + 0.5 - middle) - 0.5);
  return across * across + down * down < middle * middle;
}

bool IsDark(const Image<uint8_t>& shares) {
  for (int row = 0; row < shares.height(); ++row)
    for (int column = 0; column < shares.width(); ++column)
      if (shares.at(column, row) > 0 && IsInCircle(column, row, shares.width())) return false;
  return true;
}

Error DarkError() {
  return InputError(
      "the picture is wholly dark within the circle of the opening, so that the lens lets no light "
      "through: white lets light through, black does not; small bright spots of large pictures are "
      "lost, because these are reduced to 64 x 64 places");
}

std::optional<int> DigitOf(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return std::nullopt;
}

std::vector<std::string_view> SplitAt(char separator, std::string_view text) {
  std::vector<std::string_view> parts;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

Result<Transmission> Transmission::Of(const Image<uint8_t>& shares) {
  const int longer = std::max(shares.width(), shares.height());
  if (shares.empty()) return InputError("the picture is empty");
  const int block = (longer + kMostSide - 1) / kMostSide;
  const int side = (longer + block - 1) / block;
  // Place (0, 0) begins at this pixel, so that the middle of the picture is that of the square.
  const int left = (shares.width() - side * block) / 2, top = (shares.height() - side * block) / 2;
  Image<int> sums(side, side);
  for (int y = 0; y < shares.height(); ++y)
    for (int x = 0; x < shares.width(); ++x)
      sums.at((x - left) / block, (y - top) / block) += shares.at(x, y);
  Image<uint8_t> places(side, side);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      places.at(column, row) =
          static_cast<uint8_t>((sums.at(column, row) + block * block / 2) / (block * block));
  if (IsDark(places)) return DarkError();
  return Transmission(std::move(places));
}

double Transmission::Mean() const {
  double sum = 0;
  for (const uint8_t share : shares_.pixels()) sum += share;
  return sum / 255 / (side() * side());
}

std::string Transmission::Text() const {
  std::string text;
  for (int row = 0; row < side(); ++row) {
    if (row > 0) text += '/';
    for (int column = 0; column < side(); ++column)
      text += fmt::format("{:02x}", Share(column, row));
  }
  return text;
}

Result<Transmission> Transmission::FromText(std::string_view text) {
  const Error form = InputError(fmt::format(
      "expected rows of two hexadecimal digits (0-9, a-f) for each place with a '/' between them, "
      "such as \"00ff/ff00\", that form a square of at most {} places",
      kMostSide));
  const std::vector<std::string_view> rows = SplitAt('/', text);
  if (rows.size() > kMostSide) return form;
  const int side = static_cast<int>(rows.size());
  Image<uint8_t> places(side, side);
  for (int row = 0; row < side; ++row) {
    const std::string_view digits = rows[static_cast<size_t>(row)];
    if (digits.size() != 2 * rows.size()) return form;
    for (int column = 0; column < side; ++column) {
      const auto high = DigitOf(digits[2 * static_cast<size_t>(column)]);
      const auto low = DigitOf(digits[2 * static_cast<size_t>(column) + 1]);
      if (!high || !low) return form;
      places.at(column, row) = static_cast<uint8_t>(16 * *high + *low);
    }
  }
  if (IsDark(places)) return DarkError();
  return Transmission(std::move(places));
}

bool AreEqual(const TransmissionPtr& a, const TransmissionPtr& b) {
  return a == b || (a && b && *a == *b);
}

TransmissionAxes::TransmissionAxes(const Transmission& transmission, const Aperture& aperture)
    : middle(0.5 * transmission.side()) {
  // The opening is turned first, then squeezed; the way back is the inverse of both.
  const Vec2 widen(std::max(1.0, aperture.ratio), std::max(1.0, 1 / aperture.ratio));
  const double per_w = middle / aperture.radius_w;
  const double c = std::cos(aperture.rotation_rad), s = std::sin(aperture.rotation_rad);
  across = per_w * Vec2(c, s).cwiseProduct(widen);
  down = -per_w * Vec2(-s, c).cwiseProduct(widen);
}

double LightThrough(const Transmission& transmission, const Aperture& aperture,
                    const Vec2& point_lens) {
  const TransmissionAxes axes(transmission, aperture);
  const int column = static_cast<int>(std::floor(axes.Column(point_lens)));
  const int row = static_cast<int>(std::floor(axes.Row(point_lens)));
  const int side = transmission.side();
  if (column < 0 || column >= side || row < 0 || row >= side) return 0;
  return transmission.Share(column, row) / 255.0;
}

}  // namespace lf
