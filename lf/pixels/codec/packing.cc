// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/packing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "lf/pixels/codec/entropy.h"
#include "lf/pixels/codec/packing_kernels.h"

namespace lf {
namespace {

template <size_t kPerByte>
std::vector<uint8_t> PackedBy(std::span<const uint32_t> numbers) {
  constexpr int kBits = 8 / kPerByte;
  constexpr uint32_t kEscape = (1u << kBits) - 1;
  const auto byte_of = [&](size_t begin, size_t count) {
    uint32_t packed = 0;
    for (size_t place = 0; place < count; ++place)
      packed |= std::min(numbers[begin + place], kEscape) << (kBits * place);
    return static_cast<uint8_t>(packed);
  };
  const size_t whole = numbers.size() / kPerByte;
  std::vector<uint8_t> bytes((numbers.size() + kPerByte - 1) / kPerByte);
  for (size_t i = 0; i < whole; ++i) bytes[i] = byte_of(i * kPerByte, kPerByte);
  if (whole < bytes.size()) bytes[whole] = byte_of(whole * kPerByte, numbers.size() % kPerByte);
  return bytes;
}

std::vector<uint8_t> Packed(Packing packing, std::span<const uint32_t> numbers) {
  const size_t count = numbers.size();
  if (IsPlanes(packing)) {
    std::vector<uint8_t> bytes(count * PlaneCount(packing));
    for (int plane = 0; plane < PlaneCount(packing); ++plane)
      for (size_t i = 0; i < count; ++i)
        bytes[plane * count + i] = static_cast<uint8_t>(numbers[i] >> (8 * plane));
    return bytes;
  }
  switch (packing) {
    case Packing::kOne:
      return PackedBy<1>(numbers);
    case Packing::kTwo:
      return PackedBy<2>(numbers);
    default:
      return PackedBy<4>(numbers);
  }
}

std::vector<uint32_t> Escapes(Packing packing, std::span<const uint32_t> numbers) {
  const uint32_t escape = EscapeOf(packing);
  // Each value is written at the next free position, escape or not, so that the loop has no branch
  // that the processor would have to predict.
  std::vector<uint32_t> escapes(numbers.size() + 1);
  size_t count = 0;
  for (const uint32_t number : numbers) {
    escapes[count] = number - escape;
    count += number >= escape ? 1 : 0;
  }
  escapes.resize(count);
  return escapes;
}

// Returns the estimated size in bytes if an entropy coder encodes each byte by its frequency.
double Cost(std::span<const uint8_t> bytes) {
  std::array<uint32_t, 256> counts{};
  for (const uint8_t byte : bytes) ++counts[byte];
  double bits = 0;
  for (const uint32_t count : counts)
    if (count > 0) bits -= count * std::log2(count / static_cast<double>(bytes.size()));
  return bits / 8;
}

struct Choice {
  Packing packing = Packing::kZeros;
  double cost = 0;  // estimated size of the encoded stream, in bytes
};

// Returns the packing that needs the fewest bytes by estimate. kOverhead is the fixed size of each
// stream, in bytes.
//   escapes_left  number of nested streams of escapes that are still allowed
Choice BestPacking(std::span<const uint32_t> numbers, int escapes_left) {
  constexpr double kOverhead = 40;
  if (numbers.empty()) return {};
  const uint32_t largest = *std::max_element(numbers.begin(), numbers.end());
  if (largest == 0) return {Packing::kZeros, 1};
  Choice best{Packing::kZeros, 1e300};
  const auto offer = [&best](Packing packing, double cost) {
    if (cost < best.cost) best = {packing, cost};
  };
  const Packing planes = largest >> 16 == 0   ? Packing::kPlanes2
                         : largest >> 24 == 0 ? Packing::kPlanes3
                                              : Packing::kPlanes4;
  if (largest >= EscapeOf(Packing::kOne)) {
    double cost = kOverhead;
    const std::vector<uint8_t> bytes = Packed(planes, numbers);
    for (int plane = 0; plane < PlaneCount(planes); ++plane)
      cost += Cost(std::span(bytes).subspan(plane * numbers.size(), numbers.size()));
    offer(planes, cost);
  }
  for (const Packing packing : {Packing::kOne, Packing::kTwo, Packing::kFour}) {
    const bool has_escapes = largest >= EscapeOf(packing);
    if (has_escapes && escapes_left == 0) continue;
    double cost = kOverhead + Cost(Packed(packing, numbers));
    if (has_escapes && cost < best.cost)
      cost += BestPacking(Escapes(packing, numbers), escapes_left - 1).cost;
    offer(packing, cost);
  }
  return best;
}

// Returns the best packing for the numbers, or, if there are more than kRun * kRuns, for a sample
// of them: kRuns runs that are spread evenly.
Packing ChosenPacking(std::span<const uint32_t> numbers, int escapes_left) {
  constexpr size_t kRun = 256, kRuns = 32;
  const uint32_t largest = *std::max_element(numbers.begin(), numbers.end());
  if (numbers.size() <= kRun * kRuns) return BestPacking(numbers, escapes_left).packing;
  std::vector<uint32_t> sample;
  for (size_t i = 0; i < kRuns; ++i) {
    const auto run = numbers.subspan(i * (numbers.size() - kRun) / (kRuns - 1), kRun);
    sample.insert(sample.end(), run.begin(), run.end());
  }
  // The sample may lack the rarest numbers, but the chosen packing must hold the largest.
  sample.push_back(largest);
  return BestPacking(sample, escapes_left).packing;
}

void AppendBlock(std::span<const uint8_t> bytes, std::string* code) {
  std::string compressed;
  AppendCompressed(bytes, &compressed);
  AppendNumber(compressed.size(), code);
  *code += compressed;
}

void AppendNumbers(std::span<const uint32_t> numbers, int escapes_left, std::string* code) {
  const Packing packing = ChosenPacking(numbers, escapes_left);
  code->push_back(static_cast<char>(packing));
  if (packing == Packing::kZeros) return;
  AppendBlock(Packed(packing, numbers), code);
  if (IsPlanes(packing)) return;
  const std::vector<uint32_t> escapes = Escapes(packing, numbers);
  AppendNumber(escapes.size(), code);
  if (!escapes.empty()) AppendNumbers(escapes, escapes_left - 1, code);
}

[[nodiscard]] bool TakeBlock(std::string_view* code, std::span<uint8_t> bytes) {
  uint64_t size = 0;
  std::string_view compressed;
  return TakeNumber(code, code->size(), &size) && TakeBytes(code, size, &compressed) &&
         Decompress(compressed, bytes);
}

bool IsPacking(Packing packing, size_t bytes_of_number) {
  switch (packing) {
    case Packing::kOne:
    case Packing::kTwo:
    case Packing::kFour:
    case Packing::kPlanes2:
      return true;
    case Packing::kPlanes3:
    case Packing::kPlanes4:
      return bytes_of_number == 4;
    default:
      return false;
  }
}

// Memory that a thread reuses. A stream and each level of its escapes have an object of their own.
template <class U>
struct PackingScratch {
  std::vector<uint8_t> bytes;
  std::vector<U> escapes;

