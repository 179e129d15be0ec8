// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/coefficient_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

namespace lf {
namespace {

constexpr std::array kKinds = {BandKind::kVertical, BandKind::kHorizontal, BandKind::kEven};

// The coefficients of one component of a packet: bands of equal sizes, one after the other, and
// their parents.
struct Component {
  int width = 0, height = 0;
  size_t band_count = 0;
  std::vector<int32_t> values, parents;

  size_t count() const { return static_cast<size_t>(width) * height; }
  int parent_width() const { return (width + 1) / 2; }
  int parent_height() const { return (height + 1) / 2; }

  // Returns the bands, whose values and parents are elsewhere.
  template <class T>
  std::vector<CoefficientBand<T>> Bands(T* of_bands,
                                        const std::remove_const_t<T>* of_parents) const {
    std::vector<CoefficientBand<T>> bands;
    for (size_t i = 0; i < band_count; ++i) {
      const size_t parent = i * parent_width() * parent_height();
      bands.push_back({of_bands + i * count(), width, height, kKinds[i], of_parents + parent,
                       parent_width(), parent_height()});
    }
    return bands;
  }
};

// Returns coefficients that are larger in some places than in others, as those of pictures are.
//   scale  mean magnitude
Component Drawn(std::mt19937& random, int width, int height, size_t band_count, double scale,
                int32_t most) {
  Component component{width, height, band_count, {}, {}};
  const auto draw = [&](int x, int y) {
    const double here = scale * std::exp(2 * std::sin(x / 17.0) * std::cos(y / 9.0));
    std::exponential_distribution<double> size(1 / here);
    const auto magnitude = static_cast<int32_t>(std::min<double>(size(random), most));
    return random() % 2 == 0 ? magnitude : -magnitude;
  };
  for (size_t i = 0; i < band_count; ++i)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) component.values.push_back(draw(x, y));
  component.parents.resize(band_count * component.parent_width() * component.parent_height());
  for (int32_t& value : component.parents) value = draw(0, 0);
  return component;
}

std::string Encoded(const std::vector<Component>& components, Rounding rounding) {
  PacketWriter writer(StripCount(components.front().width), rounding);
  for (const Component& component : components)
    writer.Append(component.Bands(component.values.data(), component.parents.data()));
  return writer.Packet();
}

// Decodes a packet of components that are as large as the given ones. Returns false if it is
// damaged.
template <class T>
bool Decode(Transform transform, std::string_view packet, const std::vector<Component>& like,
            Rounding rounding, std::vector<std::vector<T>>* values) {
  PacketReader reader;
  values->clear();
  if (!reader.Begin(transform, packet, static_cast<int>(like.size()),
                    StripCount(like.front().width), rounding))
    return false;
  for (const Component& component : like) {
    std::vector<T>& out = values->emplace_back(component.values.size() + kSlack);
    const std::vector<T> parents(component.parents.begin(), component.parents.end());
    if (!reader.Take<T>(component.Bands(out.data(), parents.data()))) return false;
    out.resize(component.values.size());
  }
  return reader.IsAtEnd();
}

template <class T>
void ExpectBack(const std::vector<Component>& components, Rounding rounding) {
  const std::string packet = Encoded(components, rounding);
  for (const Transform transform : {Transform::kReference, Transform::kSimd}) {
    std::vector<std::vector<T>> back;
    ASSERT_TRUE(Decode(transform, packet, components, rounding, &back));
    for (size_t c = 0; c < components.size(); ++c)
      for (size_t i = 0; i < back[c].size(); ++i)
        ASSERT_EQ(back[c][i], components[c].values[i]) << c << " " << i;
  }
}

TEST(CoefficientCoder, EveryPacketComesBack) {
  std::mt19937 random(1);
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1},
                                                                      {15, 3},
                                                                      {16, 7},
                                                                      {31, 2},
                                                                      {63, 9},
                                                                      {64, 5},
                                                                      {65, 4},
                                                                      {127, 6},
                                                                      {480, 8},
                                                                      {513, 3}})
    for (const double scale : {0.01, 0.1, 0.5, 2.0, 9.0, 40.0, 300.0})
      for (const Rounding rounding : {Rounding::kNearest, Rounding::kDeadZone})
        ExpectBack<int16_t>({Drawn(random, width, height, 3, scale, 32000),
                             Drawn(random, width, height, 3, scale / 3, 32000)},
                            rounding);
  for (const double scale : {0.3, 1000.0, 70000.0, 1e6})
    ExpectBack<int32_t>({Drawn(random, 130, 20, 1, scale, 1 << 24)}, Rounding::kNearest);
}

