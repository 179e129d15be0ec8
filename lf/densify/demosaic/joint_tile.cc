// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace lf {
namespace {

// Pixels around a tile on which its own pixels depend: those of three merges, each of which reads
// kMergeReach, and of the windows of the alignment.
constexpr int kMargin = 20;

constexpr int kWindow = 2;  // windows of agreement and alignment have 5 x 5 pixels
constexpr int kAlignments = 2;
constexpr int kMerges = 3;
constexpr float kReach = 0.9F;  // pixels from a place to the farthest samples that count
constexpr float kPrior = 0.05F;
constexpr float kLeastWeight = 0.02F;
// Differences that are expected between LF images: of errors of demosaicking as a share of the
// contrast, of noise, and of exposure as a share of the light.
constexpr float kContrastShare = 0.6F, kMostNoise = 0.015F, kLightShare = 0.02F;
// Noise as a share of the mean of a dark LF image, and its least value.
constexpr float kNoiseShare = 0.15F, kLeastNoise = 1e-4F;
constexpr float kOutlierShare = 1.5F;  // s as a share of the contrast
// Weight of the depth as it was found, per square of shift in pixels, and the largest correction.
constexpr float kDepthWeight = 10, kMostMove_px = 0.5F;
constexpr float kNever = 1e6F;  // a difference that excludes agreement

// Returns about exp(-x); 0 from x = 4 on. The function exp() differs between machines.
float Decay(float x) {
  const float base = std::max(0.0F, 1 - 0.25F * x);
  return (base * base) * (base * base);
}

// Means over windows, with the border's pixels repeated.
class WindowMean {
 public:
  WindowMean(int width, int height)
      : width_(width), height_(height), rows_(static_cast<size_t>(width) * height) {}
  void Apply(std::vector<float>* values) {
    constexpr float kFactor = 1.0F / ((2 * kWindow + 1) * (2 * kWindow + 1));
    for (int y = 0; y < height_; ++y) {
      const float* const in = values->data() + Row(y);
      float* const out = rows_.data() + Row(y);
      for (int x = 0; x < width_; ++x) {
        float sum = 0;
        for (int i = -kWindow; i <= kWindow; ++i) sum += in[std::clamp(x + i, 0, width_ - 1)];
        out[x] = sum;
      }
    }
    for (int y = 0; y < height_; ++y) {
      std::array<const float*, 2 * kWindow + 1> in;
      for (int i = -kWindow; i <= kWindow; ++i)
        in[static_cast<size_t>(i + kWindow)] =
            rows_.data() + Row(std::clamp(y + i, 0, height_ - 1));
      float* const out = values->data() + Row(y);
      for (int x = 0; x < width_; ++x)
        out[x] = kFactor * (in[0][x] + in[1][x] + in[2][x] + in[3][x] + in[4][x]);
    }
  }

