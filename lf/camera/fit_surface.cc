// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/fit_surface.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <queue>
#include <utility>
#include <vector>

#include "lf/core/check.h"

namespace lf {
namespace {

bool IsKnown(float q) { return q > 0 && std::isfinite(q); }

// A square of the quadtree, cut off by the plate, with the plane through its elements.
struct Node {
  FocalPiece piece;
  int side = 0;       // length of a side of the square
  double most = 0;    // largest difference of an inverse depth from the plane
  double sum = 0;     // sum of the differences
  double excess = 0;  // sum of the squared differences beyond the limit
  size_t beyond = 0;  // number of differences beyond the limit
};

class Fitter {
 public:
  Fitter(const Image<float>& inverse_depths, const SurfaceFitOptions& options)
      : q_(inverse_depths),
        options_(options),
        limit_(options.blur_px_w > 0 ? options.most_blur_px / options.blur_px_w : INFINITY) {}

  FittedSurface Run() {
    const int width = q_.width(), height = q_.height();
    size_t most = options_.most_pieces;
    if (most == 0) most = std::max(kLeastPieces, q_.pixels().size() / kElementsPerPiece);
    const auto side = static_cast<int>(
        std::bit_ceil(static_cast<unsigned>(std::max({width, height, options_.least_side_px}))));
    // The node with the largest excess is divided first; of equal ones, the one that was made
    // first.
    using Entry = std::pair<double, size_t>;
    const auto is_later = [](const Entry& a, const Entry& b) {
      return a.first != b.first ? a.first < b.first : a.second > b.second;
    };
    std::priority_queue<Entry, std::vector<Entry>, decltype(is_later)> open(is_later);
    std::vector<Node> nodes;
    std::vector<bool> is_leaf;
    size_t leaves = 0;
    const auto add = [&](const PixelRect& square, int of_side) {
      const PixelRect elements = Intersection(square, {0, 0, width, height});
      if (elements.empty()) return;
      nodes.push_back(NodeOf(elements, of_side));
      is_leaf.push_back(true);
      ++leaves;
      if (nodes.back().excess > 0 && of_side / 2 >= options_.least_side_px)
        open.emplace(nodes.back().excess, nodes.size() - 1);
    };
    add({0, 0, side, side}, side);
    while (!open.empty() && leaves + 3 <= most) {
      const size_t divided = open.top().second;
      open.pop();
      is_leaf[divided] = false;
      --leaves;
      const int half = nodes[divided].side / 2;
      const int x = nodes[divided].piece.elements.x_begin;
      const int y = nodes[divided].piece.elements.y_begin;
      for (const int down : {0, half})
        for (const int right : {0, half})
          add({x + right, y + down, x + right + half, y + down + half}, half);
    }
    std::vector<FocalPiece> pieces;
    double most_difference = 0, sum = 0;
    size_t beyond = 0;
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (!is_leaf[i]) continue;
      const Node node = nodes[i].excess > 0 ? Coarse(nodes[i]) : nodes[i];
      pieces.push_back(node.piece);
      most_difference = std::max(most_difference, node.most);
      sum += node.sum;
      beyond += node.beyond;
    }
    Result<FocalSurface> surface = FocalSurface::Of(width, height, std::move(pieces));
    LF_CHECK(surface.has_value());
    return {*std::move(surface), most_difference * options_.blur_px_w,
            sum * options_.blur_px_w / static_cast<double>(q_.pixels().size()), beyond};
  }

 private:
  // Returns the node with the plane that fits best.
  Node NodeOf(const PixelRect& r, int side) const {
    Node node;
    node.side = side;
    node.piece.elements = r;
    const double middle_x = 0.5 * (r.x_begin + r.x_end), middle_y = 0.5 * (r.y_begin + r.y_end);
    double sum = 0, across = 0, down = 0;
    for (int y = r.y_begin; y < r.y_end; ++y)
      for (int x = r.x_begin; x < r.x_end; ++x) {
        const double q = q_.at(x, y);
        sum += q;
        across += q * (x + 0.5 - middle_x);
        down += q * (y + 0.5 - middle_y);
      }
    // The positions of a rectangle's elements, counted from its middle, are orthogonal: each
    // coefficient is a quotient of sums. That of their squares along a side of n elements is
    // (n^3 - n) / 12.
    const double w = r.width(), h = r.height();
    const double squares_across = h * (w * w * w - w) / 12, squares_down = w * (h * h * h - h) / 12;
    const double slope_x = squares_across > 0 ? across / squares_across : 0;
    const double slope_y = squares_down > 0 ? down / squares_down : 0;
    node.piece.inverse_depth = {slope_x, slope_y,
                                sum / (w * h) - slope_x * middle_x - slope_y * middle_y};
    Measure(&node);
    return node;
  }

