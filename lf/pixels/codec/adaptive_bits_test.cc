// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/adaptive_bits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace lf {
namespace {

TEST(AdaptiveBits, AreReadAsTheyWereWritten) {
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) {
    const size_t count = random() % 400;
    const unsigned share = random() % 3 == 0 ? random() % 2 * 1000 : random() % 1000;
    std::vector<bool> bits(count);
    std::vector<size_t> contexts(count);
    for (size_t k = 0; k < count; ++k) {
      bits[k] = random() % 1000 < share;
      contexts[k] = random() % 3;
    }
    std::array<BitContext, 3> of_writer, of_reader;
    BitWriter writer;
    for (size_t k = 0; k < count; ++k) writer.Put(bits[k], &of_writer[contexts[k]]);
    const std::string bytes = std::move(writer).Finished();
    BitReader reader(bytes);
    for (size_t k = 0; k < count; ++k) ASSERT_EQ(reader.Take(&of_reader[contexts[k]]), bits[k]);
    ASSERT_TRUE(reader.IsAtEnd());
    ASSERT_FALSE(BitReader(bytes + "x").IsAtEnd());
  }
}

TEST(AdaptiveBits, TakeAboutAsManyBytesAsTheirEntropy) {
  std::mt19937 random(2);
  BitContext context;
  BitWriter writer;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) writer.Put(random() % 100 < 10, &context);
  const double entropy = -(0.1 * std::log2(0.1) + 0.9 * std::log2(0.9)) * kCount / 8;
  const std::string bytes = std::move(writer).Finished();
  EXPECT_LT(static_cast<double>(bytes.size()), 1.06 * entropy);
}

TEST(AdaptiveBits, NumbersAreReadAsTheyWereWritten) {
  std::mt19937 random(3);
  NumberContexts<5> of_writer, of_reader;
  BitWriter writer;
  std::vector<uint32_t> numbers(1000);
  for (uint32_t& number : numbers) {
    number = random() % 4 == 0 ? random() % 32 : random() % 3;
    of_writer.Put(number, &writer);
  }
  const std::string bytes = std::move(writer).Finished();
  BitReader reader(bytes);
  for (const uint32_t number : numbers) ASSERT_EQ(of_reader.Take(&reader), number);
}

}  // namespace
}  // namespace lf
