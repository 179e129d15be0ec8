// SPDX-License-Identifier: Apache-2.0
#include "python/src/frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "python/src/errors.h"
#include "python/src/work.h"

#include "lf/film/develop/completion.h"
#include "lf/film/develop/frame_file.h"
#include "lf/film/plate/plate_file.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/render/pipeline/frame_metadata.h"

namespace lf::python {
namespace {

namespace py = pybind11;

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

// Adds the entries that a frame has besides its notes.
ImageMetadata WithMore(ImageMetadata metadata, const Frame& frame) {
  metadata.insert(metadata.end(), frame.more_metadata.begin(), frame.more_metadata.end());
  return metadata;
}

ImageMetadata MetadataOf(const Frame& frame) {
  const PlateNotes& notes = frame.notes;
  return WithMore(FrameMetadata(notes.frame, notes.camera, notes.rays, notes.estimator, notes.fps,
                                notes.version, notes.shutter),
                  frame);
}

// Returns the value that a text names. Throws a Failure (kUsage), which names what was expected.
template <class Value>
Value Named(const char* argument, const std::string& text, const std::optional<Value>& value,
            const char* expected) {
  if (!value)
    throw Failure(UsageError(fmt::format("{}=\"{}\": expected {}", argument, text, expected)));
  return *value;
}

// Returns the picture with the alpha and the primaries that a file gets.
DevelopedFrame PictureFor(const Frame& frame, ColourSpace colours, bool alpha) {
  DevelopedFrame picture = frame.picture;
  if (alpha && picture.opacity.empty()) {
    picture.opacity = Image<float>(frame.has_light.width(), frame.has_light.height());
    std::copy(frame.has_light.pixels().begin(), frame.has_light.pixels().end(),
              picture.opacity.pixels().begin());
  }
  ConvertFromRec709(colours, &picture.rgb);
  return picture;
}

// Throws a Failure (kUsage) if an argument has no meaning for a PNG file.
void RefuseForPng(const std::string& argument, const std::string& value,
                  const std::string& format) {
  throw Failure(UsageError(
      fmt::format("{}=\"{}\": cannot be used with format=\"{}\", because PNG frames are sRGB "
                  "pictures for display: leave it out, or save an EXR file",
                  argument, value, format)));
}

void SaveFrame(const Frame& frame, const std::string& path, const std::string& format,
               const std::string& colour_space, bool alpha, const std::string& channels,
               const std::string& compression) {
  const auto known =
      Named("format", format, ParseFrameFormat(format), "exr, exr-float, png or png16");
  PictureOptions options;
  options.colours = Named("colour_space", colour_space, ParseColourSpace(colour_space),
                          "rec709, rec2020 or acescg");
  options.channels = Named("channels", channels, ParseFrameChannels(channels), "all, rgba or rgb");
  options.compression =
      Named("exr_compression", compression, ParseExrCompression(compression), "zip or zips");
  if (!IsExr(known)) {
    if (options.colours != ColourSpace::kRec709) RefuseForPng("colour_space", colour_space, format);
    if (options.channels != FrameChannels::kAll) RefuseForPng("channels", channels, format);
    if (options.compression != ExrCompression::kZip)
      RefuseForPng("exr_compression", compression, format);
  }
  if (alpha && options.channels == FrameChannels::kRgb)
    throw Failure(
        UsageError("channels=\"rgb\": cannot be used with alpha=True, which adds a channel: use "
                   "channels=\"rgba\", or leave alpha out"));
  const bool has_alpha = alpha || options.channels == FrameChannels::kRgba;
  RunWithoutGil([&] {
    const ImageMetadata metadata =
        WithMore(FileMetadata(frame.notes, known, options.colours), frame);
    if (has_alpha || options.colours != ColourSpace::kRec709)
      Take(WriteFrame(path, PictureFor(frame, options.colours, has_alpha), known, metadata, {},
                      options));
    else
      Take(WriteFrame(path, frame.picture, known, metadata, {}, options));
  });
}

Frame DevelopPlate(const Plate& plate, int threads) {
  ThreadPool& pool = PoolOf(threads);
  return CallWithoutGil([&] {
    PlateNotes notes = plate.notes;
    notes.develop.adds_opacity = true;
    std::optional<Completion> completion;
    if (plate.gaps) completion = CompletionOf(plate.gaps->rays, plate.gaps->share, &pool);
    RenderedFrame rendered =
        DevelopFrame(notes, plate.sums, completion ? &*completion : nullptr, true, pool, {});
    return MakeFrame(std::move(rendered.picture), std::move(notes), plate.sums.has_opacity());
  });
}

// Sets the members of a plate that the entries of its file state, apart from the shard.
void SetEntries(const PlateEntries& entries, const std::string& name, Plate* plate) {
  plate->notes = Take(PlateNotesOf(entries, plate->sums.width(), plate->sums.height(), name));
  for (auto& entry : SharedEntries(entries))
    if (!entry.first.starts_with("plate.")) plate->inputs.push_back(std::move(entry));
}

PlateEntries EntriesOf(const Plate& plate) {
  PlateEntries entries = plate.inputs;
  for (auto& entry : TextOf(plate.notes)) entries.push_back(std::move(entry));
  return entries;
}

std::unique_ptr<Plate> LoadPlate(const std::string& path) {
  auto plate = std::make_unique<Plate>();
  RunWithoutGil([&] {
    PlateReader reader = Take(PlateReader::Open(path));
    plate->sums = SensorPlate(reader.width(), reader.height(), reader.kind());
    SetEntries(reader.entries(), path, plate.get());
    const Shard shard = Take(ShardIn(reader.entries(), path));
    plate->shard_count = shard.count;
    plate->shards = {shard.number};
    Take(reader.AddTo(&plate->sums));
    if (reader.has_gaps()) Take(reader.AddGapsTo(&plate->gaps.emplace()));
  });
  return plate;
}

// Returns the shards of a plate as text, such as "1, 2 of 5".
std::string ShardsText(const Plate& plate) {
  return fmt::format("{} of {}", fmt::join(plate.shards, ", "), plate.shard_count);
}

void SavePlate(const Plate& plate, const std::string& path) {
  PlateEntries entries = EntriesOf(plate);
  if (plate.shards.size() < plate.shard_count) {
    if (plate.shards.size() > 1)
      throw Failure(UsageError(fmt::format(
          "{}: the plate has the shards {}, and a file must have one shard or all: add the others",
          path, ShardsText(plate))));
    entries.emplace_back("shard", Shard{*plate.shards.begin(), plate.shard_count}.Text());
  }
  ThreadPool& pool = PoolOf(0);
  RunWithoutGil([&] {
    Take(WritePlate(path, entries, plate.sums, pool, plate.gaps ? &*plate.gaps : nullptr));
  });
}

// Throws a Failure (kUsage) unless the plates have different rays of the same frame of the same
// render.
void CheckCanBeAdded(const Plate& a, const Plate& b) {
  if (a.sums.width() != b.sums.width() || a.sums.height() != b.sums.height() ||
      a.sums.kind() != b.sums.kind())
    throw Failure(UsageError(fmt::format(
        "plates of {} x {} and {} x {} elements, with {} and {} channels, cannot be added",
        a.sums.width(), a.sums.height(), b.sums.width(), b.sums.height(), a.sums.channels(),
        b.sums.channels())));
  if (const auto difference = FirstDifference(a.Shared(), b.Shared()))
    throw Failure(UsageError(
        fmt::format("plates of different frames, light fields or options cannot be added: {}",
                    difference->Text("one was made with", "the other with"))));
  if (a.gaps.has_value() != b.gaps.has_value() ||
      (a.gaps && a.gaps->share.pixels() != b.gaps->share.pixels()))
    throw Failure(UsageError(
        "plates with different gaps of their lenses cannot be added: render all shards of a hybrid "
        "with the same program"));
  std::vector<uint32_t> both;
  std::set_intersection(a.shards.begin(), a.shards.end(), b.shards.begin(), b.shards.end(),
                        std::back_inserter(both));
  if (a.shard_count != b.shard_count || !both.empty())
    throw Failure(UsageError(
        fmt::format("plates with the shards {} and {} cannot be added, because rays would count "
                    "twice: add plates of different shards of one division",
                    ShardsText(a), ShardsText(b))));
}

std::unique_ptr<Plate> AddPlates(const Plate& a, const Plate& b) {
  CheckCanBeAdded(a, b);
  auto sum = std::make_unique<Plate>();
  sum->sums = CopyOf(a.sums);
  sum->sums.Merge(b.sums);
  if (a.gaps) {
    sum->gaps = CopyOf(*a.gaps);
    sum->gaps->rays.Merge(b.gaps->rays);
  }
  sum->notes = a.notes;
  sum->notes.rays += b.notes.rays;
  sum->notes.skipped_count += b.notes.skipped_count;
  sum->notes.skipped.insert(sum->notes.skipped.end(), b.notes.skipped.begin(),
                            b.notes.skipped.end());
  sum->inputs = a.inputs;
  sum->shard_count = a.shard_count;
  sum->shards = a.shards;
  sum->shards.insert(b.shards.begin(), b.shards.end());
  return sum;
}

bool AreEqual(const Plate& a, const Plate& b) {
  if (a.gaps.has_value() != b.gaps.has_value()) return false;
  return a.sums == b.sums && (!a.gaps || (a.gaps->rays == b.gaps->rays &&
                                          a.gaps->share.pixels() == b.gaps->share.pixels()));
}

// Returns [height][width][channels], sums or counts.
py::array_t<uint64_t> WordsOf(const SensorPlate& sums, uint64_t ElementSum::*member) {
  py::array_t<uint64_t> out(
      {py::ssize_t{sums.height()}, py::ssize_t{sums.width()}, py::ssize_t{sums.channels()}});
  uint64_t* to = out.mutable_data();
  for (size_t i = 0; i < sums.words().size(); ++i) *to++ = sums.AtWord(i).*member;
  return out;
}

// Returns the plate with the sums and counts that WordsOf() returned.
SensorPlate SumsOf(const py::handle& of_sums, const py::handle& of_counts) {
  const auto sums = of_sums.cast<py::array_t<uint64_t>>(),
             counts = of_counts.cast<py::array_t<uint64_t>>();
  const auto height = static_cast<int>(sums.shape(0)), width = static_cast<int>(sums.shape(1)),
             channels = static_cast<int>(sums.shape(2));
  SensorPlate plate(width, height, PlateKindOf(static_cast<uint32_t>(channels)).value());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c) plate.Add(x, y, c, {sums.at(y, x, c), counts.at(y, x, c)});
  return plate;
}

template <class T>
py::array_t<T> ArrayCopy(const Image<T>& image) {
  return py::array_t<T>(std::vector<py::ssize_t>{image.height(), image.width(), image.channels()},
                        image.pixels().data());
}

template <class T>
Image<T> ImageOf(const py::handle& value) {
  const auto array = value.cast<py::array_t<T, py::array::c_style>>();
  if (array.size() == 0) return Image<T>();
  Image<T> image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)),
                 static_cast<int>(array.shape(2)));
  std::copy_n(array.data(), array.size(), image.pixels().data());
  return image;
}

