// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/packing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace lf {
namespace {

// Returns values with a two-sided exponential distribution, as real coefficients have.
std::vector<int32_t> Coefficients(std::mt19937& random, size_t count, double scale, int32_t most) {
  std::exponential_distribution<double> size(1 / scale);
  std::vector<int32_t> values(count);
  for (int32_t& value : values) {
    const auto magnitude = static_cast<int32_t>(std::min<double>(size(random), most));
    value = random() % 2 == 0 ? magnitude : -magnitude;
  }
  return values;
}

template <class T>
void ExpectBack(const std::vector<int32_t>& values, std::set<int>* packings) {
  std::string code;
  AppendCoefficients<T>(values, &code);
  if (!values.empty()) packings->insert(code.front());
  code += "next";
  for (const Transform transform : {Transform::kReference, Transform::kSimd}) {
    std::string_view rest = code;
    std::vector<T> back(values.size() + kSlack);
    ASSERT_TRUE(TakeCoefficients(transform, &rest, values.size(), back.data()));
    EXPECT_EQ(rest, "next");
    for (size_t i = 0; i < values.size(); ++i) ASSERT_EQ(back[i], values[i]) << i;
  }
}

TEST(Packing, EveryStreamComesBack) {
  std::mt19937 random(1);
  std::set<int> packings;
  for (const size_t count : {0, 1, 3, 4, 5, 63, 64, 65, 1000, 4099, 30000})
    for (const double scale : {0.01, 0.1, 0.4, 1.0, 3.0, 20.0, 80.0, 500.0, 9000.0})
      ExpectBack<int16_t>(Coefficients(random, count, scale, 32000), &packings);
  for (const size_t count : {1, 77, 5000})
    for (const double scale : {0.1, 5.0, 300.0, 30000.0, 3e6, 2e8})
      ExpectBack<int32_t>(Coefficients(random, count, scale, 2'000'000'000), &packings);
  EXPECT_EQ(packings, (std::set<int>{0, 1, 2, 4, 18, 19, 20}));
}

TEST(Packing, TheLargestAndTheSmallestComeBack) {
  std::set<int> packings;
  ExpectBack<int16_t>({0, INT16_MAX, INT16_MIN, -1, 1}, &packings);
  ExpectBack<int32_t>({0, INT32_MAX, INT32_MIN, -1, 1}, &packings);
  std::vector<int32_t> sparse(20000, 0);
  sparse[12345] = INT32_MIN;
  ExpectBack<int32_t>(sparse, &packings);
}

// A single large number must be restored, even if the sample that chooses the packing does not
// contain it.
TEST(Packing, RareEscapesAreNotForgotten) {
  std::mt19937 random(2);
  std::set<int> packings;
  for (int i = 0; i < 50; ++i) {
    std::vector<int32_t> values = Coefficients(random, 100000, 0.3, 3);
    values[random() % values.size()] = static_cast<int32_t>(random() % 30000);
    ExpectBack<int16_t>(values, &packings);
  }
}

TEST(Packing, DamageIsTold) {
  std::mt19937 random(3);
  const std::vector<int32_t> values = Coefficients(random, 5000, 3, 30000);
  std::string code;
  AppendCoefficients<int16_t>(values, &code);
  std::vector<int16_t> back(6000 + kSlack);
  const auto is_whole = [&](std::string_view bytes, size_t count) {
    return TakeCoefficients(Transform::kSimd, &bytes, count, back.data());
  };
  EXPECT_TRUE(is_whole(code, 5000));
  EXPECT_FALSE(is_whole(code, 5100));
  EXPECT_FALSE(is_whole(code.substr(0, code.size() - 1), 5000));
  EXPECT_FALSE(is_whole("", 1));
  code[0] = 3;
  EXPECT_FALSE(is_whole(code, 5000));
  code[0] = static_cast<char>(Packing::kPlanes4);  // not allowed for numbers of two bytes
  EXPECT_FALSE(is_whole(code, 5000));
}

}  // namespace
}  // namespace lf
