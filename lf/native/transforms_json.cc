#include "lf/native/transforms_json.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "lf/capture/distinct_intrinsics.h"
#include "lf/core/file.h"
#include "lf/native/intrinsics_keys.h"
#include "lf/native/json_fields.h"
#include "lf/native/lf_keys.h"
#include "lf/native/opengl_pose.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;
using Event = json::parse_event_t;

constexpr size_t kMaxFrameCount = size_t{1} << 24;
constexpr int kMaxDepth = 8;  // nothing we read lies deeper; hostile nesting takes no memory

constexpr NumberRule kFinite = {"finite", [](double) { return true; }};
constexpr NumberRule kGain = {"a factor from 1e-6 to 1e6",
                              [](double x) { return x >= 1e-6 && x <= 1e6; }};
constexpr NumberRule kUnit = {"metres per world unit, from 1e-9 to 1e9",
                              [](double x) { return x >= 1e-9 && x <= 1e9; }};

// Takes the frames one by one as the parser completes them and lets it forget them: of a million
// frames only LfCameras and names are ever in memory. What they share may come after them in the
// file, so their intrinsics are resolved at the end.
class Reader {
 public:
  Reader(const fs::path& path, const ImageSizeSource& image_size, const RawFactsSource& raw_facts)
      : path_(path), image_size_(image_size), raw_facts_(raw_facts) {
    light_field_.folder = path.parent_path();
  }

  // The parser's callback: whether to keep what it has just read. Depth 0 is the top level, 1 its
  // keys and values, 2 the entries of "frames".
  bool Keep(int depth, Event event, json& value) {
    if (error_ || depth > kMaxDepth) return false;
    if (depth == 1 && event == Event::key) NoteKey(value.get_ref<const std::string&>());
    if (!in_frames_) return true;
    if (depth == 1 && event == Event::array_start) in_frames_list_ = true;
    if (depth == 1 && event == Event::array_end) in_frames_list_ = false;
    if (depth != 2 || !in_frames_list_) return true;
    if (event == Event::value || event == Event::array_start)
      SetError(JsonFields(value, path_, frame_count(), "").Fault("expected an object {...}"));
    if (event != Event::object_end) return true;
    if (Result<void> result = AddFrame(value); !result) SetError(result.error());
    return false;
  }

  // After the parser, with all that it kept.
  Result<LightField> Finish(const json& top) {
    if (error_) return *error_;
    const JsonFields fields(top, path_);
    if (!top.is_object()) return fields.Fault("expected an object {...} with a list \"frames\"");
    const json* frames = fields.Find("frames");
    if (!frames || !frames->is_array()) return fields.Wrong("frames", "a list of objects");
    if (frame_count() == 0) return fields.Fault("\"frames\" is empty: a light field needs images");
    LF_RETURN_IF_ERROR(fields.CheckLfKeys(kTopLevelLfKeys, kFrameLfKeys, "into each frame"));
    LF_RETURN_IF_ERROR(ResolveAllIntrinsics(fields));
    LF_ASSIGN_OR_RETURN(light_field_.encoding, ReadEncoding(fields, light_field_, raw_facts_));
    LF_ASSIGN_OR_RETURN(const std::optional<double> unit_m, fields.Number("lf_unit_m", kUnit));
    light_field_.unit_m = unit_m.value_or(1);
    LF_RETURN_IF_ERROR(ReadDepthRange(fields));
    if (!light_field_.mask_names.empty()) light_field_.mask_names.resize(frame_count());
    return std::move(light_field_);
  }

 private:
  size_t frame_count() const { return light_field_.cameras.size(); }
  void SetError(Error error) {
    if (!error_) error_ = std::move(error);
  }

  void NoteKey(const std::string& key) {
    in_frames_ = key == "frames";
    if (!seen_keys_.insert(key).second)
      SetError(InputError(fmt::format("{}: \"{}\" is given twice", path_.string(), key)));
  }

  Result<void> AddFrame(const json& frame) {
    const size_t index = frame_count();
    const JsonFields unnamed(frame, path_, index, "");
    if (index == kMaxFrameCount)
      return unnamed.Fault(fmt::format("more than {} frames", kMaxFrameCount));
    LF_ASSIGN_OR_RETURN(std::optional<std::string> name, unnamed.Text("file_path"));
    if (!name || name->empty()) return unnamed.Wrong("file_path", "the name of the image file");

    const JsonFields fields(frame, path_, index, *name);
    LF_RETURN_IF_ERROR(fields.CheckLfKeys(kFrameLfKeys, kTopLevelLfKeys, "to the top level"));
    LfCamera camera;
    LF_ASSIGN_OR_RETURN(camera.cam_from_world, ReadPose(fields));
    LF_ASSIGN_OR_RETURN(const std::optional<double> gain, fields.Number("lf_gain", kGain));
    camera.gain = static_cast<float>(gain.value_or(1));
    LF_ASSIGN_OR_RETURN(const IntrinsicsKeys keys, ReadIntrinsicsKeys(fields));
    camera.intrinsics_index =
        distinct_keys_.try_emplace(keys, static_cast<uint32_t>(distinct_keys_.size()))
            .first->second;
    LF_RETURN_IF_ERROR(ReadMask(fields, index));
    light_field_.cameras.push_back(camera);
    // As instant-ngp does for the frames of Blender's NeRF scenes.
    if (!fs::path(*name).has_extension()) *name += ".png";
    light_field_.image_names.push_back(*std::move(name));
    return {};
  }

