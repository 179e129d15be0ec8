// SPDX-License-Identifier: Apache-2.0
// lf_predicted_group LIGHTFIELD COUNT NEAR FAR [BLOCK]: encodes a group of COUNT neighbouring LF
// images of 8-bit RGB relative to each other (lf/pixels/codec/predicted_image.h), packed and by
// contexts, and each alone, packed, at equal thresholds. Compares bytes, errors and CPU times. The
// scene lies between the depths NEAR and FAR, in world units. BLOCK is the side of blocks in
// pixels. Writes CSV to stdout.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "lf/import/formats/open_light_field.h"
#include "lf/pixels/codec/predicted_image.h"
#include "lf/pixels/files/image_file.h"

namespace {

constexpr size_t kReferences = 3;  // for each LF image

double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct GroupImage {
  lf::PinholeCamera camera;
  lf::CodecPixels pixels;
  lf::DecodedPart decoded;
};

double DistanceOf(const GroupImage& a, const GroupImage& b) {
  return (a.camera.CentreWorld() - b.camera.CentreWorld()).norm();
}

// Reads the LF images nearest to the middle one.
std::vector<GroupImage> ReadGroup(const lf::LightField& light_field, size_t count) {
  std::vector<uint32_t> ids(light_field.size());
  for (uint32_t i = 0; i < ids.size(); ++i) ids[i] = i;
  lf::Vec3 mean = lf::Vec3::Zero();
  const auto centre = [&](uint32_t id) {
    return light_field.Camera(lf::LfImageId{id}).CentreWorld();
  };
  for (const uint32_t id : ids) mean += centre(id) / static_cast<double>(ids.size());
  std::stable_sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) {
    return (centre(a) - mean).lpNorm<Eigen::Infinity>() <
           (centre(b) - mean).lpNorm<Eigen::Infinity>();
  });
  ids.resize(std::min(ids.size(), count));
  std::vector<GroupImage> group;
  for (const uint32_t id : ids) {
    const auto image = lf::ReadImage(light_field.ImagePath(lf::LfImageId{id}));
    if (!image || !std::holds_alternative<lf::Image<uint8_t>>(*image)) std::exit(3);
    group.push_back(
        {light_field.Camera(lf::LfImageId{id}), std::get<lf::Image<uint8_t>>(*image), {}});
  }
  return group;
}

// Moves the LF images into the order in which they are encoded: each is the farthest from all
// before.
void OrderFarthestFirst(std::vector<GroupImage>* group) {
  for (size_t next = 1; next < group->size(); ++next) {
    const auto distance = [&](const GroupImage& image) {
      double least = INFINITY;
      for (size_t i = 0; i < next; ++i) least = std::min(least, DistanceOf(image, (*group)[i]));
      return least;
    };
    const auto begin = group->begin() + static_cast<ptrdiff_t>(next);
    std::iter_swap(begin, std::max_element(begin, group->end(), [&](const auto& a, const auto& b) {
                     return distance(a) < distance(b) * (1 - 1e-9);
                   }));
  }
}

// Returns the nearest LF images of each quadrant around one, among those before it.
std::vector<const GroupImage*> ReferencesOf(const std::vector<GroupImage>& group, size_t index) {
  std::array<const GroupImage*, 4> of_quadrant{};
  const GroupImage& target = group[index];
  for (size_t i = 0; i < index; ++i) {
    const lf::Vec3 apart =
        target.camera.cam_from_world * group[i].camera.CentreWorld();  // in axes of the target
    const double turn = std::atan2(apart.y(), apart.x()) / (2 * lf::kPi) + 1.125;
    const GroupImage*& nearest = of_quadrant[static_cast<size_t>(4 * turn) % 4];
    if (nearest == nullptr || DistanceOf(group[i], target) < DistanceOf(*nearest, target))
      nearest = &group[i];
  }
  std::vector<const GroupImage*> references;
  for (const GroupImage* image : of_quadrant)
    if (image != nullptr) references.push_back(image);
  std::stable_sort(references.begin(), references.end(), [&](const auto* a, const auto* b) {
    return DistanceOf(*a, target) < DistanceOf(*b, target);
  });
  if (references.size() > kReferences) references.resize(kReferences);
  return references;
}

double SquaredError(const lf::CodecPixels& a, const lf::CodecPixels& b) {
  const auto& left = std::get<lf::Image<uint8_t>>(a).pixels();
  const auto& right = std::get<lf::Image<uint8_t>>(b).pixels();
  double sum = 0;
  for (size_t i = 0; i < left.size(); ++i) sum += std::pow(left[i] - right[i], 2);
  return sum;
}

struct Cost {
  double bytes = 0, squared_error = 0, encode_s = 0, decode_s = 0;
};

