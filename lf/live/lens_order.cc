#include "lf/live/lens_order.h"

#include <algorithm>
#include <limits>

namespace lf {

std::vector<size_t> FarthestPointOrder(std::span<const Vec2> points, size_t count,
                                       size_t preferred_count) {
  constexpr double kChosen = -1;
  constexpr double kPreference = 4;  // of squared distances
  const double infinity = std::numeric_limits<double>::infinity();
  count = std::min(count, points.size());
  std::vector<double> far2(points.size(), infinity);  // squared distance from the chosen points
  std::vector<size_t> chosen;
  while (chosen.size() < count) {
    size_t best = 0;
    double best_value = -infinity;
    for (size_t i = 0; i < points.size(); ++i) {
      if (far2[i] == kChosen) continue;
      const double value = chosen.empty() ? -points[i].squaredNorm()
                                          : far2[i] * (i < preferred_count ? kPreference : 1);
      if (value <= best_value) continue;
      best = i;
      best_value = value;
    }
    chosen.push_back(best);
    for (size_t i = 0; i < points.size(); ++i)
      far2[i] = std::min(far2[i], (points[i] - points[best]).squaredNorm());
    far2[best] = kChosen;
  }
  return chosen;
}

LensOrder OrderOverLens(std::span<const Vec2> points, double radius_w, size_t count,
                        size_t preferred_count) {
  constexpr double kAtRim = 1.1;
  std::vector<size_t> inside, outside;
  std::vector<Vec2> of_inside;
  size_t preferred_inside = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (points[i].norm() > kAtRim * radius_w) {
      outside.push_back(i);
      continue;
    }
    inside.push_back(i);
    of_inside.push_back(points[i]);
    preferred_inside += i < preferred_count ? 1 : 0;
  }
  std::stable_sort(outside.begin(), outside.end(), [&](size_t a, size_t b) {
    return points[a].squaredNorm() < points[b].squaredNorm();
  });
  LensOrder order;
  for (const size_t i : FarthestPointOrder(of_inside, count, preferred_inside))
    order.indices.push_back(inside[i]);
  order.inside_count = order.indices.size();
  for (const size_t i : outside)
    if (order.indices.size() < count) order.indices.push_back(i);
  return order;
}

}  // namespace lf