  static Result<RigidTransform> ReadPose(const JsonFields& fields) {
    LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> matrix,
                        fields.Matrix("transform_matrix", 3, 4, 4, kFinite));
    if (!matrix) return fields.Wrong("transform_matrix", "the 4x4 camera-to-world matrix");
    const double* last_row = matrix->size() == 16 ? matrix->data() + 12 : nullptr;
    if (last_row && Eigen::RowVector4d(last_row) != Eigen::RowVector4d(0, 0, 0, 1))
      return fields.Fault("\"transform_matrix\": expected the last row 0, 0, 0, 1");
    const Result<RigidTransform> pose = CamFromWorldOfOpenGl(
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(matrix->data()));
    if (!pose) return fields.Fault("\"transform_matrix\" " + pose.error().message);
    return WithExactTranslation(fields, *pose);
  }

  // lf_translation is the translation that the matrix gives, without the rounding of the way
  // through the centre.
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

  // lf_mask, or nerfstudio's mask_path, which means the same.
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

  // Of the first image, for all: asked for once.
  Result<std::array<int, 2>> DefaultSize() {
    constexpr const char* kAdvice =
        "add \"w\" and \"h\", in pixels, at the top level (e.g. \"w\": 800, \"h\": 800)";
    if (!default_size_) {
      if (!image_size_)
        return InputError(
            fmt::format("{}: the image size is missing: {}", path_.string(), kAdvice));
      const auto size = image_size_(light_field_.ImagePath({0}));
      if (!size)
        return InputError(fmt::format(
            "{}: the image size is missing, and the first image does not tell it: {}; {}",
            path_.string(), size.error().message, kAdvice));
      default_size_ = *size;
    }
    return *default_size_;
  }

  Result<void> ResolveAllIntrinsics(const JsonFields& fields) {
    LF_ASSIGN_OR_RETURN(const IntrinsicsKeys top, ReadIntrinsicsKeys(fields));
    std::vector<const IntrinsicsKeys*> keys_by_index(distinct_keys_.size());
    for (const auto& [keys, index] : distinct_keys_) keys_by_index[index] = &keys;

    constexpr uint32_t kNotYet = UINT32_MAX;
    std::vector<uint32_t> resolved(distinct_keys_.size(), kNotYet);
    DistinctIntrinsics distinct;
    for (size_t i = 0; i < frame_count(); ++i) {
      uint32_t& index = light_field_.cameras[i].intrinsics_index;
      if (resolved[index] == kNotYet) {
        const json no_object = json::object();
        const JsonFields frame(no_object, path_, i, light_field_.image_names[i]);
        LF_ASSIGN_OR_RETURN(
            const Intrinsics intrinsics,
            ResolveIntrinsics(
                *keys_by_index[index], top, [this] { return DefaultSize(); }, frame));
        resolved[index] = distinct.IndexOf(intrinsics);
      }
      index = resolved[index];
    }
    light_field_.intrinsics = distinct.Take();
    return {};
  }

  const fs::path& path_;
  const ImageSizeSource& image_size_;
  const RawFactsSource& raw_facts_;
  std::optional<std::array<int, 2>> default_size_;
  LightField light_field_;  // intrinsics_index counts distinct_keys_ until the end
  std::map<IntrinsicsKeys, uint32_t> distinct_keys_;
  std::set<std::string> seen_keys_;
  bool in_frames_ = false;
  bool in_frames_list_ = false;
  std::optional<Error> error_;
};

}  // namespace

Result<LightField> ParseTransformsJson(std::string_view text, const fs::path& path,
                                       const ImageSizeSource& image_size,
                                       const RawFactsSource& raw_facts) {
  Reader reader(path, image_size, raw_facts);
  try {
    const json top =
        json::parse(text.begin(), text.end(), [&reader](int depth, Event event, json& value) {
          return reader.Keep(depth, event, value);
        });
    return reader.Finish(top);
  } catch (const json::exception& exception) {
    return IsNotJson(path, exception.what());
  }
}

Result<LightField> ReadTransformsJson(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path));
  return ParseTransformsJson(text, path, ImageSizeInHeader, RawFactsOfFirstImage);
}

}  // namespace lf
