// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/reference_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "lf/selection/capture_surface.h"
#include "lf/selection/principal_axes.h"

namespace lf {
namespace {

constexpr size_t kUsual = 16;      // size of a group that cuts aim at
constexpr double kUnit = 1 << 28;  // the longest extent of positions, and a direction's length
constexpr int64_t kFarthestSquare = 10;  // times that of the distance of the nearest reference
constexpr double kMostAngle = 0.0303844939755838;  // 2 - 2 cos(10 degrees): square of a chord

using Place = std::array<int32_t, 3>;

int64_t SquareOf(int64_t x) { return x * x; }
int64_t SquareBetween(const Place& a, const Place& b) {
  int64_t sum = 0;
  for (size_t k = 0; k < 3; ++k) sum += SquareOf(int64_t{a[k]} - b[k]);
  return sum;
}

int32_t Rounded(double x) {
  return std::isfinite(x) ? static_cast<int32_t>(std::floor(x + 0.5)) : 0;
}

Vec3 Finite(const Vec3& v) {
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0; };
  return {finite(v.x()), finite(v.y()), finite(v.z())};
}

// An LF camera along axes of its kind. Integers make all decisions exact.
struct Item {
  Place at;       // position
  Place towards;  // direction
  uint32_t rank;  // in an order that depends on positions and directions, and then on the id
};

// Least and most of places along each axis.
struct Extents {
  Place least, most;
  explicit Extents(const Place& first) : least(first), most(first) {}
  void Add(const Place& place) {
    for (size_t k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], place[k]);
      most[k] = std::max(most[k], place[k]);
    }
  }
  int64_t Along(size_t axis) const { return int64_t{most[axis]} - least[axis]; }
  // Returns the axes, that of the longest extent first.
  std::array<size_t, 3> Axes() const {
    std::array<size_t, 3> axes = {0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(),
                     [this](size_t a, size_t b) { return Along(a) > Along(b); });
    return axes;
  }
};

// Orders the members of one group and finds their references.
class GroupOrder {
 public:
  // Appends the items to members; `ids` are the ids of ranks.
  void Append(std::span<const Item> items, std::span<const uint32_t> ids,
              std::vector<GroupMember>* members) {
    SeePlane(items);
    order_.clear();
    order_.push_back(Middle(items));
    std::vector<int64_t>& apart = apart_;  // square of the distance from the nearest in order_
    apart.assign(items.size(), INT64_MAX);
    members->push_back({LfImageId{ids[items[order_[0]].rank]}, 0, {}});
    while (order_.size() < items.size()) {
      for (size_t i = 0; i < items.size(); ++i)
        apart[i] = std::min(apart[i], SquareBetween(items[i].at, items[order_.back()].at));
      apart[order_.back()] = -1;
      const auto next =
          static_cast<size_t>(std::max_element(apart.begin(), apart.end()) - apart.begin());
      members->push_back(WithReferences(items, next, ids));
      order_.push_back(next);
    }
  }

 private:
  // Sets right_ and up_ to axes of the plane of least variance: along the axes of places if the
  // plane is, and along the line if the items are nearly on one.
  void SeePlane(std::span<const Item> items) {
    constexpr double kLine = 0.01;  // ratio of variances
    points_.clear();
    for (const Item& item : items)
      points_.push_back({static_cast<double>(item.at[0]), static_cast<double>(item.at[1]),
                         static_cast<double>(item.at[2])});
    const Vec3 mean = MeanOf(points_);
    for (Vec3& p : points_) p = {p.x() - mean.x(), p.y() - mean.y(), p.z() - mean.z()};
    const PrincipalAxes principal = AxesOf(points_);
    Vec3 normal = principal.axes[2];
    int least = 0, most = 0;  // axes along which the normal is shortest and longest
    for (int k = 1; k < 3; ++k) {
      if (std::abs(normal[k]) < std::abs(normal[least]) - 1e-3) least = k;
      if (std::abs(normal[k]) > std::abs(normal[most])) most = k;
    }
    if (normal[most] < 0) normal = {-normal.x(), -normal.y(), -normal.z()};
    if (!(principal.variances[1] > kLine * principal.variances[0])) {
      right_ = principal.axes[0];
    } else {
      Vec3 axis = Vec3::Zero();
      axis[least] = 1;
      const double along = normal[least];
      right_ = Unit({axis.x() - along * normal.x(), axis.y() - along * normal.y(),
                     axis.z() - along * normal.z()});
    }
    up_ = Cross(normal, right_);
  }

