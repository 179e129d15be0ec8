// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/transforms_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>
#include <vector>

#include "lf/core/byte_stream.h"
#include "lf/core/log.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/transforms_json/frame_cutter.h"
#include "lf/light_field/transforms_json/intrinsics_keys.h"
#include "lf/light_field/transforms_json/json_fields.h"
#include "lf/light_field/transforms_json/json_object.h"
#include "lf/light_field/transforms_json/json_syntax.h"
#include "lf/light_field/transforms_json/lf_keys.h"
#include "lf/light_field/transforms_json/opengl_pose.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;
using Event = json::parse_event_t;

constexpr size_t kMaxFrameCount = size_t{1} << 24;
constexpr int kMaxDepth = 8;  // values nested more deeply are not read, so that they take no memory

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

constexpr NumberRule kFinite = {"finite", [](double) { return true; }};
constexpr NumberRule kGain = {"a factor from 1e-6 to 1e6",
                              [](double x) { return x >= 1e-6 && x <= 1e6; }};
constexpr NumberRule kUnit = {"metres per world unit, from 1e-9 to 1e9",
                              [](double x) { return x >= 1e-9 && x <= 1e9; }};

// Reads each frame as soon as it is separated from the text and then forgets its text: for a
// million frames, only LfCameras and names stay in memory. Intrinsics are resolved at the end,
// because the keys that all frames share may come after the frames.
class Reader {
 public:
  // Sources of what the file does not state; all of them may be empty.
  struct Sources {
    ImageSizeSource image_size = {};
    RawFactsSource raw_facts = {};
    // Finds the image files before their size is asked for.
    std::function<Result<size_t>(LightField*)> find_images = {};
  };

  Reader(const fs::path& path, const Sources& sources) : path_(path), sources_(sources) {
    light_field_.folder = path.parent_path();
  }

  // Reads one frame. Returns false if its text is not JSON. An error in its keys is kept for
  // TakeRest().
  bool TakeFrame(const std::string& text) {
    if (!frame_.Parse(text) && !frame_.Parse(WithQuotedNan(text))) return false;
    if (error_) return true;  // after an error, text is parsed only to see if the file is JSON
    if (Result<void> result = AddFrame(); !result) error_ = result.error();
    return true;
  }

  // Reads everything but the frames. Must be called after all frames. `text` has {} in place of
  // each frame. Returns nullopt if the text is not JSON.
  std::optional<Result<LightField>> TakeRest(const std::string& text) {
    std::optional<Error> first_error;
    std::string top_text;
    try {
      top_text = TopLevel(json::accept(text) ? text : WithQuotedNan(text), &first_error).dump();
    } catch (const json::exception&) {
      return std::nullopt;
    }
    if (first_error) return *first_error;
    JsonObject top;
    const JsonFields fields(top, path_);
    if (top_text.starts_with('['))
      return fields.Fault(
          "the file holds a list, such as the poses that `ns-export cameras` of nerfstudio writes, "
          "which has no intrinsics: expected {...} with a list \"frames\"; give the "
          "transforms.json "
          "that nerfstudio trained on");
    if (!top.Parse(top_text))
      return fields.Fault("the file holds no object: expected {...} with a list \"frames\"");
    if (error_) return *error_;
    return Finish(fields);
  }

 private:
  size_t frame_count() const { return light_field_.cameras.size(); }

  // Returns the top level without the entries of "frames". Sets *error if one of the entries is no
  // object, or if a key of the top level occurs twice. Throws if the text is not JSON.
  json TopLevel(const std::string& text, std::optional<Error>* error) const {
    std::set<std::string> seen_keys;
    bool in_frames = false, in_frames_list = false;
    size_t entry_count = 0;
    // Depth 0 is the top level, 1 its keys and values, 2 the entries of "frames".
    return json::parse(text, [&](int depth, Event event, json& value) {
      if (*error || depth > kMaxDepth) return false;
      if (depth == 1 && event == Event::key) {
        const std::string& key = value.get_ref<const std::string&>();
        in_frames = key == "frames";
        if (!seen_keys.insert(key).second)
          *error = InputError(fmt::format("{}: the key \"{}\" occurs twice: remove one of the two",
                                          path_.string(), key));
      }
      if (!in_frames) return true;
      if (depth == 1 && event == Event::array_start) in_frames_list = true;
      if (depth == 1 && event == Event::array_end) in_frames_list = false;
      if (depth != 2 || !in_frames_list) return true;
      if (event == Event::value || event == Event::array_start)
        *error = JsonFields(JsonObject(), path_, entry_count, "")
                     .Fault("is not an object: expected {...} with file_path and transform_matrix");
      if (event == Event::object_end) ++entry_count;
      return event != Event::object_end;
    });
  }

