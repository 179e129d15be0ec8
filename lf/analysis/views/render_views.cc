// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/views/render_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <utility>

#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/analysis/rectified/rectified_view.h"
#include "lf/camera/path/camera_path.h"
#include "lf/film/develop/develop.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

constexpr float kNoLight = std::numeric_limits<float>::quiet_NaN();

// Returns the pinhole of a view as a camera that films.
RenderCamera FilmCamera(const PinholeCamera& view, double focus_distance_w, double unit_m) {
  constexpr double kSensorWidth_mm = 36;  // any width gives the same picture
  RenderCamera camera;
  camera.pinhole = view;
  camera.unit_m = unit_m;
  camera.sensor_width_w = kSensorWidth_mm * 1e-3 / unit_m;
  camera.focal_length_w = camera.sensor_width_w * view.intrinsics.fx_px / view.intrinsics.width_px;
  camera.focus_distance_w = focus_distance_w;
  camera.focus_plane = FocusPlane(view, focus_distance_w, {});
  return camera;
}

// Returns the picture with NaN where no ray was collected. There, the picture is black, or filled
// with light from beside, which nothing recorded in this direction.
Image<float> WithoutFilled(DevelopedFrame picture) {
  Image<float> light = std::move(picture.rgb);
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x)
      if (picture.coverage.at(x, y) == 0) std::fill_n(&light.at(x, y, 0), 3, kNoLight);
  return light;
}

class ViewMaker {
 public:
  ViewMaker(const LightField& light_field, const ViewGrid& grid, const ViewOptions& options,
            ThreadPool& pool, const ViewSink& sink,
            const std::function<void(size_t, size_t)>& progress)
      : light_field_(light_field),
        grid_(grid),
        options_(options),
        pool_(pool),
        sink_(sink),
        progress_(progress) {}

  Result<ViewsReport> Make() {
    std::vector<size_t> recorded, between;
    for (size_t view = 0; view < grid_.size(); ++view)
      (grid_.RecordedAt(view) ? recorded : between).push_back(view);
    report_.recorded_count = recorded.size();
    report_.rendered_count = between.size();
    report_.asked_count = recorded.size();
    // The focus is found first, because an error after many views would cost their time.
    if (!between.empty()) LF_RETURN_IF_ERROR(FindFocus());
    LF_RETURN_IF_ERROR(MakeRecorded(recorded));
    if (!between.empty()) LF_RETURN_IF_ERROR(MakeRendered(between));
    return std::move(report_);
  }

 private:
  bool IsStopped() const { return options_.stop != nullptr && *options_.stop; }
  Error Interrupted() const {
    return {ErrorKind::kInterrupted,
            fmt::format("interrupted after {} of {} views", done_, grid_.size())};
  }

  // Must be called by one thread at a time.
  Result<void> Give(size_t view, const Image<float>& light) {
    LF_RETURN_IF_ERROR(sink_(view, light));
    if (progress_) progress_(++done_, grid_.size());
    return {};
  }

  Result<void> FindFocus() {
    report_.focus_distance_w = options_.focus_distance_w;
    if (report_.focus_distance_w) return {};
    const size_t middle = grid_.size() / 2;
    LF_ASSIGN_OR_RETURN(
        const DepthRange range,
        FindFocusRange(light_field_, FilmCamera(grid_.Camera(middle), 1, light_field_.unit_m),
                       pool_, ", by {focus_distance}"));
    report_.focus_distance_w = EvenFocusDistances(range, 1).front();
    return {};
  }