  // Returns the item with the least sum of squared distances from all.
  static size_t Middle(std::span<const Item> items) {
    size_t best = 0;
    uint64_t least = UINT64_MAX;
    for (size_t i = 0; i < items.size(); ++i) {
      uint64_t sum = 0;
      for (const Item& other : items)
        sum += static_cast<uint64_t>(SquareBetween(items[i].at, other.at));
      if (sum < least) {
        least = sum;
        best = i;
      }
    }
    return best;
  }

  // Returns the direction from one place to another: 0 right, 1 up, 2 left, 3 down. A place in a
  // diagonal belongs to the direction that comes next anticlockwise.
  size_t DirectionTo(const Place& from, const Place& to) const {
    constexpr double kTurn = 1e-3;  // keeps diagonals away from the limits of directions
    const Vec3 d = {static_cast<double>(to[0] - from[0]), static_cast<double>(to[1] - from[1]),
                    static_cast<double>(to[2] - from[2])};
    const double right = Dot(d, right_), up = Dot(d, up_);
    const double x = right - kTurn * up, y = up + kTurn * right;
    if (std::abs(x) >= std::abs(y)) return x >= 0 ? 0 : 2;
    return y >= 0 ? 1 : 3;
  }

  GroupMember WithReferences(std::span<const Item> items, size_t item,
                             std::span<const uint32_t> ids) const {
    struct Reference {
      int64_t square = INT64_MAX;
      uint8_t rank = 0;
    };
    std::array<Reference, 4> nearest;  // by direction
    const Place& at = items[item].at;
    const size_t anchors = std::min(order_.size(), AnchorCount(items.size()));
    for (size_t rank = 0; rank < anchors; ++rank) {
      const Place& other = items[order_[rank]].at;
      const int64_t square = SquareBetween(at, other);
      Reference& best = nearest[DirectionTo(at, other)];
      if (square < best.square) best = {square, static_cast<uint8_t>(rank)};
    }
    std::sort(nearest.begin(), nearest.end(), [](const Reference& a, const Reference& b) {
      return std::tuple(a.square, a.rank) < std::tuple(b.square, b.rank);
    });
    GroupMember member{LfImageId{ids[items[item].rank]}, 0, {}};
    for (const Reference& reference : nearest)
      if (member.reference_count < GroupMember::kMostReferences &&
          reference.square <= kFarthestSquare * nearest[0].square)
        member.references[member.reference_count++] = reference.rank;
    return member;
  }

  std::vector<Vec3> points_;
  std::vector<size_t> order_;  // [rank] index of an item
  std::vector<int64_t> apart_;
  Vec3 right_ = Vec3::UnitX(), up_ = Vec3::UnitY();
};

// Cuts the LF cameras of one kind into groups.
class Grouping {
 public:
  Grouping(std::vector<Item> items, std::span<const uint32_t> ids, ReferenceGroups* groups)
      : items_(std::move(items)), ids_(ids), groups_(groups) {}

  void Divide() { Divide(0, items_.size()); }

 private:
  void Divide(size_t begin, size_t end) {
    const size_t count = CutOf(begin, end);
    if (count == 0) return Append(begin, end);
    Divide(begin, begin + count);
    Divide(begin + count, end);
  }

