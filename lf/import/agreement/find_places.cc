// SPDX-License-Identifier: Apache-2.0
#include "lf/import/agreement/find_places.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "lf/core/median.h"
#include "lf/focus/reduced_image.h"
#include "lf/import/agreement/image_features.h"
#include "lf/import/agreement/pose_repair.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr int kMostSide_px = 800;  // of a reduced image
constexpr size_t kMostAnchors = 8;
constexpr size_t kMostFeatures = 400;
constexpr double kTolerance = 1.5;  // of epipolar lines, in reduced pixels
constexpr double kStill = 2;        // a place that moves by less, in reduced pixels, stands still
constexpr int kMostRings = 4;
constexpr double kEnoughShift = 10;  // in reduced pixels; no wider ring is compared

int DivisorOf(const Intrinsics& k) {
  return (std::max(k.width_px, k.height_px) + kMostSide_px - 1) / kMostSide_px;
}

// The corners of LF images, each of which is read once.
class FeatureCache {
 public:
  FeatureCache(const LightField& field, const LfImageStore& store,
               const std::atomic<bool>* interrupted)
      : field_(field), store_(store), interrupted_(interrupted) {}

  // Reads those of the LF images that were not read before.
  Result<void> Read(const std::vector<uint32_t>& images, ThreadPool& pool) {
    std::vector<uint32_t> unread;
    for (const uint32_t image : images)
      if (!features_.contains(image) &&
          std::find(unread.begin(), unread.end(), image) == unread.end())
        unread.push_back(image);
    std::vector<ImageFeatures> read(unread.size());
    MachineFailure failure;
    pool.ForEach(unread.size(), [&](size_t i) {
      if (interrupted_ && *interrupted_) return;
      const LfImageId id{unread[i]};
      const Intrinsics& k = field_.intrinsics[field_.cameras[id.value].intrinsics_index];
      const int divisor = DivisorOf(k);
      LfPixels pixels;
      const Result<int> reduced = LoadReducedWithoutThrowing(
          store_, id, divisor, k, field_.ImagePath(id).string(), &pixels);
      if (!reduced) return failure.Note(reduced.error());
      ReducedImage image = Reduced(pixels, divisor / *reduced);
      image.divisor = divisor;
      read[i] = FindFeatures(image, kMostFeatures);
    });
    LF_RETURN_IF_ERROR(failure.Check());
    if (interrupted_ && *interrupted_)
      return Error{ErrorKind::kInterrupted, "interrupted while images and poses were compared"};
    for (size_t i = 0; i < unread.size(); ++i) features_[unread[i]] = std::move(read[i]);
    return {};
  }
  const ImageFeatures& Of(uint32_t image) const { return features_.at(image); }
  size_t size() const { return features_.size(); }
  double MeanCount() const {
    double sum = 0;
    for (const auto& [image, features] : features_) sum += static_cast<double>(features.size());
    return features_.empty() ? 0 : sum / static_cast<double>(features_.size());
  }

 private:
  const LightField& field_;
  const LfImageStore& store_;
  const std::atomic<bool>* interrupted_;
  std::map<uint32_t, ImageFeatures> features_;
};

// Returns recorded LF images in the natural order of their names.
std::vector<uint32_t> RecordedByName(const LightField& field) {
  std::vector<uint32_t> order = NaturalOrder(field.image_names);
  std::erase_if(order, [&](uint32_t i) { return field.cameras[i].is_virtual; });
  return order;
}

// Returns up to four LF cameras in a ring around an LF camera, in directions as different as there
// are, because cameras in one line do not tell signs and scales of the other axis. The axes of the
// cameras do not count, because they may be wrong. All look in about the same direction.
std::vector<uint32_t> RingAround(const LightField& field, const std::vector<uint32_t>& images,
                                 const std::vector<Vec3>& centres, uint32_t anchor,
                                 double radius_w) {
  constexpr size_t kMostOfRing = 4;
  constexpr double kMostCosine = 0.8;  // between the directions of two LF cameras of a ring
  const Vec3 forward = field.Camera({anchor}).ForwardWorld();
  struct Candidate {
    uint32_t image;
    Vec3 direction;
    double cosine;  // largest one with the direction of a chosen LF camera
  };
  std::vector<Candidate> candidates;
  std::optional<size_t> next;
  double nearest_w = radius_w;
  for (const uint32_t i : images) {
    const Vec3 step = centres[i] - centres[anchor];
    const double length_w = step.norm();
    if (length_w < 0.6 * radius_w || length_w > 1.5 * radius_w) continue;
    if (field.cameras[i].cam_from_world.rotation.row(2).dot(forward) < 0.8) continue;
    candidates.push_back({i, step / length_w, -1});
    if (std::abs(length_w - radius_w) < nearest_w) {
      nearest_w = std::abs(length_w - radius_w);
      next = candidates.size() - 1;
    }
  }
  std::vector<uint32_t> ring;
  while (next && ring.size() < kMostOfRing) {
    ring.push_back(candidates[*next].image);
    const Vec3 direction = candidates[*next].direction;
    next.reset();
    double least = kMostCosine;
    for (size_t i = 0; i < candidates.size(); ++i) {
      double& cosine = candidates[i].cosine;
      cosine = std::max(cosine, candidates[i].direction.dot(direction));
      if (cosine < least) {
        least = cosine;
        next = i;
      }
    }
  }
  return ring;
}

// The places of one LF image (the anchor), which grow with each LF image that it is compared with.
class Anchor {
 public:
  Anchor(uint32_t image, const ImageFeatures& features)
      : image_(image), features_(features), others_(features.size()) {}

