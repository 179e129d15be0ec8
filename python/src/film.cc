// SPDX-License-Identifier: Apache-2.0
#include "python/src/film.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/cameras.h"
#include "python/src/errors.h"
#include "python/src/frames.h"
#include "python/src/light_field.h"
#include "python/src/setting_words.h"
#include "python/src/work.h"

#include "lf/core/log.h"
#include "lf/core/quantities.h"
#include "lf/core/spelling.h"
#include "lf/core/version.h"
#include "lf/pixels/files/write_png.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/render/pipeline/frame_range.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/pipeline/setup_inputs.h"

namespace lf::python {
namespace {

namespace py = pybind11;

class Film {
 public:
  Film(const OpenedField& field, std::vector<RenderCamera> cameras, double fps,
       uint32_t first_frame, ShutterWords shutter, const std::vector<uint32_t>& frames,
       const SettingWords& words, const std::string& memory, bool strict, int threads)
      : pool_(PoolOf(threads)) {
    RenderOptions options;
    options.film = Take(FilmSettingsOf(words));
    options.work.memory_bytes = Take(ParseByteSize(memory, "memory"));
    options.work.strict = strict;
    options.work.interrupted = &signals_.interrupted;
    options.work.stop = &signals_.stop;
    std::vector<FrameId> ids;
    for (const uint32_t frame : frames) ids.push_back(FrameId{frame});
    Run([&] {
      Package package = Take(PackageOfFilm(field.light_field,
                                           PathOf(std::move(cameras), fps, first_frame,
                                                  field.light_field.unit_m, std::move(shutter)),
                                           options, pool_));
      setup_ = Take(FilmSetup::Make(std::move(package), options.film, options.work, ids, pool_));
      if (const std::string note = setup_->ReferenceNote(); !note.empty()) LogInfo("{}", note);
      Take(setup_->PlanSlabs());
      inputs_ = Take(InputsOfRays(*setup_));
    });
  }

  // Returns the frames of each pass.
  std::vector<std::vector<uint32_t>> Passes() const {
    std::vector<std::vector<uint32_t>> passes;
    const size_t most = setup_->plan().frames_per_pass;
    for (const FrameId frame : setup_->frames()) {
      if (passes.empty() || passes.back().size() == most) passes.emplace_back();
      passes.back().push_back(frame.value);
    }
    return passes;
  }

  void Begin(const std::vector<uint32_t>& frames) {
    renderer_.reset();
    std::vector<FrameId> ids;
    for (const uint32_t frame : frames) ids.push_back(FrameId{frame});
    Run([&] {
      auto renderer = std::make_unique<FilmRenderer>(*setup_, ids);
      Take(renderer->Begin());
      renderer_ = std::move(renderer);
    });
  }

  bool Step() {
    return CallWithoutGil([&] { return Take(renderer().Step()); }, &signals_);
  }

  std::pair<size_t, size_t> Progress() {
    return {renderer().progress().image_count, renderer().images().size()};
  }

  std::vector<size_t> Left() {
    std::vector<size_t> left;
    for (size_t f = 0; f < renderer().frame_count(); ++f)
      if (!renderer().IsReleased(f)) left.push_back(f);
    return left;
  }

  Frame Develop(size_t f) {
    Check(f);
    return CallWithoutGil(
        [&] {
          const std::optional<Completion> completion = Take(renderer().Complete(f, false));
          const auto is_interrupted = [&] { return signals_.stop.load(); };
          RenderedFrame rendered = renderer().Develop(f, completion, true, is_interrupted);
          PlateNotes notes = renderer().NotesOf(f);
          notes.version = Version();
          const bool keeps_opacity = renderer().PictureOf(f).has_opacity();
          return MakeFrame(std::move(rendered.picture), std::move(notes), keeps_opacity);
        },
        &signals_);
  }

  std::unique_ptr<Plate> PlateOf(size_t f) {
    Check(f);
    const bool keeps_pixels = renderer().pixels() != nullptr;
    if (!setup_->film().Collects() && !keeps_pixels)
      throw Failure(
          UsageError("mode=\"rebin\" with interpolation=\"cells\": its frames have no plates; use "
                     "interpolation=\"pixels\" or mode=\"collect\""));
    auto plate = std::make_unique<Plate>();
    if (keeps_pixels) CallWithoutGil([&] { return Take(renderer().Complete(f, true)); }, &signals_);
    if (const PlateGaps* const gaps = renderer().GapsOf(f)) plate->gaps = CopyOf(*gaps);
    plate->sums = CopyOf(renderer().PictureOf(f));
    plate->notes = renderer().NotesOf(f);
    renderer().ForgetPicture(f);
    plate->notes.version = Version();
    plate->inputs = inputs_;
    for (auto& entry : InputsOfFrame(setup_->path(), plate->notes.frame))
      plate->inputs.push_back(std::move(entry));
    return plate;
  }

