// SPDX-License-Identifier: Apache-2.0
#include "lf/render/state/plate_notes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parse_number.h"
#include "lf/core/value_named.h"
#include "lf/render/collect/frame_lens.h"
#include "lf/render/state/record_fields.h"
#include "lf/render/state/run_inputs.h"

namespace lf {
namespace {

// Returns the numbers as text, separated by spaces. Each number is the shortest text that is read
// as the same bits.
std::string Words(std::span<const double> numbers) {
  return fmt::format("{}", fmt::join(numbers, " "));
}

// Returns the first names, as many as fit in kMostBytes, as a JSON list. Other characters than
// printable ASCII are escaped, because names may have any bytes.
std::string NamesText(const std::vector<std::string>& names) {
  constexpr size_t kMostBytes = size_t{256} << 10;
  const auto text_of = [](const Json& json) {
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
  };
  std::string text;
  for (const std::string& name : names) {
    const std::string word = text_of(Json(name));
    if (text.size() + word.size() > kMostBytes) break;
    text += (text.empty() ? "" : ",") + word;
  }
  return "[" + text + "]";
}

// Reads values from the entries of a plate file, by their keys. If an entry is missing or invalid,
// the returned value is arbitrary, and fault() is set to the first such fault.
class NotesReader {
 public:
  NotesReader(const PlateEntries& entries, const std::string& name)
      : entries_(entries), name_(name) {}

  std::vector<double> Numbers(const char* key, size_t count) {
    std::vector<double> numbers = AnyNumbers(key);
    if (numbers.size() != count) Fault(key, fmt::format("{} numbers", count));
    numbers.resize(count);
    return numbers;
  }

  std::vector<double> AnyNumbers(const char* key) {
    std::vector<double> numbers;
    const std::string text = Text(key);
    const char* next = text.data();
    const char* const end = next + text.size();
    while (next < end) {
      double number = 0;
      const auto [rest, error] = std::from_chars(next, end, number);
      if (error != std::errc{} || !std::isfinite(number) || (rest < end && *rest != ' ')) {
        Fault(key, "numbers");
        break;
      }
      numbers.push_back(number);
      next = rest + 1;
    }
    return numbers;
  }

  uint64_t WholeNumber(const char* key, uint64_t most) {
    const std::string text = Text(key);
    const std::optional<uint64_t> number = ParseWhole<uint64_t>(text);
    if (!number || *number > most) Fault(key, fmt::format("a whole number up to {}", most));
    return number.value_or(0);
  }

  std::vector<std::string> Names(const char* key) {
    std::vector<std::string> names;
    const Json json = Json::parse(Text(key), nullptr, false);
    if (!json.is_array()) Fault(key, "a list of names");
    for (const Json& item : json.is_array() ? json : Json::array()) {
      if (!item.is_string()) Fault(key, "a list of names");
      if (item.is_string()) names.push_back(item.get<std::string>());
    }
    return names;
  }

  std::string Text(const char* key) {
    const std::string* const text = FindEntry(entries_, key);
    if (text == nullptr && !fault_)
      fault_ = InputError(fmt::format(
          "{}: has no entry {}, because its frame is unfinished, or another version wrote "
          "it: give a finished plate of {{lfrenderer shard}} or {{lfrenderer keep_plates}}",
          name_, key));
    return text == nullptr ? "" : *text;
  }

  void Fault(const char* key, const std::string& expected) {
    if (!fault_)
      fault_ =
          InputError(fmt::format("{}: {} is \"{}\", expected {}", name_, key, Text(key), expected));
  }

  const std::optional<Error>& fault() const { return fault_; }