  // Compares the anchor with LF images, and returns the median shift of the places in reduced
  // pixels; 0 if there is no place in common.
  double Compare(const std::vector<uint32_t>& images, const FeatureCache& cache, int divisor,
                 FoundPlaces* found) {
    std::vector<double> shifts;
    for (const uint32_t image : images) {
      if (image == image_ || !compared_.insert(image).second) continue;
      const ImageFeatures& other = cache.Of(image);
      const std::vector<FeatureMatch> matches =
          MatchFeatures(features_, other, kTolerance * divisor);
      ++found->tried_count;
      if (!matches.empty()) ++found->pair_count;
      for (const auto& [a, b] : matches) {
        others_[a].push_back({image, other.at_px[b]});
        shifts.push_back((other.at_px[b] - features_.at_px[a]).norm() / divisor);
      }
    }
    return shifts.empty() ? 0 : Median(std::move(shifts));
  }

  void AddPlaces(int divisor, FoundPlaces* found) const {
    for (size_t i = 0; i < others_.size(); ++i) {
      SeenPlace place{{image_, features_.at_px[i]}, others_[i]};
      if (LongestMove(place) > kStill * divisor) found->places.push_back(std::move(place));
    }
  }

 private:
  uint32_t image_;
  const ImageFeatures& features_;
  std::vector<std::vector<Sighting>> others_;  // of each corner of the anchor
  std::set<uint32_t> compared_;
};

// Returns neighbours by name of the image at `position` of the order.
std::vector<uint32_t> NeighboursByName(const std::vector<uint32_t>& order, size_t position) {
  std::vector<uint32_t> neighbours;
  for (const int step : {-1, 1, 4}) {
    const auto at = static_cast<ptrdiff_t>(position) + step;
    if (at >= 0 && at < static_cast<ptrdiff_t>(order.size()))
      neighbours.push_back(order[static_cast<size_t>(at)]);
  }
  return neighbours;
}

double MedianMove(const FoundPlaces& found) {
  std::vector<double> moves;
  for (const SeenPlace& place : found.places) moves.push_back(LongestMove(place) / found.divisor);
  return moves.empty() ? 0 : Median(std::move(moves));
}

}  // namespace

double LongestMove(const SeenPlace& place) {
  double longest = 0;
  for (const Sighting& other : place.others)
    longest = std::max(longest, (other.at_px - place.from.at_px).norm());
  return longest;
}

Result<FoundPlaces> FindPlaces(const LightField& light_field, const LfImageStore& store,
                               ThreadPool& pool, const std::atomic<bool>* interrupted) {
  FoundPlaces found;
  const std::vector<uint32_t> images = RecordedByName(light_field);
  if (images.size() < 2) return found;
  std::vector<Vec3> centres(light_field.size());
  for (const uint32_t i : images)
    centres[i] = light_field.cameras[i].cam_from_world.Inverse().translation;
  const double spacing_w = MedianSpacing(light_field);
  const size_t anchor_count = std::min(kMostAnchors, images.size());
  found.divisor = DivisorOf(light_field.Camera({images[0]}).intrinsics);
  FeatureCache cache(light_field, store, interrupted);
  std::vector<Anchor> anchors;
  std::vector<uint32_t> first, all;
  std::vector<std::vector<uint32_t>> by_name;
  for (size_t i = 0; i < anchor_count; ++i) {
    const size_t position = (2 * i + 1) * images.size() / (2 * anchor_count);
    first.push_back(images[position]);
    by_name.push_back(NeighboursByName(images, position));
    all.push_back(first.back());
    all.insert(all.end(), by_name.back().begin(), by_name.back().end());
  }
  LF_RETURN_IF_ERROR(cache.Read(all, pool));
  for (size_t i = 0; i < anchor_count; ++i) {
    anchors.emplace_back(first[i], cache.Of(first[i]));
    anchors.back().Compare(by_name[i], cache, found.divisor, &found);
  }
  std::vector<char> goes_on(anchor_count, 1);  // no vector<bool>, because threads write it
  double radius_w = 1.2 * spacing_w;
  for (int ring = 0; ring < kMostRings && radius_w > 0; ++ring, radius_w *= 3) {
    std::vector<std::vector<uint32_t>> rings(anchor_count);
    all.clear();
    for (size_t i = 0; i < anchor_count; ++i) {
      if (!goes_on[i]) continue;
      rings[i] = RingAround(light_field, images, centres, first[i], radius_w);
      all.insert(all.end(), rings[i].begin(), rings[i].end());
    }
    LF_RETURN_IF_ERROR(cache.Read(all, pool));
    std::vector<FoundPlaces> counts(anchor_count);
    pool.ForEach(anchor_count, [&](size_t i) {
      if (!goes_on[i]) return;
      const double shift = anchors[i].Compare(rings[i], cache, found.divisor, &counts[i]);
      // Without any place in common, poses are wrong, and the next ring may still hit by chance.
      goes_on[i] = shift > 0 ? shift < kEnoughShift : ring == 0;
    });
    for (const FoundPlaces& count : counts) {
      found.pair_count += count.pair_count;
      found.tried_count += count.tried_count;
    }
  }
  for (const Anchor& anchor : anchors) anchor.AddPlaces(found.divisor, &found);
  found.image_count = cache.size();
  found.corner_count = cache.MeanCount();
  found.move = MedianMove(found);
  return found;
}

}  // namespace lf
