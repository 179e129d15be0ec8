// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/noise_moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "lf/core/check.h"

namespace lf {
namespace {

using Int128 = __int128;

constexpr int kMoments = 4;         // number of moments of an element and channel
constexpr size_t kMostDigits = 30;  // hexadecimal digits of a number below 2^120

// Reads hexadecimal numbers from a text. They have no sign and no leading zeros, and are separated
// by one space.
class HexReader {
 public:
  explicit HexReader(std::string_view text) : rest_(text) {}

  // Returns the next number; nullopt if the text does not continue with a number in this form.
  std::optional<UInt128> Next() {
    if (count_++ > 0) {
      if (rest_.empty() || rest_.front() != ' ') return std::nullopt;
      rest_.remove_prefix(1);
    }
    UInt128 number = 0;
    size_t digits = 0;
    for (; digits < rest_.size() && rest_[digits] != ' '; ++digits) {
      const char c = rest_[digits];
      const int value = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
      if (value < 0 || digits == kMostDigits) return std::nullopt;
      number = number << 4 | static_cast<UInt128>(value);
    }
    if (digits == 0 || (digits > 1 && rest_.front() == '0')) return std::nullopt;
    rest_.remove_prefix(digits);
    return number;
  }
  bool is_at_end() const { return rest_.empty(); }
  size_t count() const { return count_; }