 private:
  size_t Row(int y) const { return static_cast<size_t>(y) * static_cast<size_t>(width_); }
  const int width_, height_;
  std::vector<float> rows_;
};

// Interpolates three colours linearly. The place must lie between centres of pixels.
std::array<float, JointImage::kColours> LinearAt(const Image<float>& image, float x, float y) {
  const int column = std::min(static_cast<int>(x), image.width() - 2);
  const int row = std::min(static_cast<int>(y), image.height() - 2);
  const float u = x - static_cast<float>(column), v = y - static_cast<float>(row);
  const float* const above = image.row(row) + static_cast<ptrdiff_t>(column) * JointImage::kColours;
  const float* const below =
      image.row(row + 1) + static_cast<ptrdiff_t>(column) * JointImage::kColours;
  std::array<float, JointImage::kColours> result;
  for (size_t c = 0; c < JointImage::kColours; ++c)
    result[c] = (1 - v) * ((1 - u) * above[c] + u * above[c + JointImage::kColours]) +
                v * ((1 - u) * below[c] + u * below[c + JointImage::kColours]);
  return result;
}

// Weights of Catmull-Rom interpolation at the fraction f between the second and the third of four.
std::array<float, 4> CubicWeights(float f) {
  return {((-0.5F * f + 1) * f - 0.5F) * f, (1.5F * f - 2.5F) * f * f + 1,
          ((-1.5F * f + 2) * f + 0.5F) * f, (0.5F * f - 0.5F) * f * f};
}

// A value that a neighbour recorded near the place of a pixel of the tile.
struct Sample {
  float value;
  float weight;  // without the factor of outliers
  float offset_x, offset_y;
  int colour;
};

class TileMerger {
 public:
  TileMerger(const JointTarget& target, const PixelRect& rect)
      : target_(target),
        image_(*target.image),
        rect_(rect),
        wide_(Intersection({rect.x_begin - kMargin, rect.y_begin - kMargin, rect.x_end + kMargin,
                            rect.y_end + kMargin},
                           {0, 0, image_.width(), image_.height()})),
        width_(wide_.width()),
        height_(wide_.height()),
        count_(static_cast<size_t>(width_) * height_),
        mean_(width_, height_) {}

  JointTile Merge();

 private:
  struct Aligned {
    std::vector<float> x, y;       // the place of each pixel
    std::vector<float> agreement;  // 0 to 1
  };

  size_t Index(int x, int y) const { return static_cast<size_t>(y) * width_ + x; }
  const float* Smooth(int x, int y) const {
    return &image_.smooth.at(wide_.x_begin + x, wide_.y_begin + y);
  }
  void MeasureContrast();
  // Finds places and agreement of a neighbour. Adds to the equations of the corrections of depth if
  // `equations` is not null.
  struct Equations {
    std::vector<float> product, square;
  };
  void Align(const JointNeighbour& neighbour, Aligned* aligned, Equations* equations);
  void AlignAll();
  void CollectSamples();
  void AddSamples(const JointNeighbour& neighbour, float agreement, float place_x, float place_y,
                  int own_colour, bool all_colours);
  // Returns the value of a plane of `base` at an offset from a pixel.
  float BaseAt(const std::vector<float>& base, int colour, int x, int y, float offset_x,
               float offset_y) const;
  float Corrected(const std::vector<float>& base, int colour, int x, int y) const;
  std::vector<float> PlanesOf(const Image<float>& rgb) const;

  const JointTarget& target_;
  const JointImage& image_;
  const PixelRect rect_, wide_;  // the tile, and the tile with its margin
  const int width_, height_;     // of wide_
  const size_t count_;
  WindowMean mean_;
  std::vector<float> depths_;
  std::vector<float> contrast_;  // variance of `rgb` around each pixel, mean of the colours
  std::vector<float> noise_;     // variance that is expected without contrast
  std::vector<Aligned> aligned_;
  std::vector<Sample> samples_;
  std::vector<uint32_t> first_;  // [pixel]: its first sample; one more at the end
};

void TileMerger::MeasureContrast() {
  contrast_.assign(count_, 0);
  noise_.resize(count_);
  std::vector<float> mean(count_), square(count_);
  for (int c = 0; c < JointImage::kColours; ++c) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const float value = image_.rgb.at(wide_.x_begin + x, wide_.y_begin + y, c);
        const float known = std::isnan(value) ? 0 : value;
        mean[Index(x, y)] = known;
        square[Index(x, y)] = known * known;
      }
    mean_.Apply(&mean);
    mean_.Apply(&square);
    for (size_t i = 0; i < count_; ++i)
      contrast_[i] += std::max(0.0F, square[i] - mean[i] * mean[i]) * (1.0F / JointImage::kColours);
  }
  const float noise = std::clamp(kNoiseShare * image_.mean, kLeastNoise, kMostNoise);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const float* const light = Smooth(x, y);
      const float sum = light[0] + light[1] + light[2];
      const float deviation =
          noise + kLightShare / JointImage::kColours * (sum > 0 ? sum : 0);  // NaN becomes 0
      noise_[Index(x, y)] = deviation * deviation;
    }
}