// Pickle keeps a plate as these values, and behind them, if it has gaps, their sums, counts and
// shares.
py::tuple StateOf(const Plate& plate) {
  const py::tuple state =
      py::make_tuple(EntriesOf(plate), WordsOf(plate.sums, &ElementSum::sum),
                     WordsOf(plate.sums, &ElementSum::count), plate.shard_count, plate.shards);
  if (!plate.gaps) return state;
  return py::tuple(state + py::make_tuple(WordsOf(plate.gaps->rays, &ElementSum::sum),
                                          WordsOf(plate.gaps->rays, &ElementSum::count),
                                          ArrayCopy(plate.gaps->share)));
}

std::unique_ptr<Plate> PlateOf(const py::tuple& state) {
  auto plate = std::make_unique<Plate>();
  plate->sums = SumsOf(state[1], state[2]);
  SetEntries(state[0].cast<PlateEntries>(), "a pickled plate", plate.get());
  plate->shard_count = state[3].cast<uint32_t>();
  plate->shards = state[4].cast<std::set<uint32_t>>();
  if (state.size() > 5)
    plate->gaps = PlateGaps{SumsOf(state[5], state[6]), ImageOf<float>(state[7])};
  return plate;
}

// Pickle keeps a frame as these values.
py::tuple StateOf(const Frame& frame) {
  const DevelopedFrame& p = frame.picture;
  return py::make_tuple(TextOf(frame.notes), ArrayCopy(p.rgb), ArrayCopy(p.ray_count),
                        ArrayCopy(p.coverage), ArrayCopy(p.opacity), ArrayCopy(p.effective_count),
                        ArrayCopy(p.interpolated), ArrayCopy(p.densified), ArrayCopy(p.trust),
                        ArrayCopy(frame.has_light), frame.more_metadata);
}

