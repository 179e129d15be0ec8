// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/camera_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lf/core/check.h"
#include "lf/selection/ideal_cells.h"

namespace lf {
namespace {

constexpr size_t kMostInLeaf = 32;
constexpr int kLevels = 21;  // bits of each coordinate; three coordinates fit into 64 bits

// Moves bit i of a 21-bit number to bit 3 i.
uint64_t Spread(uint64_t v) {
  v = (v | v << 32) & 0x001F00000000FFFF;
  v = (v | v << 16) & 0x001F0000FF0000FF;
  v = (v | v << 8) & 0x100F00F00F00F00F;
  v = (v | v << 4) & 0x10C30C30C30C30C3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}

Vec3 AxisOf(const LfCamera& camera) { return camera.cam_from_world.rotation.row(2).transpose(); }

double AngleBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Returns the largest angle, in radians, between the optical axis and a ray of the LF image; pi if
// it is unknown, or a right angle or more.
double ViewAngle(const Intrinsics& k) {
  const Mat3 to_camera = k.InverseMatrix();
  const auto angle_of = [&](const Vec3& ideal) {
    return AngleBetween(Vec3::UnitZ(), to_camera * ideal);
  };
  double most = 0;
  const auto add_box = [&](const Vec3& low, const Vec3& high) {
    // The largest angle is at a corner of the box, because a cone is convex.
    for (int i = 0; i < 8; ++i)
      most =
          std::max(most, angle_of({(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                                   (i & 4) != 0 ? high[2] : low[2]}));
  };
  if (!k.has_distortion()) {
    add_box({0, 0, 1}, {static_cast<double>(k.width_px), static_cast<double>(k.height_px), 1});
  } else {
    for (const IdealCell& cell : MakeIdealCells(k)) {
      if (!cell.has_bounds) return kPi;
      add_box(cell.middle - cell.extent, cell.middle + cell.extent);
    }
  }
  // The result is valid only below a right angle, because wider cones are not convex.
  return most < kPi / 2 ? most : kPi;
}

float RoundedDown(double v) {
  const auto near = static_cast<float>(v);
  return near <= v ? near : std::nextafter(near, -std::numeric_limits<float>::infinity());
}
float RoundedUp(double v) { return -RoundedDown(-v); }

}  // namespace

struct CameraTree::Builder {
  Builder(CameraTree* of, Content the_content)
      : tree(*of), cameras(of->light_field_.cameras), content(the_content) {}

  bool Contains(size_t i) const { return content == Content::kAll || !cameras[i].is_virtual; }

  void Build() {
    places.reserve(cameras.size());
    WorldBox all;
    for (size_t i = 0; i < cameras.size(); ++i) {
      places.push_back(cameras[i].cam_from_world.Inverse().translation);
      if (Contains(i)) all.Add(places.back());
    }
    const double size = std::max((all.high - all.low).maxCoeff(), 1e-300);
    codes.reserve(cameras.size());
    for (uint32_t i = 0; i < cameras.size(); ++i) {
      if (!Contains(i)) continue;
      uint64_t code = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double part = (places[i][axis] - all.low[axis]) / size;
        constexpr double kSteps = 1 << kLevels;
        code |= Spread(static_cast<uint64_t>(std::clamp(part * kSteps, 0.0, kSteps - 1))) << axis;
      }
      codes.emplace_back(code, i);
    }
    std::sort(codes.begin(), codes.end());
    for (const auto& [code, id] : codes) tree.ids_.push_back(LfImageId{id});
    tree.leaf_begin_.push_back(0);
    if (!codes.empty()) Add(0, codes.size(), kLevels);
  }