void TileMerger::Align(const JointNeighbour& neighbour, Aligned* aligned, Equations* equations) {
  const JointImage& other = *neighbour.image;
  const float most_x = static_cast<float>(other.width() - 1) - 1,
              most_y = static_cast<float>(other.height() - 1) - 1;
  aligned->x.resize(count_);
  aligned->y.resize(count_);
  aligned->agreement.resize(count_);
  std::vector<float> differences(count_ * JointImage::kColours), squares(count_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const size_t i = Index(x, y);
      const Vec2 ideal = target_.ideal->At(wide_.x_begin + x, wide_.y_begin + y);
      const PixelPlaces::Place place = neighbour.places.At(
          static_cast<float>(ideal.x()), static_cast<float>(ideal.y()), depths_[i]);
      aligned->x[i] = place.x;
      aligned->y[i] = place.y;
      squares[i] = kNever;
      if (!(place.x >= 1 && place.y >= 1 && place.x <= most_x && place.y <= most_y)) continue;
      const std::array<float, JointImage::kColours> shown =
          LinearAt(other.smooth, place.x, place.y);
      float sum = 0;
      for (size_t c = 0; c < JointImage::kColours; ++c) {
        const float difference = Smooth(x, y)[c] - shown[c];
        differences[i * JointImage::kColours + c] = difference;
        sum += difference * difference;
      }
      if (!std::isnan(sum)) squares[i] = sum * (1.0F / JointImage::kColours);
    }
  std::vector<float>& agreement = aligned->agreement;
  const auto is_seen = [&](size_t i) { return squares[i] < kNever; };
  agreement = squares;
  mean_.Apply(&agreement);
  for (size_t i = 0; i < count_; ++i) {
    const float expected = kContrastShare * kContrastShare * contrast_[i] + noise_[i];
    agreement[i] = is_seen(i) ? Decay(0.5F * agreement[i] / expected) : 0;
  }
  // LF cameras at the same place say nothing about depths.
  if (equations == nullptr || neighbour.shift_px <= 0) return;
  const float step = static_cast<float>(0.01 / neighbour.shift_px);
  for (int y = 1; y + 1 < height_; ++y)
    for (int x = 1; x + 1 < width_; ++x) {
      const size_t i = Index(x, y);
      if (!(agreement[i] > 1e-3F)) continue;
      const Vec2 ideal = target_.ideal->At(wide_.x_begin + x, wide_.y_begin + y);
      const PixelPlaces::Place next = neighbour.places.At(
          static_cast<float>(ideal.x()), static_cast<float>(ideal.y()), depths_[i] + step);
      const float move_x = (next.x - aligned->x[i]) / step,
                  move_y = (next.y - aligned->y[i]) / step;
      const float weight = agreement[i] / noise_[i];
      for (int c = 0; c < JointImage::kColours; ++c) {
        const float gradient = 0.5F * (move_x * (Smooth(x + 1, y)[c] - Smooth(x - 1, y)[c]) +
                                       move_y * (Smooth(x, y + 1)[c] - Smooth(x, y - 1)[c]));
        if (std::isnan(gradient)) continue;
        equations->product[i] +=
            weight * gradient * differences[i * JointImage::kColours + static_cast<size_t>(c)];
        equations->square[i] += weight * gradient * gradient;
      }
    }
}