Frame FrameOf(const py::tuple& state) {
  DevelopedFrame picture = {ImageOf<float>(state[1]), ImageOf<uint32_t>(state[2]),
                            ImageOf<float>(state[3]), ImageOf<float>(state[4]),
                            ImageOf<float>(state[5]), ImageOf<float>(state[6]),
                            ImageOf<float>(state[7]), ImageOf<float>(state[8])};
  PlateNotes notes = Take(PlateNotesOf(state[0].cast<PlateEntries>(), picture.rgb.width(),
                                       picture.rgb.height(), "a pickled frame"));
  return {std::move(picture), std::move(notes), ImageOf<uint8_t>(state[9]),
          state[10].cast<ImageMetadata>()};
}

}  // namespace

Frame MakeFrame(DevelopedFrame picture, PlateNotes notes, bool keeps_opacity) {
  Frame frame = {std::move(picture), std::move(notes)};
  if (keeps_opacity) return frame;
  const Image<float> added = std::exchange(frame.picture.opacity, {});
  frame.has_light = Image<uint8_t>(added.width(), added.height());
  std::transform(added.pixels().begin(), added.pixels().end(), frame.has_light.pixels().begin(),
                 [](float opacity) { return static_cast<uint8_t>(opacity > 0); });
  return frame;
}