  Result<void> MakeRecorded(const std::vector<size_t>& views) {
    LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> store,
                        OpenStore(light_field_, Mosaics::kToRgb));
    std::mutex mutex;
    std::optional<Error> failure;
    pool_.ForEach(views.size(), [&](size_t i) {
      if (IsStopped()) return;
      const LfImageId id = *grid_.RecordedAt(views[i]);
      const PinholeCamera view = grid_.Camera(views[i]);
      const RectifiedRays rays(light_field_.Camera(id), view.cam_from_world.rotation,
                               view.intrinsics);
      const PixelRect whole = {0, 0, grid_.width_px(), grid_.height_px()};
      Result<Image<float>> light = LoadRectified(light_field_, *store, id, rays, whole);
      const std::lock_guard lock(mutex);
      if (failure) return;
      report_.copied_count += rays.IsSame() ? 1 : 0;
      if (!light) {
        // If the machine lacks something, the LF image may be intact: no view is made of it.
        if (options_.strict || light.error().kind == ErrorKind::kOutput) failure = light.error();
        if (failure) return;
        report_.missing.push_back(light.error().message);
        light = Image<float>(whole.width(), whole.height(), 3, kNoLight);
      }
      if (const Result<void> given = Give(views[i], *light); !given) failure = given.error();
    });
    if (IsStopped()) return Interrupted();
    if (failure) return *failure;
    if (!views.empty() && report_.missing.size() == views.size())
      return InputError(report_.missing.front());
    return {};
  }

  Result<void> MakeRendered(const std::vector<size_t>& views) {
    CameraPath path;
    path.unit_m = light_field_.unit_m;
    for (const size_t view : views)
      path.cameras.push_back(
          FilmCamera(grid_.Camera(view), *report_.focus_distance_w, light_field_.unit_m));
    WorkSettings work;
    work.memory_bytes = options_.memory_bytes;
    work.strict = options_.strict;
    work.stop = options_.stop;
    work.interrupted = options_.interrupted;
    LF_ASSIGN_OR_RETURN(const std::unique_ptr<FilmSetup> setup,
                        FilmSetup::Make(PackageOfAll(light_field_, std::move(path), 0),
                                        FilmSettings(), work, {}, pool_));
    const std::vector<FrameId>& frames = setup->frames();
    const size_t per_pass = setup->plan().frames_per_pass;
    for (size_t begin = 0; begin < frames.size(); begin += per_pass) {
      const std::span<const FrameId> of_pass =
          std::span(frames).subspan(begin, std::min(per_pass, frames.size() - begin));
      LF_RETURN_IF_ERROR(RenderPass(*setup, of_pass, views));
    }
    return {};
  }

  Result<void> RenderPass(const FilmSetup& setup, std::span<const FrameId> frames,
                          const std::vector<size_t>& views) {
    FilmRenderer renderer(setup, frames);
    LF_RETURN_IF_ERROR(renderer.Begin());
    for (bool is_going_on = true; is_going_on;) {
      const Result<bool> step = renderer.Step();
      if (!step && step.error().kind == ErrorKind::kInterrupted) return Interrupted();
      if (!step) return step.error();
      is_going_on = *step;
    }
    LF_RETURN_IF_ERROR(renderer.CheckNotAllBroken());
    report_.asked_count = std::max(report_.asked_count, renderer.images().size());
    for (const SkippedImage& skipped : renderer.skipped())
      if (std::find(report_.missing.begin(), report_.missing.end(), skipped.reason) ==
          report_.missing.end())
        report_.missing.push_back(skipped.reason);
    for (size_t f = 0; f < renderer.frame_count(); ++f) {
      if (IsStopped()) return Interrupted();
      const size_t view = views[renderer.id(f).value - 1];
      LF_ASSIGN_OR_RETURN(RenderedFrame frame, renderer.Develop(f));
      LF_RETURN_IF_ERROR(Give(view, WithoutFilled(std::move(frame.picture))));
      renderer.Release(f);
    }
    return {};
  }

  const LightField& light_field_;
  const ViewGrid& grid_;
  const ViewOptions& options_;
  ThreadPool& pool_;
  const ViewSink& sink_;
  const std::function<void(size_t, size_t)>& progress_;
  ViewsReport report_;
  size_t done_ = 0;
};

}  // namespace

Result<void> CheckForViews(const LightField& light_field) {
  if (!light_field.encoding.HasOpacity()) return {};
  return UsageError(
      "the LF images are transparent in front of nothing (background \"none\"), and views have no "
      "opacity: state another background, such as black");
}

Result<ViewsReport> MakeViews(const LightField& light_field, const ViewGrid& grid,
                              const ViewOptions& options, ThreadPool& pool, const ViewSink& sink,
                              const std::function<void(size_t done, size_t total)>& progress) {
  LF_RETURN_IF_ERROR(CheckForViews(light_field));
  return ViewMaker(light_field, grid, options, pool, sink, progress).Make();
}

}  // namespace lf