// Moves the depths to where the neighbours agree best: a step of Gauss and Newton for windows of
// pixels, from the depths that a search with steps of a third of a pixel has found.
void TileMerger::AlignAll() {
  depths_.resize(count_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      depths_[Index(x, y)] = target_.inverse_depths->at(wide_.x_begin + x, wide_.y_begin + y);
  double shift_px = 0;
  for (const JointNeighbour& neighbour : target_.neighbours) shift_px += neighbour.shift_px;
  shift_px /= static_cast<double>(target_.neighbours.size());
  const float most = static_cast<float>(kMostMove_px / shift_px),
              prior = static_cast<float>(kDepthWeight * shift_px * shift_px);
  aligned_.resize(target_.neighbours.size());
  for (int round = 0; round <= kAlignments; ++round) {
    const bool is_last = round == kAlignments;
    Equations equations;
    if (!is_last) equations = {std::vector<float>(count_), std::vector<float>(count_)};
    for (size_t j = 0; j < aligned_.size(); ++j)
      Align(target_.neighbours[j], &aligned_[j], is_last ? nullptr : &equations);
    if (is_last || shift_px <= 0) return;
    mean_.Apply(&equations.product);
    mean_.Apply(&equations.square);
    for (size_t i = 0; i < count_; ++i)
      depths_[i] += std::clamp(equations.product[i] / (equations.square[i] + prior), -most, most);
  }
}

void TileMerger::AddSamples(const JointNeighbour& neighbour, float agreement, float place_x,
                            float place_y, int own_colour, bool all_colours) {
  // The 3 x 3 pixels around the place are in the image, because Align() has seen to it.
  const JointImage& other = *neighbour.image;
  const int middle_x = static_cast<int>(place_x + 0.5F),
            middle_y = static_cast<int>(place_y + 0.5F);
  for (int y = middle_y - 1; y <= middle_y + 1; ++y)
    for (int x = middle_x - 1; x <= middle_x + 1; ++x) {
      const float from_x = static_cast<float>(x) - place_x,
                  from_y = static_cast<float>(y) - place_y;
      const float offset_x = neighbour.offsets.X(from_x, from_y),
                  offset_y = neighbour.offsets.Y(from_x, from_y);
      const float square = offset_x * offset_x + offset_y * offset_y;
      if (square >= kReach * kReach) continue;
      const int colour = other.ColourAt(x, y);
      if (colour == own_colour && !all_colours) continue;
      const float base = 1 - square * (1 / (kReach * kReach));
      const float weight = agreement * ((base * base) * (base * base));
      if (weight < kLeastWeight) continue;
      const float value = other.samples.at(x, y);
      const auto c = static_cast<size_t>(colour);
      // A value that is clipped at less light than the target would record tells nothing.
      const bool is_cut =
          value >= other.clipped_from[c] && other.clipped_from[c] < 0.99F * image_.clipped_from[c];
      if (std::isnan(value) || is_cut) continue;
      samples_.push_back({value, weight * neighbour.nearness, offset_x, offset_y, colour});
    }
}

void TileMerger::CollectSamples() {
  constexpr float kLeastAgreement = 0.01F;
  samples_.clear();
  first_.clear();
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      first_.push_back(static_cast<uint32_t>(samples_.size()));
      const int in_x = wide_.x_begin + x, in_y = wide_.y_begin + y;
      for (size_t j = 0; j < aligned_.size(); ++j) {
        const Aligned& at = aligned_[j];
        const size_t i = Index(x, y);
        if (!(at.agreement[i] >= kLeastAgreement)) continue;
        AddSamples(target_.neighbours[j], at.agreement[i], at.x[i], at.y[i],
                   image_.ColourAt(in_x, in_y), target_.is_tested->at(in_x, in_y) != 0);
      }
    }
  first_.push_back(static_cast<uint32_t>(samples_.size()));
  aligned_.clear();
}