  static PackingScratch& OfThread(int escapes_left) {
    static thread_local std::array<PackingScratch, kMostEscapes + 1> scratch;
    return scratch[escapes_left];
  }
};

template <class U>
[[nodiscard]] bool TakeNumbers(Transform transform, int escapes_left, std::string_view* code,
                               size_t count, U* numbers) {
  std::string_view kind;
  if (!TakeBytes(code, 1, &kind)) return false;
  const auto packing = static_cast<Packing>(kind.front());
  if (packing == Packing::kZeros) {
    std::fill_n(numbers, count, U{0});
    return true;
  }
  if (!IsPacking(packing, sizeof(U))) return false;
  auto& [bytes, escapes] = PackingScratch<U>::OfThread(escapes_left);
  const size_t size = IsPlanes(packing) ? count * PlaneCount(packing)
                                        : (count + PerByte(packing) - 1) / PerByte(packing);
  bytes.resize(size + kSlack);
  PackedStream<U> stream{packing, std::span(bytes).first(size), count, {}, false};
  if (!TakeBlock(code, std::span(bytes).first(size))) return false;
  if (!IsPlanes(packing)) {
    uint64_t escape_count = 0;
    if (!TakeNumber(code, count, &escape_count)) return false;
    if (escape_count > 0 && escapes_left == 0) return false;
    escapes.resize(escape_count + kSlack);
    stream.escapes = std::span(escapes).first(escape_count);
    if (escape_count > 0 &&
        !TakeNumbers(transform, escapes_left - 1, code, escape_count, escapes.data()))
      return false;
  }
  stream.has_signs = escapes_left == kMostEscapes;
  return transform == Transform::kReference ? UnpackReference(stream, numbers)
                                            : UnpackSimd(stream, numbers);
}

}  // namespace

template <class T>
void AppendCoefficients(std::span<const int32_t> values, std::string* code) {
  if (values.empty()) return;
  std::vector<uint32_t> folded(values.size());
  std::transform(values.begin(), values.end(), folded.begin(), Folded<int32_t>);
  AppendNumbers(folded, kMostEscapes, code);
}
template void AppendCoefficients<int16_t>(std::span<const int32_t>, std::string*);
template void AppendCoefficients<int32_t>(std::span<const int32_t>, std::string*);

template <class T>
bool TakeCoefficients(Transform transform, std::string_view* code, size_t count, T* values) {
  if (count == 0) return true;
  auto* const numbers = reinterpret_cast<std::make_unsigned_t<T>*>(values);
  return TakeNumbers(transform, kMostEscapes, code, count, numbers);
}
template bool TakeCoefficients(Transform, std::string_view*, size_t, int16_t*);
template bool TakeCoefficients(Transform, std::string_view*, size_t, int32_t*);

template <class U>
bool UnpackReference(const PackedStream<U>& stream, U* numbers) {
  const auto& [packing, bytes, count, escapes, has_signs] = stream;
  size_t escape_count = 0;
  for (size_t i = 0; i < count; ++i) {
    uint32_t number = 0;
    if (IsPlanes(packing)) {
      for (int plane = 0; plane < PlaneCount(packing); ++plane)
        number |= uint32_t{bytes[plane * count + i]} << (8 * plane);
    } else {
      const int per_byte = PerByte(packing), bits = 8 / per_byte;
      number = (bytes[i / per_byte] >> (bits * (i % per_byte))) & EscapeOf(packing);
      if (number == EscapeOf(packing)) {
        if (escape_count == escapes.size()) return false;
        number += escapes[escape_count++];
      }
    }
    numbers[i] = static_cast<U>(has_signs ? (number >> 1) ^ (0u - (number & 1)) : number);
  }
  return escape_count == escapes.size();
}
template bool UnpackReference(const PackedStream<uint16_t>&, uint16_t*);
template bool UnpackReference(const PackedStream<uint32_t>&, uint32_t*);

}  // namespace lf