// Runs `work` and adds its CPU time to `seconds`.
template <class Work>
void Timed(double* seconds, const Work& work) {
  const double begin = CpuSeconds();
  work();
  *seconds += CpuSeconds() - begin;
}

void EncodeAlone(const GroupImage& image, const lf::CodecSettings& settings,
                 lf::DecodedPart* decoded, Cost* cost) {
  std::string code;
  Timed(&cost->encode_s,
        [&] { code = lf::EncodeImage(image.pixels, lf::PixelLayout::kRgb, settings); });
  Timed(&cost->decode_s, [&] { LF_CHECK(lf::DecodeImage(code, decoded).has_value()); });
  cost->bytes += static_cast<double>(code.size());
  cost->squared_error += SquaredError(decoded->pixels, image.pixels);
}

lf::PinholeView ViewOf(const lf::PinholeCamera& camera) {
  return {camera.intrinsics.Matrix(), camera.cam_from_world};
}

void EncodeFromOthers(const std::vector<GroupImage>& group, size_t index,
                      const lf::CodecSettings& settings, const lf::InverseDepthRange& depths,
                      int block_px, lf::DecodedPart* decoded, Cost* cost) {
  const GroupImage& image = group[index];
  std::vector<lf::Reference> references;
  std::vector<const lf::DecodedPart*> parts;
  for (const GroupImage* other : ReferencesOf(group, index)) {
    const auto warp = lf::MakePlaneWarp(ViewOf(image.camera), ViewOf(other->camera), depths);
    LF_CHECK(warp.has_value());
    references.push_back({&other->decoded.pixels, *warp});
    parts.push_back(&other->decoded);
  }
  std::string code;
  Timed(&cost->encode_s, [&] {
    code =
        lf::EncodePredicted(image.pixels, lf::PixelLayout::kRgb, settings, references, {block_px});
  });
  const auto& pixels = std::get<lf::Image<uint8_t>>(image.pixels);
  Timed(&cost->decode_s, [&] {
    LF_CHECK(lf::DecodePredicted(code, parts, {0, 0, pixels.width(), pixels.height()}, decoded)
                 .has_value());
  });
  cost->bytes += static_cast<double>(code.size());
  cost->squared_error += SquaredError(decoded->pixels, image.pixels);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("usage: lf_predicted_group LIGHTFIELD COUNT NEAR FAR [BLOCK]\n", stderr);
    return 2;
  }
  const auto light_field = lf::OpenLightField(argv[1]);
  if (!light_field) {
    std::fprintf(stderr, "error: %s\n", light_field.error().message.c_str());
    return 3;
  }
  std::vector<GroupImage> group = ReadGroup(*light_field, std::strtoul(argv[2], nullptr, 10));
  OrderFarthestFirst(&group);
  const lf::InverseDepthRange depths = {1 / std::strtod(argv[4], nullptr),
                                        1 / std::strtod(argv[3], nullptr)};
  const int block_px = argc > 5 ? std::atoi(argv[5]) : lf::PredictionSettings().block_px;
  std::puts(
      "threshold,alone bytes,alone dB,alone encode s,alone decode s,"
      "predicted bytes,predicted dB,predicted encode s,predicted decode s,"
      "contexts bytes,contexts dB,contexts encode s,contexts decode s");
  for (const double threshold : {0.0, 3.0, 7.0}) {
    lf::CodecSettings settings;
    settings.threshold = threshold;
    if (threshold == 0) settings.profile = lf::CodecProfile::kLossless;
    // The first LF image is encoded alone in both ways, and left out of the times.
    Cost first, first_contexts, alone, predicted, contexts;
    lf::CodecSettings by_contexts = settings;
    by_contexts.entropy = lf::Entropy::kContexts;
    double values = 0;
    for (size_t i = 0; i < group.size(); ++i) {
      lf::DecodedPart decoded;
      EncodeAlone(group[i], settings, &decoded, i == 0 ? &first : &alone);
      values += static_cast<double>(std::get<lf::Image<uint8_t>>(decoded.pixels).pixels().size());
      if (i == 0) {
        EncodeAlone(group[i], by_contexts, &group[i].decoded, &first_contexts);
        continue;
      }
      // Both ways give equal pixels.
      EncodeFromOthers(group, i, by_contexts, depths, block_px, &group[i].decoded, &contexts);
      EncodeFromOthers(group, i, settings, depths, block_px, &group[i].decoded, &predicted);
    }
    std::printf("%g", threshold);
    const auto print = [&](const Cost& key, const Cost& cost) {
      std::printf(",%.0f,%.2f,%.3f,%.3f", key.bytes + cost.bytes,
                  10 * std::log10(255 * 255 * values / (key.squared_error + cost.squared_error)),
                  cost.encode_s, cost.decode_s);
    };
    print(first, alone);
    print(first, predicted);
    print(first_contexts, contexts);
    std::puts("");
  }
  return 0;
}