  // Returns the LF images that a frame reads, by ascending ranks, as numbers [n], pixel rectangles
  // [n][4] and numbers of rays [n], and the numbers of its neighbours.
  py::tuple Needs(uint32_t frame) {
    const FrameNeeds needs = CallWithoutGil(
        [&] {
          return NeedsOf(setup_->index(), setup_->path(), FrameId{frame}, setup_->Needs(), pool_);
        },
        &signals_);
    const auto count = static_cast<py::ssize_t>(needs.images.size());
    py::array_t<uint32_t> ids(count), neighbours(static_cast<py::ssize_t>(needs.neighbours.size()));
    py::array_t<int> rects({count, py::ssize_t{4}});
    py::array_t<uint64_t> rays(count);
    for (py::ssize_t i = 0; i < count; ++i) {
      const FrameNeeds::Image& image = needs.images[static_cast<size_t>(i)];
      ids.mutable_at(i) = image.id.value;
      rays.mutable_at(i) = image.ray_count;
      const int sides[] = {image.rect.x_begin, image.rect.y_begin, image.rect.x_end,
                           image.rect.y_end};
      std::copy_n(sides, 4, rects.mutable_data(i, 0));
    }
    for (size_t i = 0; i < needs.neighbours.size(); ++i)
      neighbours.mutable_at(static_cast<py::ssize_t>(i)) = needs.neighbours[i].value;
    return py::make_tuple(ids, rects, rays, neighbours);
  }

  void Release(size_t f) {
    Check(f);
    renderer().Release(f);
  }
  void CheckAnyContributes() { Take(renderer().CheckAnyContributes()); }
  void CheckNotAllBroken() { Take(renderer().CheckNotAllBroken()); }

  py::list Skipped() {
    py::list skipped;
    for (const SkippedImage& image : renderer().skipped())
      skipped.append(py::make_tuple(TextOf(image.name), TextOf(Spelled(image.reason))));
    return skipped;
  }

  FilmRenderer& renderer() {
    if (!renderer_) throw Failure(UsageError("no pass of the film was begun"));
    return *renderer_;
  }

 private:
  void Run(const std::function<void()>& work) { RunWithoutGil(work, &signals_); }
  void Check(size_t f) {
    if (f >= renderer().frame_count() || renderer().IsReleased(f))
      throw py::index_error(fmt::format("frame {} of {}: does not exist, or was stopped", f,
                                        renderer().frame_count()));
  }

  WorkSignals signals_;
  ThreadPool& pool_;
  std::unique_ptr<FilmSetup> setup_;
  RunInputs inputs_;  // inputs of the rays
  std::unique_ptr<FilmRenderer> renderer_;
};

std::vector<uint32_t> ParseFrames(const std::string& text, uint32_t first, size_t count) {
  std::vector<uint32_t> numbers;
  for (const FrameId frame : Take(ParseFrameRange(text, {first, count}, "frames")))
    numbers.push_back(frame.value);
  return numbers;
}

// Returns a picture [height][width][3] as the bytes of a PNG file.
py::bytes PngOf(const py::array_t<uint8_t, py::array::c_style | py::array::forcecast>& picture) {
  const auto width = static_cast<int>(picture.shape(1)),
             height = static_cast<int>(picture.shape(0));
  const ImageView<const uint8_t> view{picture.data(), width, height, 3,
                                      static_cast<size_t>(width) * 3};
  return CallWithoutGil([&] { return Take(EncodePng(view)); });
}

}  // namespace

void AddFilm(py::module_& module) {
  module.def("parse_frames", &ParseFrames);
  module.def("encode_png", &PngOf);
  py::class_<Film>(module, "Film")
      .def(py::init<const OpenedField&, std::vector<RenderCamera>, double, uint32_t, ShutterWords,
                    const std::vector<uint32_t>&, const SettingWords&, const std::string&, bool,
                    int>())
      .def("passes", &Film::Passes)
      .def("needs", &Film::Needs)
      .def("begin", &Film::Begin)
      .def("step", &Film::Step)
      .def("progress", &Film::Progress)
      .def("number", [](Film& film, size_t f) { return film.renderer().id(f).value; })
      .def("stopped",
           [](Film& film) {
             return CallWithoutGil([&] { return film.renderer().StoppedFrames(); });
           })
      .def("left", &Film::Left)
      .def("develop", &Film::Develop)
      .def("plate", &Film::PlateOf)
      .def("release", &Film::Release)
      .def("check_any_contributes", &Film::CheckAnyContributes)
      .def("check_not_all_broken", &Film::CheckNotAllBroken)
      .def("skipped", &Film::Skipped);
}

}  // namespace lf::python