float TileMerger::BaseAt(const std::vector<float>& base, int colour, int x, int y, float offset_x,
                         float offset_y) const {
  const int left = offset_x < 0 ? x - 1 : x, upper = offset_y < 0 ? y - 1 : y;
  const std::array<float, 4> across = CubicWeights(offset_x < 0 ? offset_x + 1 : offset_x),
                             down = CubicWeights(offset_y < 0 ? offset_y + 1 : offset_y);
  const float* const plane = base.data() + static_cast<size_t>(colour) * count_;
  float sum = 0;
  if (left >= 1 && upper >= 1 && left + 2 < width_ && upper + 2 < height_) {
    const float* row = plane + Index(left - 1, upper - 1);
    for (size_t j = 0; j < 4; ++j, row += width_)
      sum += down[j] *
             (across[0] * row[0] + across[1] * row[1] + across[2] * row[2] + across[3] * row[3]);
    return sum;
  }
  for (int j = 0; j < 4; ++j) {
    const float* const row = plane + Index(0, std::clamp(upper - 1 + j, 0, height_ - 1));
    float in_row = 0;
    for (int i = 0; i < 4; ++i)
      in_row += across[static_cast<size_t>(i)] * row[std::clamp(left - 1 + i, 0, width_ - 1)];
    sum += down[static_cast<size_t>(j)] * in_row;
  }
  return sum;
}

float TileMerger::Corrected(const std::vector<float>& base, int colour, int x, int y) const {
  const size_t i = Index(x, y);
  const float outlier = 1 / (kOutlierShare * kOutlierShare * contrast_[i] + noise_[i]);
  float sum = 0, weights = 0;
  for (uint32_t s = first_[i]; s < first_[i + 1]; ++s) {
    const Sample& sample = samples_[s];
    if (sample.colour != colour) continue;
    const float residual =
        sample.value - BaseAt(base, colour, x, y, sample.offset_x, sample.offset_y);
    if (std::isnan(residual)) continue;
    const float weight = sample.weight / (1 + residual * residual * outlier);
    sum += weight * residual;
    weights += weight;
  }
  return base[static_cast<size_t>(colour) * count_ + i] + sum / (weights + kPrior);
}

// Returns the pixels of the tile with its margin, colour by colour.
std::vector<float> TileMerger::PlanesOf(const Image<float>& rgb) const {
  std::vector<float> planes(count_ * JointImage::kColours);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      for (int c = 0; c < JointImage::kColours; ++c)
        planes[static_cast<size_t>(c) * count_ + Index(x, y)] =
            rgb.at(wide_.x_begin + x, wide_.y_begin + y, c);
  return planes;
}

JointTile TileMerger::Merge() {
  JointTile tile{rect_, Image<float>(rect_.width(), rect_.height(), JointImage::kColours),
                 Image<float>(rect_.width(), rect_.height())};
  MeasureContrast();
  AlignAll();
  CollectSamples();
  std::vector<float> base = PlanesOf(image_.rgb);
  std::vector<float> merged = base;
  for (int round = 0; round < kMerges; ++round) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const int own = image_.ColourAt(wide_.x_begin + x, wide_.y_begin + y);
        for (int c = 0; c < JointImage::kColours; ++c)
          if (c != own)
            merged[static_cast<size_t>(c) * count_ + Index(x, y)] = Corrected(base, c, x, y);
      }
    base = merged;
  }
  const std::vector<float> other = PlanesOf(*target_.other);
  for (int y = 0; y < rect_.height(); ++y)
    for (int x = 0; x < rect_.width(); ++x) {
      const int in_x = rect_.x_begin + x, in_y = rect_.y_begin + y;
      const int wide_x = in_x - wide_.x_begin, wide_y = in_y - wide_.y_begin;
      for (int c = 0; c < JointImage::kColours; ++c)
        tile.rgb.at(x, y, c) = base[static_cast<size_t>(c) * count_ + Index(wide_x, wide_y)];
      if (target_.is_tested->at(in_x, in_y) != 0)
        tile.tested.at(x, y) = Corrected(other, image_.ColourAt(in_x, in_y), wide_x, wide_y);
    }
  return tile;
}

}  // namespace

JointTile MergeTile(const JointTarget& target, const PixelRect& rect) {
  return TileMerger(target, rect).Merge();
}

}  // namespace lf