 private:
  const PlateEntries& entries_;
  const std::string& name_;
  std::optional<Error> fault_;
};

template <class Matrix>
std::vector<double> RowsOf(const Matrix& matrix) {
  std::vector<double> numbers;
  for (int row = 0; row < matrix.rows(); ++row)
    for (int column = 0; column < matrix.cols(); ++column) numbers.push_back(matrix(row, column));
  return numbers;
}

Mat3 Mat3Of(std::span<const double> rows) {
  Mat3 matrix;
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = rows[i];
  return matrix;
}

// Returns the shutter in the text that TextOf() writes; nullopt if the text is not of this form.
std::optional<FrameShutter> ShutterIn(const std::string& text) {
  FrameShutter read;
  const char* const end = text.data() + text.size();
  const auto angle = std::from_chars(text.data(), end, read.shutter.angle_deg);
  if (angle.ec != std::errc{} || angle.ptr == end || *angle.ptr != ' ') return std::nullopt;
  const auto samples = std::from_chars(angle.ptr + 1, end, read.shutter.samples);
  if (samples.ec != std::errc{} || samples.ptr == end || *samples.ptr != ' ') return std::nullopt;
  read.cameras.assign(samples.ptr + 1, end);
  const bool is_hash = read.cameras.size() == 16 &&
                       read.cameras.find_first_not_of("0123456789abcdef") == std::string::npos;
  const bool is_shutter = read.shutter.angle_deg >= 0 && read.shutter.angle_deg <= 360 &&
                          read.shutter.exists() && read.shutter.samples <= kMostShutterSamples;
  if (!is_hash || !is_shutter) return std::nullopt;
  return read;
}

Vec3 Vec3Of(std::span<const double> v) { return {v[0], v[1], v[2]}; }

}  // namespace

PlateEntries TextOf(const PlateNotes& notes) {
  const RenderCamera& camera = notes.camera;
  const Intrinsics& k = camera.pinhole.intrinsics;
  const RigidTransform& pose = camera.pinhole.cam_from_world;
  const Plane& focus = camera.focus_plane;
  std::vector<double> develop = {notes.develop.pedestal, notes.develop.scale};
  for (const double gain : notes.develop.white_balance) develop.push_back(gain);
  for (const double value : RowsOf(notes.develop.linear_srgb_from_camera)) develop.push_back(value);
  std::vector<double> of_pose = RowsOf(pose.rotation);
  for (const double value : RowsOf(pose.translation)) of_pose.push_back(value);
  const auto words = [](std::initializer_list<double> numbers) {
    return Words(std::vector<double>(numbers));
  };
  PlateEntries text = {
      {"plate.frame", fmt::format("{}", notes.frame.value)},
      {"plate.intrinsics", words({k.fx_px, k.fy_px, k.cx_px, k.cy_px, k.skew_px})},
      {"plate.pose", Words(of_pose)},
      {"plate.aperture", words({camera.aperture.radius_w, 0.0 + camera.aperture.blades,
                                camera.aperture.rotation_rad})},
      {"plate.focus_plane",
       words({focus.normal.x(), focus.normal.y(), focus.normal.z(), focus.offset_w})},
      {"plate.lens",
       words({camera.time_s, camera.focal_length_w, camera.sensor_width_w, camera.focus_distance_w,
              camera.focus_tilt.horizontal_rad, camera.focus_tilt.vertical_rad, camera.unit_m})},
      {"plate.fps", words({notes.fps})},
      {"plate.estimator", NameOf(notes.estimator)},
      {"plate.version", notes.version},
      {"plate.develop", Words(develop)},
      {"plate.smooth_below", fmt::format("{}", notes.develop.smooth_below)},
      {"plate.fill", fmt::format("{}", notes.develop.fill_radius_px)},
      {"plate.lf_images", fmt::format("{}", notes.rays.image_count)},
      {"plate.rays_tested", fmt::format("{}", notes.rays.tested_count)},
      {"plate.rays_accepted", fmt::format("{}", notes.rays.accepted_count)},
  };
  if (notes.first_frame != 1)
    text.emplace_back("plate.first_frame", fmt::format("{}", notes.first_frame));
  if (HasShape(camera))
    text.emplace_back("plate.lens_shape", words({camera.aperture.ratio, camera.aperture.roundness,
                                                 camera.hood.distance_w, camera.hood.radius_w}));
  if (camera.transmission) text.emplace_back("plate.transmission", camera.transmission->Text());
  if (const std::string digest = notes.FocalSurface(); !digest.empty())
    text.emplace_back("plate.focal_surface", digest);
  if (notes.shutter)
    text.emplace_back("plate.shutter",
                      fmt::format("{} {} {}", notes.shutter->shutter.angle_deg,
                                  notes.shutter->shutter.samples, notes.shutter->cameras));
  if (notes.rays.virtual_count > 0)
    text.emplace_back("plate.virtual_lf_images", fmt::format("{}", notes.rays.virtual_count));
  if (notes.ranks_done)
    text.emplace_back("plate.finished_early", fmt::format("{}", *notes.ranks_done));
  if (notes.skipped_count > 0) {
    text.emplace_back("plate.lf_images_skipped", fmt::format("{}", notes.skipped_count));
    text.emplace_back("plate.skipped", NamesText(notes.skipped));
  }
  if (notes.weighed) {
    const auto& counts = notes.weighed->effective_counts.pixels();
    text.emplace_back("plate.weights",
                      words({notes.weighed->hat_share, notes.weighed->coverage.uncovered_share,
                             notes.weighed->coverage.fitting_diameter_w}));
    text.emplace_back("plate.effective", fmt::format("{}", fmt::join(counts, " ")));
  }
  return text;
}

Result<PlateNotes> PlateNotesOf(const PlateEntries& entries, int width_px, int height_px,
                                const std::string& name) {
  NotesReader reader(entries, name);
  PlateNotes notes;
  // Another version may keep opacity, which notes do not describe, in another range of values.
  const std::string* const ray_model = FindEntry(entries, kRayModelKey);
  if (ray_model != nullptr && *ray_model != fmt::format("{}", kRayModelVersion))
    reader.Fault(
        kRayModelKey,
        fmt::format("{}, because this program has another version of the ray model: use the "
                    "program that rendered the plate, or render it again",
                    kRayModelVersion));
  notes.frame.value = static_cast<uint32_t>(reader.WholeNumber("plate.frame", kLargestFrameNumber));
  const std::vector<double> k = reader.Numbers("plate.intrinsics", 5);
  Intrinsics& intrinsics = notes.camera.pinhole.intrinsics;
  intrinsics = {k[0], k[1], k[2], k[3], k[4], width_px, height_px};
  if (!(k[0] != 0 && k[1] != 0))
    reader.Fault("plate.intrinsics", "focal lengths other than 0 as the first two numbers");
  const std::vector<double> pose = reader.Numbers("plate.pose", 12);
  notes.camera.pinhole.cam_from_world.rotation = Mat3Of(pose);
  notes.camera.pinhole.cam_from_world.translation = Vec3Of(std::span(pose).subspan(9));
  const std::vector<double> aperture = reader.Numbers("plate.aperture", 3);
  if (!(aperture[0] >= 0) || !(aperture[1] == 0 || (aperture[1] >= 3 && aperture[1] <= 1000)))
    reader.Fault("plate.aperture",
                 "a radius of at least 0, 0 or 3 to 1000 blades, and the rotation of the blades");
  else
    notes.camera.aperture = {aperture[0], static_cast<int>(aperture[1]), aperture[2]};
  if (FindEntry(entries, "plate.lens_shape") != nullptr) {
    const std::vector<double> shape = reader.Numbers("plate.lens_shape", 4);
    notes.camera.aperture.ratio = shape[0];
    notes.camera.aperture.roundness = shape[1];
    notes.camera.hood = {shape[2], shape[3]};
    if (!IsShape(notes.camera))
      reader.Fault(
          "plate.lens_shape",
          "a ratio from 0.1 to 10, a roundness from 0 to 1, distance and radius of a hood");
  }
  if (const std::string* const places = FindEntry(entries, "plate.transmission")) {
    if (const auto transmission = Transmission::FromText(*places))
      notes.camera.transmission = std::make_shared<const Transmission>(*transmission);
    else
      reader.Fault("plate.transmission", transmission.error().message);
  }
  if (const std::string* const digest = FindEntry(entries, "plate.focal_surface")) {
    const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
    notes.focal_surface = *digest;
    if (digest->size() != 16 || !std::all_of(digest->begin(), digest->end(), is_digit))
      reader.Fault("plate.focal_surface", "16 hexadecimal digits");
  }
  const std::vector<double> focus = reader.Numbers("plate.focus_plane", 4);
  notes.camera.focus_plane = {Vec3Of(focus), focus[3]};
  const std::vector<double> lens = reader.Numbers("plate.lens", 7);
  notes.camera.time_s = lens[0];
  notes.camera.focal_length_w = lens[1];
  notes.camera.sensor_width_w = lens[2];
  notes.camera.focus_distance_w = lens[3];
  notes.camera.focus_tilt = {lens[4], lens[5]};
  notes.camera.unit_m = lens[6];
  notes.fps = reader.Numbers("plate.fps", 1)[0];
  if (FindEntry(entries, "plate.first_frame") != nullptr)
    notes.first_frame =
        static_cast<uint32_t>(reader.WholeNumber("plate.first_frame", kLargestFrameNumber));
  if (FindEntry(entries, "plate.shutter") != nullptr) {
    notes.shutter = ShutterIn(reader.Text("plate.shutter"));
    if (!notes.shutter)
      reader.Fault(
          "plate.shutter",
          fmt::format("an angle from 0 to 360, 2 to {} samples, and a hash", kMostShutterSamples));
  }
  const auto estimator =
      ValueNamed(reader.Text("plate.estimator"), {Estimator::kNearest, Estimator::kBilinear});
  if (!estimator) reader.Fault("plate.estimator", "nearest or bilinear");
  notes.estimator = estimator.value_or(Estimator::kBilinear);
  notes.version = reader.Text("plate.version");
  const std::vector<double> develop = reader.Numbers("plate.develop", 14);
  if (!(develop[1] > 0)) reader.Fault("plate.develop", "a scale above 0 as the second number");
  notes.develop.pedestal = develop[0];
  notes.develop.scale = develop[1];
  notes.develop.white_balance = {develop[2], develop[3], develop[4]};
  notes.develop.linear_srgb_from_camera = Mat3Of(std::span(develop).subspan(5));
  notes.develop.smooth_below =
      static_cast<uint32_t>(reader.WholeNumber("plate.smooth_below", UINT32_MAX));
  notes.develop.fill_radius_px =
      static_cast<int>(reader.WholeNumber("plate.fill", kMostFillRadius_px));
  notes.rays.image_count = reader.WholeNumber("plate.lf_images", UINT32_MAX);
  notes.rays.tested_count = reader.WholeNumber("plate.rays_tested", UINT64_MAX / 2);
  notes.rays.accepted_count = reader.WholeNumber("plate.rays_accepted", UINT64_MAX / 2);
  if (FindEntry(entries, "plate.virtual_lf_images") != nullptr)
    notes.rays.virtual_count = reader.WholeNumber("plate.virtual_lf_images", UINT32_MAX);
  if (FindEntry(entries, "plate.finished_early") != nullptr)
    notes.ranks_done =
        static_cast<uint32_t>(reader.WholeNumber("plate.finished_early", UINT32_MAX));
  if (FindEntry(entries, "plate.lf_images_skipped") != nullptr) {
    notes.skipped_count = reader.WholeNumber("plate.lf_images_skipped", UINT32_MAX);
    notes.skipped = reader.Names("plate.skipped");
    if (notes.skipped.size() > notes.skipped_count)
      reader.Fault("plate.skipped", fmt::format("at most {} names, as plate.lf_images_skipped says",
                                                notes.skipped_count));
  }
  if (FindEntry(entries, "plate.weights") != nullptr) {
    const std::vector<double> weights = reader.Numbers("plate.weights", 3);
    const auto [columns, rows] = EffectiveSquares(intrinsics);
    const std::vector<double> counts =
        reader.Numbers("plate.effective", static_cast<size_t>(columns) * rows);
    notes.weighed = {weights[0], {weights[1], weights[2]}, Image<float>(columns, rows)};
    for (size_t i = 0; i < counts.size(); ++i) {
      if (!(counts[i] >= 0 && counts[i] <= 1e9))
        reader.Fault("plate.effective", "numbers from 0 to 1e9");
      notes.weighed->effective_counts.pixels()[i] = static_cast<float>(counts[i]);
    }
  }
  if (reader.fault()) return *reader.fault();
  return notes;
}

Result<Shard> ShardIn(const PlateEntries& entries, const std::string& name) {
  const std::string* const text = FindEntry(entries, "shard");
  if (text == nullptr) return Shard();
  if (const std::optional<Shard> shard = ShardOf(*text)) return *shard;
  return InputError(fmt::format(
      "{}: its shard is \"{}\", expected k/K, such as 2/5; render the plate again", name, *text));
}

PlateEntries SharedEntries(const PlateEntries& entries) {
  // Entries that may differ between the shards of a frame: the shard, its rays, and its LF images.
  constexpr const char* kOwn[] = {"shard",
                                  "plate.lf_images",
                                  "plate.virtual_lf_images",
                                  "plate.rays_tested",
                                  "plate.rays_accepted",
                                  "plate.lf_images_skipped",
                                  "plate.skipped"};
  PlateEntries shared;
  for (const auto& entry : entries)
    if (!entry.first.starts_with("progress.") &&
        std::find(std::begin(kOwn), std::end(kOwn), entry.first) == std::end(kOwn))
      shared.push_back(entry);
  return shared;
}

}  // namespace lf