  // Reorders the items such that those before the cut come first, and returns their number; 0: they
  // are one group.
  size_t CutOf(size_t begin, size_t end) {
    Extents places(items_[begin].at), directions(items_[begin].towards);
    for (size_t i = begin; i < end; ++i) {
      places.Add(items_[i].at);
      directions.Add(items_[i].towards);
    }
    int64_t square = 0;
    for (size_t k = 0; k < 3; ++k) square += SquareOf(directions.Along(k));
    if (static_cast<double>(square) >= kMostAngle * kUnit * kUnit)
      return CutDirections(begin, end, directions);
    const size_t count = end - begin;
    if (count <= ReferenceGroups::kMost) return 0;
    const size_t groups = (count + kUsual / 2) / kUsual;
    const size_t middle = count * (groups / 2) / groups;
    for (const size_t axis : places.Axes())
      if (const size_t cut = CutPlaces(begin, end, middle, axis); cut > 0) return cut;
    // Most items are at one position.
    std::nth_element(At(begin), At(begin + middle), At(end),
                     [](const Item& a, const Item& b) { return a.rank < b.rank; });
    return middle;
  }

  // Cuts in the widest gap of the middle third of the extent of directions, not of their number,
  // so that few LF cameras that look elsewhere do not divide the others.
  size_t CutDirections(size_t begin, size_t end, const Extents& directions) {
    const size_t axis = directions.Axes()[0];
    const int64_t third = directions.Along(axis) / 3;
    const auto value = [axis](const Item& item) { return int64_t{item.towards[axis]}; };
    const int64_t low = directions.least[axis] + third, high = directions.most[axis] - third;
    const auto middle =
        std::partition(At(begin), At(end), [&](const Item& item) { return value(item) <= low; });
    const auto behind =
        std::partition(middle, At(end), [&](const Item& item) { return value(item) < high; });
    const auto less = [&](const Item& a, const Item& b) {
      return std::tuple(value(a), a.rank) < std::tuple(value(b), b.rank);
    };
    std::sort(middle, behind, less);
    // The gaps of the middle third include those to its neighbours on both sides.
    std::iter_swap(middle - 1, std::max_element(At(begin), middle, less));
    std::iter_swap(behind, std::min_element(behind, At(end), less));
    const int64_t twice_middle = int64_t{directions.least[axis]} + directions.most[axis];
    const auto first = static_cast<size_t>(middle - At(0));
    const auto last = static_cast<size_t>(behind - At(0));
    const size_t cut = BestGap(first, last, value, [&](size_t i) {
      return std::abs(value(items_[i]) + value(items_[i - 1]) - twice_middle);
    });
    return cut - begin;
  }

  // Cuts positions in a wide gap near the item `middle`. Both parts have at least kLeast items. 0:
  // there is no gap.
  size_t CutPlaces(size_t begin, size_t end, size_t middle, size_t axis) {
    const size_t count = end - begin, slack = count / 6;
    const size_t first = begin + std::max(ReferenceGroups::kLeast, middle - slack);
    const size_t last = begin + std::min(count - ReferenceGroups::kLeast, middle + slack);
    const auto value = [axis](const Item& item) { return int64_t{item.at[axis]}; };
    const auto less = [&](const Item& a, const Item& b) {
      return std::tuple(value(a), a.rank) < std::tuple(value(b), b.rank);
    };
    std::nth_element(At(begin), At(first - 1), At(end), less);
    std::nth_element(At(first), At(last), At(end), less);
    std::sort(At(first - 1), At(last + 1), less);
    const size_t cut = BestGap(first, last, value, [&](size_t i) {
      return std::abs(static_cast<int64_t>(i) - static_cast<int64_t>(begin + middle));
    });
    return value(items_[cut]) == value(items_[cut - 1]) ? 0 : cut - begin;
  }

  // Returns the index i from first to last of the gap between the items i - 1 and i that is at
  // least half as wide as the widest, and of those the nearest to the middle.
  template <class Value, class FromMiddle>
  size_t BestGap(size_t first, size_t last, const Value& value, const FromMiddle& from_middle) {
    const auto gap = [&](size_t i) { return value(items_[i]) - value(items_[i - 1]); };
    int64_t widest = 0;
    for (size_t i = first; i <= last; ++i) widest = std::max(widest, gap(i));
    size_t best = last + 1;
    for (size_t i = first; i <= last; ++i)
      if (2 * gap(i) >= widest && (best > last || from_middle(i) < from_middle(best))) best = i;
    return best;
  }