 private:
  std::string_view rest_;
  size_t count_ = 0;
};

// Returns the part of an element's total that recorded LF images have added.
ElementSum OfRecorded(const ElementSum& total, const ElementMoments& moments) {
  return {total.sum - moments.of_virtual.sum, total.count - moments.of_virtual.count};
}

// Tests some inequalities that hold for any sums S_i and counts W_i of LF images (noise_moments.h).
// Returns false if these sums and moments break one of them, so that they cannot be right. All
// products fit in 128 bits.
bool CanBe(const ElementSum& all, const ElementMoments& moments) {
  if (moments.of_virtual.sum > all.sum || moments.of_virtual.count > all.count) return false;
  const ElementSum total = OfRecorded(all, moments);
  const UInt128 sum = total.sum, count = total.count, n = moments.image_count;
  const UInt128 squares = moments.sum_squares, cross = moments.cross_sum;
  if (n == 0)
    return squares == 0 && cross == 0 && moments.count_squares == 0 && total == ElementSum{};
  if (n > count || moments.count_squares < count || moments.count_squares > count * count)
    return false;
  if (cross < sum || cross > sum * count || squares < sum || squares > sum * sum) return false;
  return n * moments.count_squares >= count * count;  // Cauchy-Schwarz inequality
}

}  // namespace

double StandardErrorOfMean(const ElementSum& all, const ElementMoments& moments) {
  if (moments.image_count < 2) return std::numeric_limits<double>::infinity();
  const ElementSum total = OfRecorded(all, moments);
  // The moments of T_i = S_i - m0 W_i (S_i, W_i and the mean m are those of noise_moments.h; m0 is
  // the integer nearest to m) are computed exactly. Only m - m0, at most 1/2, needs floating point.
  // Intermediate unsigned values may wrap, but the results are below 2^122 in magnitude, and
  // correct as signed numbers.
  const UInt128 mean = (total.sum + total.count / 2) / total.count;
  const UInt128 count_squares = moments.count_squares;
  const UInt128 squares =
      moments.sum_squares - 2 * mean * moments.cross_sum + mean * mean * count_squares;
  const UInt128 cross = moments.cross_sum - mean * count_squares;
  const UInt128 sum = total.sum - mean * total.count;
  const auto number = [](UInt128 value) { return static_cast<double>(static_cast<Int128>(value)); };
  const auto count = static_cast<double>(total.count);
  const double off = number(sum) / count;
  const double variance_sum =
      number(squares) - 2 * off * number(cross) + off * off * number(count_squares);
  const double n = moments.image_count;
  return std::sqrt(n / (n - 1) * std::max(0.0, variance_sum)) / count;
}

NoiseMoments::NoiseMoments(int plate_width, int plate_height)
    : plate_width_(plate_width),
      plate_height_(plate_height),
      columns_(std::min(plate_width, kMostColumns)),
      rows_(std::min(plate_height, kMostRows)),
      moments_(static_cast<size_t>(columns_) * rows_ * SensorPlate::kChannels) {}

PlateElement NoiseMoments::ElementAt(size_t index) const {
  const auto middle = [](int64_t number, int64_t count, int64_t length) {
    return static_cast<int>((2 * number + 1) * length / (2 * count));
  };
  const auto column = static_cast<int64_t>(index) % columns_;
  const auto row = static_cast<int64_t>(index) / columns_;
  return {middle(column, columns_, plate_width_), middle(row, rows_, plate_height_)};
}

std::vector<size_t> NoiseMoments::IndicesIn(const PixelRect& rect) const {
  std::vector<size_t> indices;
  for (size_t first = 0; first < size(); first += columns_) {
    const int y = ElementAt(first).y;
    if (y < rect.y_begin || y >= rect.y_end) continue;
    for (size_t index = first; index < first + columns_; ++index) {
      const int x = ElementAt(index).x;
      if (x >= rect.x_begin && x < rect.x_end) indices.push_back(index);
    }
  }
  return indices;
}

void NoiseMoments::AddImage(size_t index, int channel, const ElementSum& of_image) {
  ElementMoments& moments = moments_[index * SensorPlate::kChannels + channel];
  const UInt128 sum = of_image.sum, count = of_image.count;
  moments.sum_squares += sum * sum;
  moments.cross_sum += sum * count;
  moments.count_squares += count * count;
  moments.image_count += count > 0 ? 1 : 0;
}

void NoiseMoments::AddVirtual(size_t index, int channel, const ElementSum& of_image) {
  ElementSum& of_virtual = moments_[index * SensorPlate::kChannels + channel].of_virtual;
  of_virtual.sum += of_image.sum;
  of_virtual.count += of_image.count;
}

bool NoiseMoments::HasVirtual() const {
  return std::any_of(moments_.begin(), moments_.end(),
                     [](const ElementMoments& one) { return one.of_virtual != ElementSum{}; });
}

std::string NoiseMoments::Text() const {
  std::string text = fmt::format("{:x} {:x}", columns_, rows_);
  for (const ElementMoments& one : moments_)
    fmt::format_to(std::back_inserter(text), " {:x} {:x} {:x} {:x}", one.sum_squares, one.cross_sum,
                   one.count_squares, one.image_count);
  if (HasVirtual())
    for (const ElementMoments& one : moments_)
      fmt::format_to(std::back_inserter(text), " {:x} {:x}", one.of_virtual.sum,
                     one.of_virtual.count);
  return text;
}

Result<NoiseMoments> NoiseMoments::Read(std::string_view text, const SensorPlate& plate) {
  NoiseMoments read(plate.width(), plate.height());
  HexReader reader(text);
  const auto fault = [&](const std::string& expected) {
    return InputError(fmt::format("its number {} is wrong, expected {}", reader.count(), expected));
  };
  for (const int side : {read.columns_, read.rows_})
    if (reader.Next() != static_cast<UInt128>(side))
      return fault(fmt::format("{:x}, because {} x {} elements of a plate of {} x {} are measured",
                               side, read.columns_, read.rows_, plate.width(), plate.height()));
  for (size_t i = 0; i < read.moments_.size(); ++i) {
    UInt128 numbers[kMoments];
    for (UInt128& number : numbers) {
      const std::optional<UInt128> next = reader.Next();
      if (!next) return fault("a hexadecimal number below 2^120 after one space");
      number = *next;
    }
    if (numbers[3] > UINT32_MAX) return fault("a number of LF images below 2^32");
    ElementMoments& moments = read.moments_[i];
    moments = {numbers[0], numbers[1], numbers[2], static_cast<uint32_t>(numbers[3]), {}};
  }
  const bool has_virtual = !reader.is_at_end();
  for (ElementMoments& moments : read.moments_) {
    if (!has_virtual) break;
    const std::optional<UInt128> sum = reader.Next(), count = reader.Next();
    if (!sum || !count || *sum > UINT64_MAX || *count > UINT64_MAX)
      return fault("a sum or count below 2^64");
    moments.of_virtual = {static_cast<uint64_t>(*sum), static_cast<uint64_t>(*count)};
  }
  if (!reader.is_at_end() || has_virtual != read.HasVirtual())
    return fault("no further number after it");
  for (size_t i = 0; i < read.moments_.size(); ++i) {
    const ElementMoments& moments = read.moments_[i];
    const PlateElement at = read.ElementAt(i / SensorPlate::kChannels);
    const int channel = static_cast<int>(i) % SensorPlate::kChannels;
    if (!CanBe(plate.At(at.x, at.y, channel), moments))
      return fault(fmt::format("sums that fit the rays in channel {} of element ({}, {})", channel,
                               at.x, at.y));
  }
  return read;
}

NoiseTally::NoiseTally(NoiseMoments* moments, const PixelRect& rect) : moments_(moments) {
  if (moments == nullptr) return;
  indices_ = moments->IndicesIn(rect);
  for (const size_t index : indices_) elements_.push_back(moments->ElementAt(index));
  before_.resize(indices_.size());
}

}  // namespace lf