TEST(CoefficientCoder, TheLargestAndTheSmallestComeBack) {
  std::mt19937 random(2);
  for (const int width : {9, 40, 200}) {
    Component component = Drawn(random, width, 6, 3, 1, 100);
    component.values[3] = INT16_MAX;
    component.values[width * 4] = INT16_MIN;
    ExpectBack<int16_t>({component}, Rounding::kDeadZone);
    component.values[5] = INT32_MAX;
    component.values[width * 4 + 1] = INT32_MIN;
    ExpectBack<int32_t>({component}, Rounding::kNearest);
  }
}

TEST(CoefficientCoder, ZerosCostAByteForEachComponent) {
  std::mt19937 random(3);
  std::vector<Component> components;
  for (int i = 0; i < 3; ++i) components.push_back(Drawn(random, 100, 50, 3, 1, 0));
  EXPECT_EQ(Encoded(components, Rounding::kDeadZone), std::string(3, '\0'));
  ExpectBack<int16_t>(components, Rounding::kDeadZone);
}

// Neighbours predict the scale of a coefficient: bands that are busy in some places need clearly
// fewer bytes than the entropy of their coefficients without neighbours.
TEST(CoefficientCoder, NeighboursSaveBytes) {
  std::mt19937 random(4);
  const Component component = Drawn(random, 512, 512, 1, 1, 1000);
  std::vector<double> counts(2001);
  for (size_t i = 0; i < 512 * 512; ++i) ++counts[component.values[i] + 1000];
  double bits = 0;
  for (const double count : counts)
    if (count > 0) bits -= count * std::log2(count / (512 * 512));
  const auto bytes = static_cast<double>(Encoded({component}, Rounding::kDeadZone).size());
  EXPECT_LT(bytes, 0.93 * bits / 8);
}

// A packet that is cut off, or one of whose bytes has changed, gives an error or other
// coefficients, and both implementations agree.
TEST(CoefficientCoder, DamageNeverDoesHarm) {
  std::mt19937 random(5);
  for (const double scale : {0.2, 5.0, 3000.0}) {
    const std::vector<Component> components = {Drawn(random, 70, 5, 3, scale, 30000)};
    const std::string packet = Encoded(components, Rounding::kNearest);
    const auto both = [&](std::string_view bytes) {
      std::vector<std::vector<int16_t>> fast, slow;
      const bool by_simd = Decode(Transform::kSimd, bytes, components, Rounding::kNearest, &fast);
      const bool by_reference =
          Decode(Transform::kReference, bytes, components, Rounding::kNearest, &slow);
      EXPECT_EQ(by_simd, by_reference);
      EXPECT_TRUE(!by_simd || !by_reference || fast == slow);
      return by_simd;
    };
    EXPECT_TRUE(both(packet));
    for (size_t size = 0; size < packet.size(); ++size)
      EXPECT_FALSE(both(std::string_view(packet).substr(0, size))) << size;
    EXPECT_FALSE(both(packet + '\0'));
    size_t told = 0;
    for (size_t i = 0; i < packet.size(); ++i) {
      std::string damaged = packet;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << random() % 8));
      told += both(damaged) ? 0 : 1;
    }
    // Only plain bits can change without notice, of which small coefficients have few.
    EXPECT_GT(static_cast<double>(told),
              scale < 1 ? 0.9 * static_cast<double>(packet.size()) : 0.0);
  }
}

TEST(CoefficientScales, EverySlotBelongsToASymbol) {
  for (const Rounding rounding : {Rounding::kNearest, Rounding::kDeadZone})
    for (int i = 0; i < kTables; ++i) {
      const ScaleTable& table = TablesFor(rounding).tables[i];
      int slots = table.count[0];
      for (int m = 1; m <= table.most; ++m) {
        EXPECT_GE(table.count[m], 1);
        EXPECT_TRUE(m == 1 || m == table.most || table.count[m] <= table.count[m - 1]);
        slots += 2 * table.count[m];
      }
      EXPECT_EQ(slots, kSlots);
      for (uint32_t number = 0; number < kSlots; ++number) {
        const uint32_t slot = table.slots[number];
        EXPECT_LT(PlaceOf(slot), CountOf(slot));
        EXPECT_EQ(table.slots[number - PlaceOf(slot)], slot - (PlaceOf(slot) << 12));
        EXPECT_EQ(IsEscape(slot), std::abs(SymbolOf(slot)) == table.most);
      }
    }
}

// Stores on all machines depend on these tables: they must never change.
TEST(CoefficientScales, TheTablesAreThoseOfTheFormat) {
  const auto sum = [](Rounding rounding) {
    uint64_t hash = 0;
    for (const ScaleTable& table : TablesFor(rounding).tables)
      for (const uint16_t count : table.count) hash = hash * 1099511628211ULL + count;
    return hash;
  };
  EXPECT_EQ(sum(Rounding::kNearest), 4197137049101917227U);
  EXPECT_EQ(sum(Rounding::kDeadZone), 1397721044835633529U);
}

}  // namespace
}  // namespace lf
