#include "python/src/film.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "python/src/arrays.h"
#include "python/src/errors.h"
#include "python/src/film_words.h"
#include "python/src/light_field.h"
#include "python/src/work.h"
#include "tools/common/byte_size.h"

#include "lf/film/develop/frame_file.h"
#include "lf/film/plate/plate_file.h"
#include "lf/pixels/files/write_png.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/render/pipeline/film_renderer.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/render/pipeline/frame_metadata.h"
#include "lf/render/pipeline/frame_range.h"
#include "lf/render/pipeline/render.h"

namespace lf::python {
namespace {

namespace py = pybind11;

// A finished or unfinished frame: its picture, and the notes that its file gets.
struct Frame {
  DevelopedFrame picture;
  PlateNotes notes;
};

// A plate with the notes from which it can be developed.
struct Plate {
  SensorPlate sums{0, 0};
  PlateNotes notes;
};

class Film {
 public:
  Film(const OpenedField& field, std::vector<RenderCamera> cameras, double fps,
       const std::vector<uint32_t>& frames, const FilmWords& words, const std::string& memory,
       bool strict, int threads)
      : pool_(PoolOf(threads)) {
    RenderOptions options;
    options.film = Take(FilmOptionsOf(words));
    options.work.memory_bytes = Take(ParseByteSize(memory, "memory"));
    options.work.strict = strict;
    options.work.interrupted = &signals_.interrupted;
    options.work.stop = &signals_.stop;
    const ImageOrder order = Take(OrderOf(words));
    std::vector<FrameId> ids;
    for (const uint32_t frame : frames) ids.push_back(FrameId{frame});
    Run([&] {
      CameraPath path{fps, field.light_field.unit_m, std::move(cameras)};
      Package package = PackageOfAll(field.light_field, std::move(path), words.seed);
      if (words.max_angle_deg)
        package.choices.max_angle_rad = RadiansFromDegrees(*words.max_angle_deg);
      Take(CheckRenderOptions(package, options));
      Take(PutInOrder(order, options, pool_, &package));
      setup_ = Take(FilmSetup::Make(std::move(package), options.film, options.work, ids, pool_));
      Take(setup_->PlanSlabs());
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
          const std::optional<Completion> completion = renderer().Complete(f);
          const auto is_interrupted = [&] { return signals_.stop.load(); };
          RenderedFrame rendered = renderer().Develop(f, completion, true, is_interrupted);
          PlateNotes notes = renderer().NotesOf(f);
          notes.version = LF_VERSION;
          return Frame{std::move(rendered.picture), std::move(notes)};
        },
        &signals_);
  }

  std::unique_ptr<Plate> PlateOf(size_t f) {
    Check(f);
    if (!setup_->film().Collects())
      throw Failure(UsageError("mode=\"rebin\": its frames have no plates"));
    auto plate = std::make_unique<Plate>();
    const SensorPlate& sums = renderer().plate(f);
    plate->sums = SensorPlate(sums.width(), sums.height(), sums.kind());
    plate->sums.Merge(sums);
    plate->notes = renderer().NotesOf(f);
    plate->notes.version = LF_VERSION;
    return plate;
  }