  Result<LightField> Finish(const JsonFields& top) {
    if (!top.ListSize("frames")) return top.Wrong("frames", "a list of objects");
    if (frame_count() == 0)
      return top.Fault(
          "\"frames\" is empty: expected at least one frame, because a light field needs images");
    LF_RETURN_IF_ERROR(top.CheckLfKeys(kTopLevelLfKeys, kFrameLfKeys, "into each frame"));
    LF_RETURN_IF_ERROR(ResolveAllIntrinsics(top));
    LF_ASSIGN_OR_RETURN(light_field_.encoding, ReadEncoding(top, light_field_, sources_.raw_facts));
    LF_ASSIGN_OR_RETURN(const std::optional<double> unit_m, top.Number("lf_unit_m", kUnit));
    light_field_.unit_m = unit_m.value_or(1);
    LF_RETURN_IF_ERROR(ReadDepthRange(top));
    FinishTimes();
    if (!light_field_.mask_names.empty()) light_field_.mask_names.resize(frame_count());
    return std::move(light_field_);
  }

  Result<void> AddFrame() {
    const size_t index = frame_count();
    const JsonFields unnamed(frame_, path_, index, "");
    if (index == kMaxFrameCount)
      return unnamed.Fault(
          fmt::format("this frame is one too many: expected at most {} frames", kMaxFrameCount));
    LF_ASSIGN_OR_RETURN(std::optional<std::string> name, unnamed.Text("file_path"));
    if (!name || name->empty()) return unnamed.Wrong("file_path", "the name of the image file");

    const JsonFields fields(frame_, path_, index, *name);
    LF_RETURN_IF_ERROR(fields.CheckLfKeys(kFrameLfKeys, kTopLevelLfKeys, "to the top level"));
    LfCamera camera;
    LF_ASSIGN_OR_RETURN(camera.cam_from_world, ReadPose(fields));
    LF_ASSIGN_OR_RETURN(camera.gain, ReadGains(fields));
    LF_ASSIGN_OR_RETURN(const IntrinsicsKeys keys, ReadIntrinsicsKeys(fields));
    camera.intrinsics_index = distinct_keys_.IndexOf(keys);
    LF_RETURN_IF_ERROR(ReadMask(fields, index));
    ReadTime(fields, index);
    light_field_.cameras.push_back(camera);
    // instant-ngp adds the same extension for the frames of Blender's NeRF scenes.
    if (!fs::path(*name).has_extension()) *name += ".png";
    light_field_.image_names.push_back(*std::move(name));
    return {};
  }

