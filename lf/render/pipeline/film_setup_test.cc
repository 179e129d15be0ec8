// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/film_setup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "lf/render/collect/test_noise_field.h"
#include "lf/render/hybrid/frame_pixels.h"
#include "lf/render/hybrid/rebinned_rays.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/settings/interpolation.h"
#include "lf/selection/reference_groups.h"

namespace lf {
namespace {

constexpr uint64_t kMiB = uint64_t{1} << 20;
constexpr uint64_t kImageBytes = uint64_t{testing::kWidth} * testing::kHeight * 6;  // 16 bits
constexpr uint64_t kEnough = 80, kLittle = 32;  // sizes of memory, in MiB

// How a store was used, also after it is gone.
struct Use {
  std::vector<uint64_t> limits;  // arguments of LimitReferences()
  size_t load_count = 0;
  size_t decode_count = 0;
};

// A store of LF images that are predicted within groups. It counts the decodings, and keeps the
// reference images that were used last.
class PredictedStore : public testing::NoiseStore {
 public:
  PredictedStore(const LightField& field, Use* use) : use_(use) {
    std::vector<CameraToGroup> cameras;
    for (const LfCamera& camera : field.cameras)
      cameras.push_back({camera.cam_from_world.Inverse().translation,
                         camera.cam_from_world.rotation.row(2).transpose(), 0});
    const ReferenceGroups groups = GroupCameras(cameras);
    references_.resize(field.size());
    is_reference_.resize(field.size(), false);
    for (size_t g = 0; g < groups.size(); ++g)
      for (const GroupMember& member : groups.Group(g))
        for (const uint8_t rank : member.References()) {
          const uint32_t id = groups.Group(g)[rank].id.value;
          references_[member.id.value].push_back(id);
          is_reference_[id] = true;
        }
  }
  uint64_t ReferenceBytes() const override {
    return kImageBytes *
           static_cast<uint64_t>(std::count(is_reference_.begin(), is_reference_.end(), true));
  }
  void LimitReferences(uint64_t most_bytes) override { use_->limits.push_back(most_bytes); }
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    {
      const std::lock_guard lock(mutex_);
      ++use_->load_count;
      Decode(id.value);
    }
    return NoiseStore::Load(id, rect, pixels);
  }

 private:
  void Decode(uint32_t id) const {
    if (const auto kept = std::find(kept_.begin(), kept_.end(), id); kept != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, kept);
      return;
    }
    for (const uint32_t reference : references_[id]) Decode(reference);
    ++use_->decode_count;
    if (!is_reference_[id]) return;
    kept_.push_front(id);
    if (kept_.size() * kImageBytes > use_->limits.back()) kept_.pop_back();
  }

  Use* const use_;
  std::vector<std::vector<uint32_t>> references_;
  std::vector<bool> is_reference_;
  mutable std::mutex mutex_;
  mutable std::list<uint32_t> kept_;
};

class FilmSetupTest : public ::testing::Test {
 protected:
  FilmSetupTest() {
    film_.reading.estimator = Estimator::kNearest;
    film_.lens_weights = LensWeights::kNone;
  }
  // Opens a film of three frames that see most of 576 LF images.
  Result<std::unique_ptr<FilmSetup>> Open(ImageOrder order, uint64_t memory_mib,
                                          bool is_predicted = true) {
    use_ = {};
    LightField field = testing::NoiseField(24);
    CameraPath path;
    path.cameras = testing::NoiseFrames();
    auto store = is_predicted ? std::make_unique<PredictedStore>(field, &use_)
                              : std::make_unique<testing::NoiseStore>();
    film_.order = order;
    WorkSettings work;
    work.memory_bytes = memory_mib * kMiB;
    Package package = PackageOfAll(std::move(field), std::move(path), 3,
                                   DependsOnFrames(order) ? ImageOrder::kShuffle : order);
    package.choices.order = order;
    return FilmSetup::Make(std::move(package), film_, work, {}, pool_, std::move(store));
  }
  // Renders the film. Returns the pictures of its frames.
  std::vector<Image<float>> Rendered(const FilmSetup& setup) {
    FilmRenderer renderer(setup, setup.frames());
    EXPECT_TRUE(renderer.Begin());
    for (Result<bool> is_going_on = true; is_going_on && *is_going_on;)
      is_going_on = renderer.Step();
    std::vector<Image<float>> pictures;
    for (size_t f = 0; f < renderer.frame_count(); ++f)
      pictures.push_back(renderer.Develop(f)->picture.rgb);
    return pictures;
  }
  double DecodingsPerImage() const {
    return static_cast<double>(use_.decode_count) / static_cast<double>(use_.load_count);
  }

  FilmSettings film_;
  Use use_;
  ThreadPool pool_{2};
};

TEST_F(FilmSetupTest, LfImagesThatAreNotPredictedChangeNoPlan) {
  const auto alone = Open(ImageOrder::kSpread, kLittle, false).value();
  EXPECT_EQ(alone->plan().reference_bytes, 0u);
  EXPECT_EQ(alone->ReferenceNote(), "");
  const auto predicted = Open(ImageOrder::kSpread, kLittle).value();
  EXPECT_GT(predicted->plan().reference_bytes, 0u);
  EXPECT_LE(predicted->plan().total_bytes, kLittle * kMiB);
}