  void Append(size_t begin, size_t end) {
    std::sort(At(begin), At(end), [](const Item& a, const Item& b) { return a.rank < b.rank; });
    order_.Append(std::span(items_).subspan(begin, end - begin), ids_, &groups_->members);
    groups_->begins.push_back(groups_->members.size());
  }

  std::vector<Item>::iterator At(size_t i) { return items_.begin() + static_cast<ptrdiff_t>(i); }

  std::vector<Item> items_;
  std::span<const uint32_t> ids_;  // [rank]
  ReferenceGroups* groups_;
  GroupOrder order_;
};

// Returns the LF cameras `ids`, which are of one kind.
std::vector<Item> ItemsOf(std::span<const CameraToGroup> cameras, std::span<const uint32_t> ids) {
  std::vector<Vec3> positions;
  positions.reserve(ids.size());
  for (const uint32_t id : ids) positions.push_back(Finite(cameras[id].position));
  const PlaneAxes axes = PlaneAxesOf(positions);
  const auto along = [&](const Vec3& v) {
    return Vec3(Dot(v, axes.x), Dot(v, axes.y), Dot(v, axes.z));
  };
  const Vec3 mean = MeanOf(positions);
  double most = 0;
  for (Vec3& p : positions) {
    p = along({p.x() - mean.x(), p.y() - mean.y(), p.z() - mean.z()});
    for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(p[k]));
  }
  const double scale = most > 0 && std::isfinite(most) ? kUnit / 2 / most : 0;
  std::vector<Item> items(ids.size());
  for (uint32_t rank = 0; rank < ids.size(); ++rank) {
    Item& item = items[rank];
    const Vec3 direction = along(Finite(cameras[ids[rank]].direction));
    for (int k = 0; k < 3; ++k) {
      item.at[static_cast<size_t>(k)] = scale > 0 ? Rounded(scale * positions[rank][k]) : 0;
      item.towards[static_cast<size_t>(k)] = Rounded(kUnit * std::clamp(direction[k], -1.0, 1.0));
    }
    item.rank = rank;
  }
  return items;
}

}  // namespace

std::vector<uint32_t> ExposureNumbers(std::span<const double> exposures) {
  constexpr double kHalfStop = 1.4142135623730951;
  std::vector<size_t> ascending(exposures.size());
  std::iota(ascending.begin(), ascending.end(), size_t{0});
  std::sort(ascending.begin(), ascending.end(),
            [&](size_t a, size_t b) { return exposures[a] < exposures[b]; });
  std::vector<uint32_t> numbers(exposures.size());
  for (size_t i = 1; i < ascending.size(); ++i) {
    const size_t before = ascending[i - 1], here = ascending[i];
    const bool is_apart = exposures[here] > kHalfStop * exposures[before];
    numbers[here] = numbers[before] + (is_apart ? 1 : 0);
  }
  return numbers;
}

ReferenceGroups GroupCameras(std::span<const CameraToGroup> cameras) {
  std::vector<uint32_t> ids(cameras.size());
  std::iota(ids.begin(), ids.end(), 0U);
  const auto key = [&](uint32_t id) {
    const Vec3 p = Finite(cameras[id].position), d = Finite(cameras[id].direction);
    return std::tuple(cameras[id].kind, p.x(), p.y(), p.z(), d.x(), d.y(), d.z(), id);
  };
  std::sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  ReferenceGroups groups;
  groups.members.reserve(cameras.size());
  for (size_t begin = 0, end = 0; begin < ids.size(); begin = end) {
    while (end < ids.size() && cameras[ids[end]].kind == cameras[ids[begin]].kind) ++end;
    const auto of_kind = std::span(ids).subspan(begin, end - begin);
    Grouping(ItemsOf(cameras, of_kind), of_kind, &groups).Divide();
  }
  return groups;
}

}  // namespace lf