SensorPlate CopyOf(const SensorPlate& plate) {
  SensorPlate copy(plate.width(), plate.height(), plate.kind());
  copy.Merge(plate);
  return copy;
}

PlateGaps CopyOf(const PlateGaps& gaps) { return {CopyOf(gaps.rays), gaps.share}; }

void AddFrames(py::module_& module) {
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
      .def_property_readonly(
          "trust",
          [](const py::object& self) { return Show(self.cast<Frame&>().picture.trust, self); })
      .def_property_readonly("image_count", [](const Frame& f) { return f.notes.rays.image_count; })
      .def_property_readonly("metadata", [](const Frame& f) { return MetadataOf(f); })
      .def("save", &SaveFrame)
      .def(py::pickle([](const Frame& frame) { return StateOf(frame); }, &FrameOf));
  py::class_<Plate>(module, "Plate")
      .def_static("load", &LoadPlate)
      .def_property_readonly("sums",
                             [](const Plate& p) { return WordsOf(p.sums, &ElementSum::sum); })
      .def_property_readonly("counts",
                             [](const Plate& p) { return WordsOf(p.sums, &ElementSum::count); })
      .def_property_readonly("number", [](const Plate& p) { return p.notes.frame.value; })
      .def_property_readonly(
          "size", [](const Plate& p) { return std::pair(p.sums.width(), p.sums.height()); })
      .def_property_readonly("image_count", [](const Plate& p) { return p.notes.rays.image_count; })
      .def(py::pickle([](const Plate& plate) { return StateOf(plate); }, &PlateOf))
      .def("save", &SavePlate)
      .def("__add__", &AddPlates)
      .def("__eq__", &AreEqual)
      .def("develop", &DevelopPlate);
}

}  // namespace lf::python