  // Returns the LF images that a frame reads, by ascending ranks, as numbers [n], pixel rectangles
  // [n][4] and numbers of rays [n], and the numbers of its neighbours.
  py::tuple Needs(uint32_t frame) {
    const FrameNeeds needs = CallWithoutGil(
        [&] {
          return NeedsOf(setup_->index(), setup_->path().Camera(FrameId{frame}), setup_->Needs(),
                         pool_);
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
      skipped.append(py::make_tuple(TextOf(image.name), TextOf(image.reason)));
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
  std::unique_ptr<FilmRenderer> renderer_;
};

// Returns an array that shares the memory of an image, which the object `self` holds; None if the
// image is empty. The array has the shape [height][width] if is_flat is true, otherwise
// [height][width][channels].
template <class T>
py::object Show(Image<T>& image, const py::object& self, bool is_flat = true) {
  if (image.empty()) return py::none();
  std::vector<py::ssize_t> shape = {image.height(), image.width()};
  if (!is_flat) shape.push_back(image.channels());
  return py::array_t<T>(shape, image.pixels().data(), self);
}

ImageMetadata MetadataOf(const PlateNotes& notes) {
  return FrameMetadata(notes.frame, notes.camera, notes.rays, notes.estimator, notes.fps,
                       notes.version);
}

void SaveFrame(const Frame& frame, const std::string& path, const std::string& format) {
  const std::optional<FrameFormat> known = ParseFrameFormat(format);
  if (!known)
    throw Failure(
        UsageError(fmt::format("format=\"{}\": expected exr, exr-float, png or png16", format)));
  RunWithoutGil([&] {
    Take(WriteFrame(path, frame.picture, *known,
                    FileMetadata(frame.notes, *known, ColourSpace::kRec709)));
  });
}

Frame DevelopPlate(const Plate& plate, int threads) {
  ThreadPool& pool = PoolOf(threads);
  return CallWithoutGil([&] {
    RenderedFrame rendered = DevelopFrame(plate.notes, plate.sums, nullptr, true, pool, {});
    return Frame{std::move(rendered.picture), plate.notes};
  });
}

std::unique_ptr<Plate> LoadPlate(const std::string& path) {
  auto plate = std::make_unique<Plate>();
  RunWithoutGil([&] {
    PlateReader reader = Take(PlateReader::Open(path));
    plate->sums = SensorPlate(reader.width(), reader.height(), reader.kind());
    plate->notes = Take(PlateNotesOf(reader.entries(), reader.width(), reader.height(), path));
    Take(reader.AddTo(&plate->sums));
  });
  return plate;
}

void SavePlate(const Plate& plate, const std::string& path) {
  ThreadPool& pool = PoolOf(0);
  RunWithoutGil([&] { Take(WritePlate(path, TextOf(plate.notes), plate.sums, pool)); });
}

// Returns the sum of two plates of the same camera, such as those of two parts of a light field.
std::unique_ptr<Plate> AddPlates(const Plate& a, const Plate& b) {
  if (a.sums.width() != b.sums.width() || a.sums.height() != b.sums.height() ||
      a.sums.kind() != b.sums.kind())
    throw Failure(UsageError(fmt::format(
        "plates of {} x {} and {} x {} elements, with {} and {} channels, cannot be added",
        a.sums.width(), a.sums.height(), b.sums.width(), b.sums.height(), a.sums.channels(),
        b.sums.channels())));
  auto sum = std::make_unique<Plate>();
  sum->sums = SensorPlate(a.sums.width(), a.sums.height(), a.sums.kind());
  sum->sums.Merge(a.sums);
  sum->sums.Merge(b.sums);
  sum->notes = a.notes;
  sum->notes.rays += b.notes.rays;
  // The effective number of LF images of the sum does not follow from those of the parts.
  sum->notes.weighed.reset();
  return sum;
}

// Returns [height][width][channels], sums or counts.
py::array_t<uint64_t> WordsOf(const Plate& plate, uint64_t ElementSum::*member) {
  const SensorPlate& sums = plate.sums;
  py::array_t<uint64_t> out(
      {py::ssize_t{sums.height()}, py::ssize_t{sums.width()}, py::ssize_t{sums.channels()}});
  uint64_t* to = out.mutable_data();
  for (size_t i = 0; i < sums.words().size(); ++i) *to++ = sums.AtWord(i).*member;
  return out;
}

std::vector<uint32_t> ParseFrames(const std::string& text, size_t frame_count) {
  std::vector<uint32_t> numbers;
  for (const FrameId frame : Take(ParseFrameRange(text, frame_count, "frames")))
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

void AddWords(py::module_& module) {
  py::class_<FilmWords>(module, "FilmWords")
      .def(py::init<>())
      .def_readwrite("mode", &FilmWords::mode)
      .def_readwrite("estimator", &FilmWords::estimator)
      .def_readwrite("filter", &FilmWords::filter)
      .def_readwrite("lens_weights", &FilmWords::lens_weights)
      .def_readwrite("lf_pixels", &FilmWords::lf_pixels)
      .def_readwrite("order", &FilmWords::order)
      .def_readwrite("stop_when", &FilmWords::stop_when)
      .def_readwrite("max_images", &FilmWords::max_images)
      .def_readwrite("max_angle_deg", &FilmWords::max_angle_deg)
      .def_readwrite("seed", &FilmWords::seed)
      .def_readwrite("smooth_below", &FilmWords::smooth_below)
      .def_readwrite("fill", &FilmWords::fill)
      .def_readwrite("guard", &FilmWords::guard);
}

}  // namespace

void AddFilm(py::module_& module) {
  AddWords(module);
  module.def("parse_frames", &ParseFrames);
  module.def("encode_png", &PngOf);
  py::class_<Frame>(module, "Frame")
      .def_property_readonly("number", [](const Frame& f) { return f.notes.frame.value; })
      .def_property_readonly("camera", [](const Frame& f) { return f.notes.camera; })
      .def_property_readonly(
          "rgb",
          [](const py::object& self) { return Show(self.cast<Frame&>().picture.rgb, self, false); })
      .def_property_readonly("count",
                             [](const py::object& self) {
                               return Show(self.cast<Frame&>().picture.ray_count, self, false);
                             })
      .def_property_readonly(
          "coverage",
          [](const py::object& self) { return Show(self.cast<Frame&>().picture.coverage, self); })
      .def_property_readonly(
          "opacity",
          [](const py::object& self) { return Show(self.cast<Frame&>().picture.opacity, self); })
      .def_property_readonly("effective",
                             [](const py::object& self) {
                               return Show(self.cast<Frame&>().picture.effective_count, self);
                             })
      .def_property_readonly("interpolated",
                             [](const py::object& self) {
                               return Show(self.cast<Frame&>().picture.interpolated, self);
                             })
      .def_property_readonly(
          "densified",
          [](const py::object& self) { return Show(self.cast<Frame&>().picture.densified, self); })
      .def_property_readonly("image_count", [](const Frame& f) { return f.notes.rays.image_count; })
      .def_property_readonly("metadata", [](const Frame& f) { return MetadataOf(f.notes); })
      .def("save", &SaveFrame);
  py::class_<Plate>(module, "Plate")
      .def_static("load", &LoadPlate)
      .def_property_readonly("sums",
                             [](const Plate& plate) { return WordsOf(plate, &ElementSum::sum); })
      .def_property_readonly("counts",
                             [](const Plate& plate) { return WordsOf(plate, &ElementSum::count); })
      .def("save", &SavePlate)
      .def("__add__", &AddPlates)
      .def("__eq__", [](const Plate& a, const Plate& b) { return a.sums == b.sums; })
      .def("develop", &DevelopPlate);
  py::class_<Film>(module, "Film")
      .def(
          py::init<const OpenedField&, std::vector<RenderCamera>, double,
                   const std::vector<uint32_t>&, const FilmWords&, const std::string&, bool, int>())
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