  // Reads lf_gain: one factor for all channels, or one for each of R, G and B; 1 if it is missing.
  static Result<ChannelGains> ReadGains(const JsonFields& fields) {
    LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> numbers,
                        fields.NumberOrNumbers("lf_gain", 3, kGain));
    ChannelGains gains;
    for (size_t c = 0; numbers && c < 3; ++c) gains[c] = static_cast<float>((*numbers)[c]);
    return gains;
  }

  static Result<RigidTransform> ReadPose(const JsonFields& fields) {
    LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> matrix,
                        fields.Matrix("transform_matrix", 3, 4, 4, kFinite));
    if (!matrix) return fields.Wrong("transform_matrix", "the 4x4 camera-to-world matrix");
    const double* last_row = matrix->size() == 16 ? matrix->data() + 12 : nullptr;
    if (last_row && Eigen::RowVector4d(last_row) != Eigen::RowVector4d(0, 0, 0, 1))
      return fields.Fault(
          fmt::format("\"transform_matrix\" has the last row {}, {}, {}, {}: expected 0, 0, 0, 1",
                      last_row[0], last_row[1], last_row[2], last_row[3]));
    const Result<RigidTransform> pose = CamFromWorldOfOpenGl(
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(matrix->data()));
    if (!pose) return fields.Fault("\"transform_matrix\" " + pose.error().message);
    return WithExactTranslation(fields, *pose);
  }

  // Replaces the translation by lf_translation, if the frame has this key. lf_translation is exact:
  // it lacks the rounding errors of converting the translation to the centre in the matrix and
  // back.
  static Result<RigidTransform> WithExactTranslation(const JsonFields& fields,
                                                     RigidTransform pose) {
    constexpr double kTolerance = 1e-6;
    LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> exact,
                        fields.Numbers("lf_translation", 3, 3, kFinite));
    if (!exact) return pose;
    const Vec3 translation(exact->data());
    if (!((translation - pose.translation).norm() <= kTolerance * pose.translation.norm()))
      return fields.Wrong(
          "lf_translation",
          fmt::format("about [{}, {}, {}] by \"transform_matrix\"; remove "
                      "lf_translation after changing the matrix",
                      pose.translation.x(), pose.translation.y(), pose.translation.z()));
    pose.translation = translation;
    return pose;
  }

  // Reads lf_mask, or nerfstudio's mask_path, which has the same meaning.
  Result<void> ReadMask(const JsonFields& fields, size_t index) {
    LF_ASSIGN_OR_RETURN(std::optional<std::string> mask, fields.Text("lf_mask"));
    if (!mask) {
      LF_ASSIGN_OR_RETURN(mask, fields.Text("mask_path"));
    }
    if (!mask || mask->empty()) return {};
    light_field_.mask_names.resize(index + 1);
    light_field_.mask_names.back() = *std::move(mask);
    return {};
  }

  // Reads the recording time. Other programs may mean something else by a "time" that is no number:
  // it is no error.
  void ReadTime(const JsonFields& fields, size_t index) {
    if (!fields.Has("time")) return;
    const Result<std::optional<double>> time = fields.Number("time", kFinite);
    light_field_.times.resize(index, kNoTime);
    light_field_.times.push_back(time && *time ? **time : kNoTime);
  }

  // Drops the times unless all frames have one.
  void FinishTimes() {
    std::vector<double>& times = light_field_.times;
    if (times.empty()) return;
    times.resize(frame_count(), kNoTime);
    const auto lost =
        std::find_if(times.begin(), times.end(), [](double time) { return std::isnan(time); });
    if (lost == times.end()) return;
    LogWarning(
        "{}: \"time\" of some frames is not used, because frame {} ({}) does not state one as a "
        "number",
        path_.string(), lost - times.begin(), light_field_.image_names[lost - times.begin()]);
    times.clear();
  }

  Result<void> ReadDepthRange(const JsonFields& fields) {
    constexpr NumberRule kDepth = {"a depth above 0 and at most 1e12",
                                   [](double x) { return x > 0 && x <= 1e12; }};
    LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> range,
                        fields.Numbers("lf_depth_range", 2, 2, kDepth));
    if (!range) return {};
    if (!(range->front() < range->back()))
      return fields.Wrong("lf_depth_range", "[near, far] with near < far");
    light_field_.depth_range = DepthRange{range->front(), range->back()};
    return {};
  }

  // Returns the most frequent size of up to 15 evenly spread images; if several sizes are equally
  // frequent, the first of them. The size is read once and then kept.
  Result<std::array<int, 2>> DefaultSize() {
    constexpr const char* kAdvice =
        "add \"w\" and \"h\", in pixels, at the top level (e.g. \"w\": 800, \"h\": 800)";
    if (!default_size_) {
      if (!sources_.image_size)
        return InputError(
            fmt::format("{}: the image size is missing: {}", path_.string(), kAdvice));
      if (sources_.find_images) LF_RETURN_IF_ERROR(sources_.find_images(&light_field_));
      LF_ASSIGN_OR_RETURN(default_size_, SizeOfMost(kAdvice));
    }
    return *default_size_;
  }

  Result<std::array<int, 2>> SizeOfMost(const char* advice) {
    constexpr size_t kMostAsked = 15;
    const size_t count = std::min(kMostAsked, light_field_.size());
    std::vector<std::array<int, 2>> sizes;
    std::optional<Error> fault;  // error of the first image that cannot be read
    for (size_t i = 0; i < count; ++i) {
      const auto index = static_cast<uint32_t>(i * light_field_.size() / count);
      const auto size = sources_.image_size(light_field_.ImagePath(LfImageId{index}));
      if (size)
        sizes.push_back(*size);
      else if (!fault)
        fault = size.error();
    }
    if (sizes.empty())
      return InputError(
          fmt::format("{}: the image size is missing, and cannot be read from the images: {}; {}",
                      path_.string(), fault->message, advice));
    const auto count_of = [&](const std::array<int, 2>& size) {
      return std::count(sizes.begin(), sizes.end(), size);
    };
    return *std::max_element(sizes.begin(), sizes.end(), [&](const auto& a, const auto& b) {
      return count_of(a) < count_of(b);
    });
  }

  Result<void> ResolveAllIntrinsics(const JsonFields& fields) {
    LF_ASSIGN_OR_RETURN(const IntrinsicsKeys top, ReadIntrinsicsKeys(fields));
    const std::vector<IntrinsicsKeys> distinct_keys = distinct_keys_.Take();
    constexpr uint32_t kNotYet = UINT32_MAX;
    std::vector<uint32_t> resolved(distinct_keys.size(), kNotYet);
    DistinctIntrinsics distinct;
    const JsonObject no_object;
    for (size_t i = 0; i < frame_count(); ++i) {
      uint32_t& index = light_field_.cameras[i].intrinsics_index;
      if (resolved[index] == kNotYet) {
        const JsonFields frame(no_object, path_, i, light_field_.image_names[i]);
        LF_ASSIGN_OR_RETURN(
            const Intrinsics intrinsics,
            ResolveIntrinsics(
                distinct_keys[index], top, [this] { return DefaultSize(); }, frame));
        resolved[index] = distinct.IndexOf(intrinsics);
      }
      index = resolved[index];
    }
    light_field_.intrinsics = distinct.Take();
    return {};
  }

  const fs::path& path_;
  const Sources& sources_;
  std::optional<std::array<int, 2>> default_size_;
  // Until Finish(), LfCamera::intrinsics_index is an index into distinct_keys_.
  LightField light_field_;
  Distinct<IntrinsicsKeys, HashOfIntrinsicsKeys> distinct_keys_;
  JsonObject frame_;            // the frame that is being read
  std::optional<Error> error_;  // error of the first faulty frame
};