TEST_F(FilmSetupTest, WithEnoughMemoryEachImageIsDecodedOnce) {
  const auto setup = Open(ImageOrder::kSpread, kEnough).value();
  EXPECT_EQ(use_.limits, std::vector<uint64_t>{setup->store().ReferenceBytes()});
  EXPECT_EQ(setup->ReferenceNote(), "");
  Rendered(*setup);
  // Some reference images are seen by no frame.
  EXPECT_GE(DecodingsPerImage(), 1);
  EXPECT_LT(DecodingsPerImage(), 1.15);
  EXPECT_LE(use_.decode_count, 576u);
}

TEST_F(FilmSetupTest, WithLittleMemoryGroupsAreDecodedOnceAndHaveTheSameFrames) {
  const auto spread = Open(ImageOrder::kSpread, kLittle).value();
  const std::vector<Image<float>> frames = Rendered(*spread);
  EXPECT_GT(DecodingsPerImage(), 2.5);
  EXPECT_LT(use_.limits.back(), spread->store().ReferenceBytes() / 2);
  const auto groups = Open(ImageOrder::kGroups, kLittle).value();
  EXPECT_EQ(groups->ReferenceNote(), "");
  EXPECT_LT(use_.limits.back(), spread->store().ReferenceBytes() / 2);
  const std::vector<Image<float>> same = Rendered(*groups);
  EXPECT_LT(DecodingsPerImage(), 1.1);
  ASSERT_EQ(frames.size(), same.size());
  for (size_t f = 0; f < frames.size(); ++f) EXPECT_EQ(frames[f].pixels(), same[f].pixels()) << f;
}

TEST_F(FilmSetupTest, TheNoteNamesMemoryThatSuffices) {
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kHybrid, RenderMode::kRebin}) {
    film_.mode = mode;
    if (film_.Rebins()) film_.rebin.max_cells = RebinSettings::kLeastCells;
    const uint64_t rays_mib = KeepsCells(film_)
                                  ? RebinnedRays::BytesOf(RebinSettings::kLeastCells) / kMiB + 1
                              : KeepsPixels(film_) ? 13
                                                   : 0;
    const auto little = Open(ImageOrder::kSpread, kLittle + rays_mib);
    ASSERT_TRUE(little) << little.error().message;
    const std::string note = (*little)->ReferenceNote();
    EXPECT_NE(note.find("decoded several times"), std::string::npos) << note;
    EXPECT_NE(note.find("{order groups}"), std::string::npos) << note;
    const size_t at = note.find("give {memory ");
    ASSERT_NE(at, std::string::npos) << note;
    const uint64_t mib = std::stoul(note.substr(at + 13));
    EXPECT_EQ(Open(ImageOrder::kSpread, mib).value()->ReferenceNote(), "") << NameOf(mode);
    EXPECT_NE(Open(ImageOrder::kSpread, mib - 2).value()->ReferenceNote(), "") << NameOf(mode);
  }
  film_.mode = RenderMode::kCollect;
  film_.rebin.max_cells = 0;
  film_.max_image_count = 20;
  const std::string of_some = Open(ImageOrder::kSpread, kLittle).value()->ReferenceNote();
  EXPECT_NE(of_some, "");
  EXPECT_EQ(of_some.find("{order groups}"), std::string::npos) << of_some;
}

// A package has some of the LF images of a large store.
TEST_F(FilmSetupTest, ReferenceImagesOfOtherPackagesGetNoRoom) {
  class LargeStore : public testing::NoiseStore {
    uint64_t ReferenceBytes() const override { return uint64_t{1} << 50; }
  };
  const LightField field = testing::NoiseField(24);
  const ReferenceNeed need = ReferenceNeedOf(LargeStore(), field, false);
  EXPECT_EQ(need.all_bytes, 576 * kImageBytes);
  EXPECT_EQ(ReferenceNeedOf(testing::NoiseStore(), field, false).all_bytes, 0u);
}

TEST_F(FilmSetupTest, TooLittleMemoryIsRefused) {
  const auto refused = Open(ImageOrder::kSpread, 26);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kOutput);
  EXPECT_NE(refused.error().message.find("reference images"), std::string::npos)
      << refused.error().message;
}

// The first LF images of a frame in these orders are neighbours, and no sample of its lens.
TEST_F(FilmSetupTest, RulesThatNeedASampleRefuseOrdersOfNeighbours) {
  const auto is_refused = [this](ImageOrder order) {
    const auto setup = Open(order, kEnough, false);
    if (setup) return false;
    EXPECT_EQ(setup.error().kind, ErrorKind::kUsage);
    EXPECT_NE(setup.error().message.find("neighbours"), std::string::npos) << setup.error().message;
    return true;
  };
  const auto refusing = [&] {
    std::vector<ImageOrder> orders;
    for (const ImageOrder order : {ImageOrder::kSpread, ImageOrder::kShuffle, ImageOrder::kArea,
                                   ImageOrder::kRoundRobin, ImageOrder::kGroups})
      if (is_refused(order)) orders.push_back(order);
    return orders;
  };
  using Orders = std::vector<ImageOrder>;
  const Orders none, both = {ImageOrder::kArea, ImageOrder::kGroups};
  EXPECT_EQ(refusing(), none);
  film_.stop_when.noise = 0.1;
  EXPECT_EQ(refusing(), both);
  film_.stop_when = {};
  film_.require.noise = 0.1;  // of the finished frame: all LF images are its sample
  EXPECT_EQ(refusing(), none);
  film_.max_image_count = 20;
  EXPECT_EQ(refusing(), both);
  film_.require = {};
  EXPECT_EQ(refusing(), none);
  film_.max_image_count.reset();
  film_.stop_when.samples = 1;
  EXPECT_EQ(refusing(), Orders{ImageOrder::kGroups});
}

}  // namespace
}  // namespace lf
