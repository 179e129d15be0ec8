// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/reference_groups.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "lf/core/random.h"

namespace lf {
namespace {

using Cameras = std::vector<CameraToGroup>;

// Returns a random number from -1 to 1.
double Random(uint64_t stream, uint64_t index) { return 2 * RandomUnit(7, stream, index) - 1; }
Vec3 RandomVector(uint64_t stream, uint64_t index) {
  return {Random(stream, 3 * index), Random(stream, 3 * index + 1), Random(stream, 3 * index + 2)};
}

Cameras GridOfCameras(int columns, int rows) {
  Cameras cameras;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) cameras.push_back({Vec3(0.1 * x, 0.1 * y, 0), Vec3::UnitZ()});
  return cameras;
}

// Returns LF cameras spread over a part of a unit sphere, which look at its centre.
Cameras Dome(int count, double angle_rad) {
  Cameras cameras;
  for (int k = 0; k < count; ++k) {
    const double tilt = angle_rad * std::sqrt((k + 0.5) / count);
    const double turn = k * std::numbers::pi * (3 - std::sqrt(5));
    const Vec3 p(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
    cameras.push_back({p, -p});
  }
  return cameras;
}

Cameras Arc(int count, double angle_rad) {
  Cameras cameras;
  for (int k = 0; k < count; ++k) {
    const Vec3 p(std::sin(angle_rad * k / count), 0, std::cos(angle_rad * k / count));
    cameras.push_back({p, -p});
  }
  return cameras;
}

// Returns LF cameras in a box, whose directions differ by about `spread`, in radians.
Cameras HandHeld(uint32_t count, double spread) {
  Cameras cameras;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3 p = RandomVector(0, i);
    const Vec3 direction = (Vec3::UnitZ() + spread * RandomVector(1, i)).normalized();
    cameras.push_back({Vec3(p.x(), p.y(), 0.2 * p.z()), direction});
  }
  return cameras;
}

// Returns the cameras of a rig of six that look in all directions, at places along a line.
Cameras Rigs(int count) {
  Cameras cameras;
  for (int k = 0; k < count; ++k)
    for (int j = 0; j < 6; ++j) {
      const Vec3 direction(std::cos(j * std::numbers::pi / 3), std::sin(j * std::numbers::pi / 3),
                           0);
      cameras.push_back({Vec3(0.1 * k, 0, 0) + 0.02 * direction, direction});
    }
  return cameras;
}

std::map<std::string, Cameras> AllCaptures() {
  Cameras two_kinds = GridOfCameras(30, 20);
  for (size_t i = 0; i < two_kinds.size(); i += 3) two_kinds[i].kind = 7;
  Cameras far = GridOfCameras(10, 10);
  far.push_back({Vec3(1e7, 0, 0), Vec3::UnitZ()});
  Cameras together(100, {Vec3(1, 2, 3), Vec3::UnitX()});
  return {{"grid", GridOfCameras(37, 29)},
          {"line", GridOfCameras(100, 1)},
          {"dome", Dome(3000, std::numbers::pi / 2)},
          {"sphere", Dome(3000, std::numbers::pi)},
          {"sparse dome", Dome(50, std::numbers::pi / 2)},
          {"arc", Arc(500, std::numbers::pi / 2)},
          {"hand-held", HandHeld(2000, 0.05)},
          {"shaken", HandHeld(2000, 0.3)},
          {"rigs", Rigs(200)},
          {"two kinds", two_kinds},
          {"one far away", far},
          {"at one position", together},
          {"one", GridOfCameras(1, 1)},
          {"two", GridOfCameras(2, 1)}};
}

TEST(ReferenceGroups, EachCameraIsInOneGroupAfterItsReferences) {
  for (const auto& [name, cameras] : AllCaptures()) {
    const ReferenceGroups groups = GroupCameras(cameras);
    std::vector<int> times(cameras.size(), 0);
    for (size_t g = 0; g < groups.size(); ++g) {
      const auto members = groups.Group(g);
      ASSERT_GE(members.size(), 1U) << name;
      ASSERT_LE(members.size(), ReferenceGroups::kMost) << name;
      EXPECT_TRUE(members[0].References().empty()) << name;
      for (size_t rank = 0; rank < members.size(); ++rank) {
        ++times.at(members[rank].id.value);
        const auto references = members[rank].References();
        EXPECT_EQ(references.empty(), rank == 0) << name;
        EXPECT_EQ(std::set(references.begin(), references.end()).size(), references.size()) << name;
        for (const uint8_t reference : references) {
          EXPECT_LT(reference, rank) << name;
          EXPECT_LT(reference, AnchorCount(members.size())) << name;
        }
      }
    }
    EXPECT_EQ(times, std::vector<int>(cameras.size(), 1)) << name;
  }
  EXPECT_EQ(GroupCameras({}).size(), 0U);
}

TEST(ReferenceGroups, MembersLookInOneDirectionAndAreOfOneKind) {
  for (const auto& [name, cameras] : AllCaptures()) {
    const ReferenceGroups groups = GroupCameras(cameras);
    for (size_t g = 0; g < groups.size(); ++g)
      for (const GroupMember& a : groups.Group(g))
        for (const GroupMember& b : groups.Group(g)) {
          const CameraToGroup &one = cameras[a.id.value], &other = cameras[b.id.value];
          EXPECT_EQ(one.kind, other.kind) << name;
          ASSERT_GT(one.direction.dot(other.direction), std::cos(10 * std::numbers::pi / 180))
              << name;
        }
  }
}

TEST(ReferenceGroups, GroupsAreNotSmallWhereCamerasAreDense) {
  for (const std::string name : {"grid", "line", "two kinds", "rigs", "at one position"}) {
    const ReferenceGroups groups = GroupCameras(AllCaptures()[name]);
    for (size_t g = 0; g < groups.size(); ++g)
      EXPECT_GE(groups.Group(g).size(), ReferenceGroups::kLeast) << name;
    const double mean =
        static_cast<double>(groups.members.size()) / static_cast<double>(groups.size());
    EXPECT_GT(mean, 14) << name;
    EXPECT_LT(mean, 18) << name;
  }
  for (const auto& [cameras, least] :
       {std::pair(Dome(10000, std::numbers::pi / 2), 14.0), std::pair(HandHeld(2000, 0.05), 14.0),
        std::pair(HandHeld(2000, 0.3), 12.0)}) {
    const ReferenceGroups groups = GroupCameras(cameras);
    EXPECT_GT(static_cast<double>(cameras.size()) / static_cast<double>(groups.size()), least);
  }
}

// Whichever way a grid stands in the world, its groups are rectangles.
TEST(ReferenceGroups, GridsAreCutBetweenRowsAndColumns) {
  for (const double turn : {0.0, 0.2, 0.7, 1.5}) {
    const Mat3 rotation =
        (Eigen::AngleAxisd(turn, Vec3::UnitZ()) * Eigen::AngleAxisd(0.4 * turn, Vec3::UnitX()))
            .toRotationMatrix();
    constexpr int kColumns = 33, kRows = 28;
    Cameras cameras = GridOfCameras(kColumns, kRows);
    for (CameraToGroup& camera : cameras) {
      camera.position = rotation * camera.position + Vec3(5, -3, 2);
      camera.direction = rotation * camera.direction;
    }
    const ReferenceGroups groups = GroupCameras(cameras);
    for (size_t g = 0; g < groups.size(); ++g) {
      std::set<uint32_t> columns, rows;
      for (const GroupMember& member : groups.Group(g)) {
        columns.insert(member.id.value % kColumns);
        rows.insert(member.id.value / kColumns);
      }
      EXPECT_EQ(columns.size() * rows.size(), groups.Group(g).size()) << turn;
      EXPECT_EQ(*columns.rbegin() - *columns.begin() + 1, columns.size()) << turn;
      EXPECT_EQ(*rows.rbegin() - *rows.begin() + 1, rows.size()) << turn;
    }
  }
}

TEST(ReferenceGroups, TheOrderOfTheCamerasDoesNotMatter) {
  for (const auto& [name, cameras] : AllCaptures()) {
    if (name == "at one position") continue;
    std::vector<uint32_t> ids(cameras.size());
    for (uint32_t i = 0; i < ids.size(); ++i) ids[i] = i;
    std::sort(ids.begin(), ids.end(),
              [](uint32_t a, uint32_t b) { return RandomBits(3, 0, a) < RandomBits(3, 0, b); });
    Cameras shuffled;
    for (const uint32_t id : ids) shuffled.push_back(cameras[id]);
    const ReferenceGroups groups = GroupCameras(cameras), again = GroupCameras(shuffled);
    EXPECT_EQ(groups.begins, again.begins) << name;
    for (size_t i = 0; i < cameras.size(); ++i) {
      EXPECT_EQ(groups.members[i].id.value, ids[again.members[i].id.value]) << name;
      EXPECT_EQ(groups.members[i].references, again.members[i].references) << name;
      EXPECT_EQ(groups.members[i].reference_count, again.members[i].reference_count) << name;
    }
  }
}

TEST(ReferenceGroups, ReferencesAreTheNearestOnEachSide) {
  // On a line, each image is predicted from the nearest anchors before it on both sides.
  const ReferenceGroups line = GroupCameras(GridOfCameras(16, 1));
  ASSERT_EQ(line.size(), 1U);
  const auto members = line.Group(0);
  for (size_t rank = 1; rank < members.size(); ++rank) {
    const auto at = static_cast<int>(members[rank].id.value);
    std::map<bool, int> nearest;  // by side
    for (size_t before = 0; before < std::min(rank, AnchorCount(16)); ++before) {
      const int offset = static_cast<int>(members[before].id.value) - at;
      int& best = nearest.try_emplace(offset > 0, offset).first->second;
      if (std::abs(offset) < std::abs(best)) best = offset;
    }
    std::set<int> expected, found;
    int least = 100;
    for (const auto& [side, offset] : nearest) least = std::min(least, std::abs(offset));
    for (const auto& [side, offset] : nearest)
      if (std::abs(offset) <= 3 * least) expected.insert(offset);
    for (const uint8_t reference : members[rank].References())
      found.insert(static_cast<int>(members[reference].id.value) - at);
    EXPECT_EQ(found, expected) << at;
  }
  // The last images of a grid have two or three references, one or two pitches away.
  const ReferenceGroups grid = GroupCameras(GridOfCameras(4, 4));
  ASSERT_EQ(grid.size(), 1U);
  EXPECT_EQ(grid.members[0].id.value % 4 % 3, 1U);  // the key image is not at the border
  EXPECT_EQ(grid.members[0].id.value / 4 % 3, 1U);
  for (size_t rank = 10; rank < 16; ++rank) {
    const GroupMember& member = grid.members[rank];
    EXPECT_GE(member.reference_count, 2);
    for (const uint8_t reference : member.References()) {
      const int a = static_cast<int>(member.id.value);
      const int b = static_cast<int>(grid.members[reference].id.value);
      EXPECT_LE(std::abs(a % 4 - b % 4) + std::abs(a / 4 - b / 4), 3);
    }
  }
}

TEST(ReferenceGroups, CamerasThatLookElsewhereDoNotDivideTheOthers) {
  Cameras cameras = GridOfCameras(16, 16);
  for (const size_t i : {5, 77, 130}) cameras[i].direction = Vec3::UnitX();
  const ReferenceGroups groups = GroupCameras(cameras);
  size_t of_others = 0;
  for (size_t g = 0; g < groups.size(); ++g) {
    const auto members = groups.Group(g);
    if (cameras[members[0].id.value].direction == Vec3::UnitX()) continue;
    ++of_others;
    std::set<uint32_t> columns, rows;
    for (const GroupMember& member : members) {
      columns.insert(member.id.value % 16);
      rows.insert(member.id.value / 16);
    }
    EXPECT_LE(*columns.rbegin() - *columns.begin(), 6U);
    EXPECT_LE(*rows.rbegin() - *rows.begin(), 6U);
  }
  EXPECT_LE(of_others, 17U);
  EXPECT_LE(groups.size(), of_others + 3);
}

TEST(ReferenceGroups, NumbersThatAreNotFiniteAreNoErrors) {
  Cameras cameras = GridOfCameras(9, 9);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  cameras[4].position.x() = std::numeric_limits<double>::quiet_NaN();
  cameras[30].position.y() = kInfinity;
  cameras[50].direction = Vec3(0, -kInfinity, 0);
  cameras[60].direction = 1e300 * Vec3::UnitZ();
  cameras[61].position = Vec3(1e308, 1e308, -1e308);
  const ReferenceGroups groups = GroupCameras(cameras);
  std::set<uint32_t> ids;
  for (const GroupMember& member : groups.members) ids.insert(member.id.value);
  EXPECT_EQ(ids.size(), cameras.size());
}

// Returns, for each LF camera, the members of its group that must be decoded to see its image: bit
// r is the member of rank r.
std::vector<std::pair<size_t, uint32_t>> Needed(const ReferenceGroups& groups) {
  std::vector<std::pair<size_t, uint32_t>> needed(groups.members.size());
  for (size_t g = 0; g < groups.size(); ++g) {
    const auto members = groups.Group(g);
    for (size_t rank = 0; rank < members.size(); ++rank) {
      uint32_t all = 1U << rank;
      for (const uint8_t reference : members[rank].References())
        all |= needed[members[reference].id.value].second;
      needed[members[rank].id.value] = {g, all};
    }
  }
  return needed;
}

// Returns the number of images that must be decoded to see a window of LF cameras, divided by their
// number: the mean over windows in a grid.
double DecodingsPerImage(int columns, int rows, int window) {
  const auto needed = Needed(GroupCameras(GridOfCameras(columns, rows)));
  double sum = 0, count = 0;
  for (int top = 0; top + window <= rows; ++top)
    for (int left = 0; left + window <= columns; ++left) {
      std::map<size_t, uint32_t> together;
      for (int y = top; y < top + window; ++y)
        for (int x = left; x < left + window; ++x) {
          const auto& [group, members] = needed[static_cast<size_t>(y * columns + x)];
          together[group] |= members;
        }
      for (const auto& [group, members] : together) sum += std::popcount(members);
      count += window * window;
    }
  return sum / count;
}

TEST(ReferenceGroups, FewImagesMustBeDecodedToSeeSome) {
  for (const auto& [columns, rows] : {std::pair(32, 32), std::pair(37, 29), std::pair(27, 27)}) {
    EXPECT_LT(DecodingsPerImage(columns, rows, 1), 5) << columns;
    EXPECT_LT(DecodingsPerImage(columns, rows, 9), 1.3) << columns;
  }
}

TEST(ReferenceGroups, AMillionCamerasAreGrouped) {
  const Cameras cameras = GridOfCameras(1000, 1000);
  const auto begin = std::chrono::steady_clock::now();
  const ReferenceGroups groups = GroupCameras(cameras);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  RecordProperty("milliseconds", static_cast<int>(1000 * seconds));
  EXPECT_EQ(groups.members.size(), cameras.size());
  EXPECT_GT(groups.size(), cameras.size() / 18);
  EXPECT_LT(groups.size(), cameras.size() / 14);
}

TEST(ExposureNumbers, TellBracketsApartAndNotSlightlyDifferentGains) {
  EXPECT_TRUE(ExposureNumbers({}).empty());
  const std::vector<double> brackets = {1, 0.25, 4, 1.05, 0.26, 3.9};
  EXPECT_EQ(ExposureNumbers(brackets), (std::vector<uint32_t>{1, 0, 2, 1, 0, 2}));
  // Gains that pass slowly from one to another are of one kind.
  std::vector<double> slow;
  for (int i = 0; i < 100; ++i) slow.push_back(std::exp2(0.04 * i));
  EXPECT_EQ(ExposureNumbers(slow), std::vector<uint32_t>(100, 0));
}

}  // namespace
}  // namespace lf
