// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/position_patches.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lf/core/quintic.h"

namespace lf {

void PositionPatches::Add(int y, int x_begin, int x_end, std::vector<Segment>* segments,
                          std::vector<const PositionBounds*>* bounds) {
  bounds->clear();
  if (y / kBlock != band_) {
    band_ = y / kBlock;
    patches_.clear();
    blocks_.clear();
    row_.clear();
  }
  if (row_.empty() || y < row_y_begin_ || y >= row_y_end_ || x_begin < row_.front()->rect.x_begin ||
      x_end > row_.back()->rect.x_end)
    FindRow(y, x_begin, x_end);
  for (const Patch* patch : row_) {
    const int from = std::max(x_begin, patch->rect.x_begin);
    const int to = std::min(x_end, patch->rect.x_end);
    if (from < to) AddOnPatch(y, from, to, *patch, segments, bounds);
  }
}

void PositionPatches::FindRow(int y, int x_begin, int x_end) {
  row_.clear();
  row_y_begin_ = band_ * kBlock;
  row_y_end_ = row_y_begin_ + kBlock;
  blocks_.resize(std::max(blocks_.size(), static_cast<size_t>((x_end - 1) / kBlock) + 1), nullptr);
  for (int block = x_begin / kBlock; block * kBlock < x_end; ++block) {
    Patch*& patch = blocks_[static_cast<size_t>(block)];
    if (patch == nullptr) {
      patch = &patches_.emplace_back();
      patch->rect = {block * kBlock, band_ * kBlock, (block + 1) * kBlock, (band_ + 1) * kBlock};
    }
    FindRowOn(patch, y, x_begin, x_end);
  }
}

void PositionPatches::FindRowOn(Patch* patch, int y, int x_begin, int x_end) {
  const PixelRect& rect = patch->rect;
  if (y < rect.y_begin || y >= rect.y_end || x_end <= rect.x_begin || x_begin >= rect.x_end) return;
  if (patch->state == State::kUnknown) Decide(patch);
  if (patch->state == State::kHalved) {
    for (Patch* half : patch->halves) FindRowOn(half, y, x_begin, x_end);
    return;
  }
  row_.push_back(patch);
  row_y_begin_ = std::max(row_y_begin_, rect.y_begin);
  row_y_end_ = std::min(row_y_end_, rect.y_end);
}

void PositionPatches::AddOnPatch(int y, int x_begin, int x_end, const Patch& patch,
                                 std::vector<Segment>* segments,
                                 std::vector<const PositionBounds*>* bounds) const {
  const PixelRect& rect = patch.rect;
  if (patch.state == State::kSurface) {
    const double half_height = 0.5 * rect.height();
    const double v = (y + 0.5 - rect.y_begin - half_height) / half_height;
    const Polynomials row = RowOf(patch.surface, v);
    if (patch.is_near_middle || IsNearMiddle(row, 0.5 * rect.width())) {
      const bool has_parabolas = patch.allows_parabolas || AllowParabolas(row, 0.5 * rect.width());
      AppendSegment(y, x_begin, x_end, 0.5 * (rect.x_begin + rect.x_end), row, has_parabolas,
                    segments);
      bounds->push_back(&patch.bounds);
      return;
    }
  }
  const auto along_row = [&](double x) { return position_(x, y + 0.5); };
  const size_t first = segments->size();
  SegmentMaker::AddOfFunction(y, x_begin, x_end, rect.x_begin, rect.x_end, along_row, segments);
  bounds->resize(bounds->size() + segments->size() - first, nullptr);
}

void PositionPatches::Decide(Patch* patch) {
  const std::optional<Direction> direction = Fit(patch);
  const PixelRect& rect = patch->rect;
  const bool is_narrow = rect.width() <= kLeastSize, is_low = rect.height() <= kLeastSize;
  patch->state = !direction            ? State::kSurface
                 : is_narrow && is_low ? State::kRowByRow
                                       : State::kHalved;
  if (patch->state != State::kHalved) return;
  PixelRect first = rect, second = rect;
  if (is_low || (*direction == Direction::kAcross && !is_narrow))
    first.x_end = second.x_begin = rect.x_begin + rect.width() / 2;
  else
    first.y_end = second.y_begin = rect.y_begin + rect.height() / 2;
  for (Patch*& half : patch->halves) half = &patches_.emplace_back();
  patch->halves[0]->rect = first;
  patch->halves[1]->rect = second;
}

std::optional<PositionPatches::Direction> PositionPatches::Fit(Patch* patch) const {
  const PixelRect& rect = patch->rect;
  const double half_x = 0.5 * rect.width(), half_y = 0.5 * rect.height();
  const double middle_x = rect.x_begin + half_x, middle_y = rect.y_begin + half_y;
  // [j]: powers of t along the j-th of six rows. A second fit, down the rows, makes powers of v.
  Surface rows;
  for (size_t j = 0; j < rows.size(); ++j) {
    std::array<Vec2, kTerms> through;
    for (size_t i = 0; i < through.size(); ++i) {
      const std::optional<Vec2> p =
          position_(middle_x + half_x * kQuinticPlaces[i], middle_y + half_y * kQuinticPlaces[j]);
      if (!p) return half_x >= half_y ? Direction::kAcross : Direction::kDown;
      through[i] = *p;
    }
    const std::array<Vec2, kTerms> powers = QuinticThrough(through);
    double scale = 1;
    for (int k = 0; k < kTerms; ++k) {
      rows[j].row(k) = powers[static_cast<size_t>(k)].transpose() * scale;
      scale /= half_x;
    }
  }
  patch->surface = QuinticThrough(rows);
  const Polynomials most = MostOf(patch->surface);
  patch->is_near_middle = IsNearMiddle(most, half_x);
  patch->allows_parabolas = AllowParabolas(most, half_x);
  for (const double v : kQuinticWorstPlaces) {
    const Polynomials row = RowOf(patch->surface, v);
    if (!patch->is_near_middle && !IsNearMiddle(row, half_x)) return Direction::kAcross;
    for (const double u : kQuinticWorstPlaces) {
      const std::optional<Vec2> truth = position_(middle_x + u * half_x, middle_y + v * half_y);
      if (!truth || !(std::abs(QuinticAt(row.x, u * half_x) - truth->x()) +
                          std::abs(QuinticAt(row.y, u * half_x) - truth->y()) <=
                      SegmentMaker::kTolerance))
        return RoughDirection(patch->surface, half_x);
    }
  }
  patch->bounds = BoundsOf(*patch);
  return std::nullopt;
}

Polynomials PositionPatches::RowOf(const Surface& surface, double v) {
  RowPowers powers = surface.back();
  for (size_t l = surface.size() - 1; l-- > 0;) powers = powers * v + surface[l];
  return FromPowers(powers);
}

Polynomials PositionPatches::MostOf(const Surface& surface) {
  RowPowers sum = RowPowers::Zero();
  for (const RowPowers& powers : surface) sum += powers.abs();
  return FromPowers(sum);
}

Polynomials PositionPatches::FromPowers(const RowPowers& powers) {
  Polynomials polynomials;
  std::copy_n(powers.col(0).data(), kTerms, polynomials.x);
  std::copy_n(powers.col(1).data(), kTerms, polynomials.y);
  return polynomials;
}

// Returns the direction in which the surface is less accurate. The error comes from powers that the
// surface lacks; the terms of its two highest powers show how large they are.
PositionPatches::Direction PositionPatches::RoughDirection(const Surface& surface, double half_x) {
  double across = 0, down = 0, scale = 1;
  for (int k = 0; k < kTerms; ++k) {
    for (size_t l = 0; l < surface.size(); ++l) {
      const double term = surface[l].row(k).abs().sum() * scale;
      if (k >= kTerms - 2) across += term;
      if (l >= surface.size() - 2) down += term;
    }
    scale *= half_x;
  }
  return down > across ? Direction::kDown : Direction::kAcross;
}

// Bounds the terms that are linear in t or v on the elements that will be asked for, and the other
// terms on the whole patch.
PositionPatches::PositionBounds PositionPatches::BoundsOf(const Patch& patch) const {
  constexpr double kMargin = 0.01;  // far above the rounding of single precision
  const PixelRect& rect = patch.rect;
  const PixelRect asked = Intersection(rect, elements_);
  const double half_x = 0.5 * rect.width(), half_y = 0.5 * rect.height();
  const double t_low = asked.x_begin - rect.x_begin - half_x, t_high = t_low + asked.width();
  const double v_low = (asked.y_begin - rect.y_begin - half_y) / half_y;
  const double v_high = v_low + asked.height() / half_y;
  PositionBounds bounds;
  for (const int axis : {0, 1}) {
    double others = kMargin, scale = 1;
    for (int k = 0; k < kTerms; ++k) {
      for (size_t l = 0; l < patch.surface.size(); ++l)
        if (static_cast<size_t>(k) + l > 1) others += std::abs(patch.surface[l](k, axis)) * scale;
      scale *= half_x;
    }
    const double middle = patch.surface[0](0, axis);
    const double across = patch.surface[0](1, axis), down = patch.surface[1](0, axis);
    bounds.low[axis] = middle + std::min(across * t_low, across * t_high) +
                       std::min(down * v_low, down * v_high) - others;
    bounds.high[axis] = middle + std::max(across * t_low, across * t_high) +
                        std::max(down * v_low, down * v_high) + others;
  }
  return bounds;
}

}  // namespace lf