  // Adds a node for codes [begin, end), and the nodes below it. A code is the Morton code of an LF
  // camera's position, with one octal digit for each level. The codes differ only in their lowest
  // `levels` digits.
  void Add(size_t begin, size_t end, int levels) {
    const auto digit = [&](size_t i, int level) { return codes[i].first >> (3 * (level - 1)) & 7; };
    const bool is_leaf = end - begin <= kMostInLeaf || levels == 0;
    // Skips levels at which all codes have the same digit, because a node of such a level would
    // have a single child.
    while (!is_leaf && levels > 0 && digit(begin, levels) == digit(end - 1, levels)) --levels;
    const size_t node = tree.nodes_.size();
    tree.nodes_.emplace_back();
    const auto leaf = static_cast<uint32_t>(tree.leaf_count());
    if (is_leaf || levels == 0) {
      tree.leaf_begin_.push_back(static_cast<uint32_t>(end));
    } else {
      for (size_t first = begin; first < end;) {
        size_t last = first + 1;
        while (last < end && digit(last, levels) == digit(first, levels)) ++last;
        Add(first, last, levels - 1);
        first = last;
      }
    }
    Bound(begin, end, &tree.nodes_[node]);
    tree.nodes_[node].leaf_begin = leaf;
    tree.nodes_[node].leaf_end = static_cast<uint32_t>(tree.leaf_count());
    tree.nodes_[node].next = static_cast<uint32_t>(tree.nodes_.size());
  }

  void Bound(size_t begin, size_t end, Node* node) const {
    WorldBox box;
    Vec3 sum = Vec3::Zero();
    for (size_t i = begin; i < end; ++i) {
      box.Add(places[codes[i].second]);
      sum += AxisOf(cameras[codes[i].second]);
    }
    const Vec3 axis = sum.norm() > 0 ? Vec3(sum.normalized()) : Vec3(Vec3::UnitZ());
    const Vec3 kept = axis.cast<float>().cast<double>();
    double least_cosine = 1;
    for (size_t i = begin; i < end; ++i)
      least_cosine = std::min(least_cosine, kept.dot(AxisOf(cameras[codes[i].second])));
    constexpr double kRounding = 1e-6;
    const double spread = std::acos(std::max(-1.0, least_cosine - kRounding));
    for (int k = 0; k < 3; ++k) {
      node->low[k] = RoundedDown(box.low[k]);
      node->high[k] = RoundedUp(box.high[k]);
      node->axis[k] = static_cast<float>(kept[k]);
    }
    node->spread_rad = RoundedUp(spread);
  }

  CameraTree& tree;
  const std::vector<LfCamera>& cameras;
  const Content content;
  std::vector<Vec3> places;
  std::vector<std::pair<uint64_t, uint32_t>> codes;
};

CameraTree::CameraTree(const LightField& light_field, Content content) : light_field_(light_field) {
  ids_.reserve(content == Content::kAll ? light_field.size() : RecordedCount(light_field));
  Builder(this, content).Build();
  nodes_.shrink_to_fit();
  leaf_begin_.shrink_to_fit();
  for (const Intrinsics& k : light_field.intrinsics)
    view_angle_rad_ = std::max(view_angle_rad_, ViewAngle(k));
}

void CameraTree::ForEachLeaf(const SeenRegion& region,
                             const std::function<void(size_t leaf, bool all_inside)>& visit) const {
  constexpr double kRounding = 1e-6;
  // If the angle between the optical axes of an LF camera and of the frame is larger than this,
  // they have no ray direction in common.
  const double most_angle = region.ray_angle_rad() + view_angle_rad_ + kRounding;
  // Nodes with a smaller index than this are inside the region, because a node above them is.
  uint32_t inside_until = 0;
  for (uint32_t n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    const Vec3 axis = Eigen::Map<const Eigen::Vector3f>(node.axis).cast<double>();
    const WorldBox box{Eigen::Map<const Eigen::Vector3f>(node.low).cast<double>(),
                       Eigen::Map<const Eigen::Vector3f>(node.high).cast<double>()};
    const bool looks_away =
        AngleBetween(axis, region.forward_world()) - node.spread_rad > most_angle;
    if (looks_away || (n >= inside_until && region.Misses(box))) {
      n = node.next;
      continue;
    }
    if (n >= inside_until && region.HoldsAll(box)) inside_until = node.next;
    // A node without nodes below it is a leaf.
    if (node.next == n + 1) visit(node.leaf_begin, n < inside_until);
    ++n;
  }
}

}  // namespace lf