using StreamSource = std::function<Result<ByteStream>()>;

// Returns the syntax error of the file, for which the file is read again, because the parser of a
// frame does not know where in the file the frame is.
Error SyntaxError(const StreamSource& open) {
  Result<ByteStream> stream = open();
  return stream ? JsonSyntaxError(&*stream) : stream.error();
}

Result<LightField> Read(const fs::path& path, const StreamSource& open,
                        const Reader::Sources& sources) {
  Reader reader(path, sources);
  bool is_json = true;
  FrameCutter cutter("frames",
                     [&](const std::string& frame) { is_json &= reader.TakeFrame(frame); });
  LF_ASSIGN_OR_RETURN(ByteStream stream, open());
  LF_RETURN_IF_ERROR(AddFile(
      &stream, [&] { return is_json; }, &cutter));
  if (!is_json || cutter.is_not_json() || cutter.is_in_frame()) return SyntaxError(open);
  std::optional<Result<LightField>> light_field = reader.TakeRest(cutter.rest());
  return light_field ? *std::move(light_field) : SyntaxError(open);
}

}  // namespace

Result<LightField> ParseTransformsJson(std::string_view text, const fs::path& path,
                                       const ImageSizeSource& image_size,
                                       const RawFactsSource& raw_facts) {
  return Read(path, [&] { return ByteStream(text, path); }, {image_size, raw_facts});
}

Result<LightField> ReadTransformsJson(const fs::path& path,
                                      const std::optional<fs::path>& images_folder) {
  const auto find_images = [&](LightField* light_field) {
    return FindImageFiles(images_folder, light_field);
  };
  return Read(path, [&] { return ByteStream::Open(path); },
              {ImageSizeInHeader, RawFactsOfFirstImage, find_images});
}

}  // namespace lf