  void Measure(Node* node) const {
    const PixelRect& r = node->piece.elements;
    node->most = node->sum = node->excess = 0;
    node->beyond = 0;
    // A plane that reaches behind the lens, or much nearer to it than any of the elements, is of no
    // use.
    float nearest = 0;
    for (int y = r.y_begin; y < r.y_end; ++y)
      for (int x = r.x_begin; x < r.x_end; ++x) {
        const float q = q_.at(x, y);
        nearest = std::max(nearest, q);
        const double difference = std::abs(node->piece.At(x + 0.5, y + 0.5) - q);
        node->most = std::max(node->most, difference);
        node->sum += difference;
        if (difference > limit_) {
          node->excess += (difference - limit_) * (difference - limit_);
          ++node->beyond;
        }
      }
    for (const int y : {r.y_begin, r.y_end})
      for (const int x : {r.x_begin, r.x_end})
        if (const double q = node->piece.At(x, y); !(q > 0) || q > 2 * nearest)
          node->excess = std::max(node->excess, 1e-300);
  }

  // Returns the node of a piece that cannot be divided further: with its plane, or with the median
  // of its inverse depths if this is nearer, or if the plane reaches behind the lens.
  Node Coarse(const Node& node) const {
    const PixelRect& r = node.piece.elements;
    std::vector<float> all;
    for (int y = r.y_begin; y < r.y_end; ++y)
      for (int x = r.x_begin; x < r.x_end; ++x) all.push_back(q_.at(x, y));
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    Node flat = node;
    flat.piece.inverse_depth = {0, 0, *middle};
    Measure(&flat);
    bool is_usable = true;
    for (const int y : {r.y_begin, r.y_end})
      for (const int x : {r.x_begin, r.x_end}) is_usable &= node.piece.At(x, y) > 0;
    return is_usable && node.sum <= flat.sum ? node : flat;
  }

  const Image<float>& q_;
  const SurfaceFitOptions& options_;
  const double limit_;  // largest difference of an inverse depth
};

}  // namespace

size_t FillUnknown(Image<float>* inverse_depths) {
  const int width = inverse_depths->width(), height = inverse_depths->height();
  LargeVector<float>& q = inverse_depths->pixels();
  std::vector<size_t> front, next;  // elements whose neighbours are filled next
  std::vector<bool> is_known(q.size());
  for (size_t i = 0; i < q.size(); ++i)
    if ((is_known[i] = IsKnown(q[i]))) front.push_back(i);
  const size_t unknown_count = q.size() - front.size();
  if (unknown_count == 0 || front.empty()) return unknown_count;
  while (!front.empty()) {
    next.clear();
    for (const size_t i : front) {
      const int x = static_cast<int>(i % static_cast<size_t>(width));
      const int y = static_cast<int>(i / static_cast<size_t>(width));
      const auto fill = [&](int dx, int dy) {
        if (x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height) return;
        const size_t to =
            static_cast<size_t>(y + dy) * static_cast<size_t>(width) + static_cast<size_t>(x + dx);
        if (is_known[to]) return;
        is_known[to] = true;
        q[to] = q[i];
        next.push_back(to);
      };
      fill(0, -1);
      fill(-1, 0);
      fill(1, 0);
      fill(0, 1);
    }
    std::sort(next.begin(), next.end());
    std::swap(front, next);
  }
  return unknown_count;
}

FittedSurface FitSurface(const Image<float>& inverse_depths, const SurfaceFitOptions& options) {
  LF_CHECK(!inverse_depths.pixels().empty() && options.least_side_px >= 1);
  return Fitter(inverse_depths, options).Run();
}

SurfaceFit SetSurface(const Image<float>& inverse_depths, double most_blur_px,
                      double camera_distance_w, RenderCamera* camera) {
  const Intrinsics& k = camera->pinhole.intrinsics;
  LF_CHECK(inverse_depths.width() == k.width_px && inverse_depths.height() == k.height_px);
  SurfaceFitOptions options;
  options.most_blur_px = most_blur_px;
  options.blur_px_w =
      std::max(2 * camera->aperture.radius_w, 2 * camera_distance_w) * std::abs(k.fx_px);
  FittedSurface fitted = FitSurface(inverse_depths, options);
  camera->surface = std::make_shared<const FocalSurface>(std::move(fitted.surface));
  return {fitted.most_blur_px, fitted.mean_blur_px, fitted.beyond_count};
}

}  // namespace lf
