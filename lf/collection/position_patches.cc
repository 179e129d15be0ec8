// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/position_patches.h"

#include <algorithm>
#include <cmath>

#include "lf/core/quintic.h"

namespace lf {

void PositionPatches::Add(int y, int x_begin, int x_end, std::vector<Segment>* segments) {
  if (y / kRows != band_) {
    band_ = y / kRows;
    patches_.clear();
  }
  for (int x = x_begin; x < x_end;) {
    const int block = x / Segment::kMaxCount;
    const int end = std::min(x_end, (block + 1) * Segment::kMaxCount);
    for (const Patch& patch : PatchesOf(static_cast<size_t>(block))) {
      const int from = std::max(x, patch.begin), to = std::min(end, patch.end);
      if (from < to) AddPart(y, from, to, patch, segments);
    }
    x = end;
  }
}

const std::vector<PositionPatches::Patch>& PositionPatches::PatchesOf(size_t block) {
  if (patches_.size() <= block) patches_.resize(block + 1);
  std::vector<Patch>& patches = patches_[block];
  const int begin = static_cast<int>(block) * Segment::kMaxCount;
  if (patches.empty()) AddPatches(begin, begin + Segment::kMaxCount, &patches);
  return patches;
}

void PositionPatches::AddPatches(int begin, int end, std::vector<Patch>* patches) const {
  std::optional<Surface> surface = Fit(begin, end);
  if (surface || end - begin <= kRows) {
    patches->push_back({begin, end, std::move(surface)});
    return;
  }
  const int split = begin + (end - begin) / 2;
  AddPatches(begin, split, patches);
  AddPatches(split, end, patches);
}

std::optional<PositionPatches::Surface> PositionPatches::Fit(int begin, int end) const {
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  const double middle_y = kRows * (band_ + 0.5), half_y = 0.5 * kRows;
  // [i].col(l): coefficient of v^l along the i-th of six columns. A second fit, across the columns,
  // makes the powers of t.
  Surface through;
  for (size_t i = 0; i < through.size(); ++i) {
    std::array<Vec2, Segment::kTerms> down;
    for (size_t j = 0; j < down.size(); ++j) {
      const std::optional<Vec2> p =
          position_(middle + half * kQuinticPlaces[i], middle_y + half_y * kQuinticPlaces[j]);
      if (!p) return std::nullopt;
      down[j] = *p;
    }
    const std::array<Vec2, Segment::kTerms> powers = QuinticThrough(down);
    for (int l = 0; l < Segment::kTerms; ++l) through[i].col(l) = powers[static_cast<size_t>(l)];
  }
  Surface surface = QuinticThrough(through);
  double scale = 1;
  for (auto& power : surface) {
    power *= scale;
    scale /= half;
  }
  for (const double v : kQuinticWorstPlaces) {
    const Polynomials polynomials = RowOf(surface, v);
    if (!IsNearMiddle(polynomials, half)) return std::nullopt;
    for (const double u : kQuinticWorstPlaces) {
      const std::optional<Vec2> truth = position_(middle + u * half, middle_y + v * half_y);
      if (!truth || !(std::abs(QuinticAt(polynomials.x, u * half) - truth->x()) +
                          std::abs(QuinticAt(polynomials.y, u * half) - truth->y()) <=
                      SegmentMaker::kTolerance))
        return std::nullopt;
    }
  }
  return surface;
}

void PositionPatches::AddPart(int y, int x_begin, int x_end, const Patch& patch,
                              std::vector<Segment>* segments) const {
  if (patch.surface) {
    const double v = (y + 0.5 - kRows * (band_ + 0.5)) / (0.5 * kRows);
    const Polynomials polynomials = RowOf(*patch.surface, v);
    if (IsNearMiddle(polynomials, 0.5 * (patch.end - patch.begin))) {
      segments->push_back(
          MakeSegment(y, x_begin, x_end, 0.5 * (patch.begin + patch.end), polynomials));
      return;
    }
  }
  const auto along_row = [&](double x) { return position_(x, y + 0.5); };
  SegmentMaker::AddOfFunction(y, x_begin, x_end, patch.begin, patch.end, along_row, segments);
}

Polynomials PositionPatches::RowOf(const Surface& surface, double v) {
  Eigen::Matrix<double, Segment::kTerms, 1> powers;
  powers[0] = 1;
  for (int l = 1; l < Segment::kTerms; ++l) powers[l] = v * powers[l - 1];
  Polynomials row;
  for (size_t k = 0; k < surface.size(); ++k) {
    const Vec2 coefficient = surface[k] * powers;
    row.x[k] = coefficient.x();
    row.y[k] = coefficient.y();
  }
  return row;
}

}  // namespace lf
