#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lf/core/file.h"
#include "lf/record/report.h"

namespace lf {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kLimitBytes = size_t{256} << 20;

// Values of one object, by key. What is missing keeps its default; the first value of another kind
// is the error.
class Fields {
 public:
  Fields(const Json& object, std::string* fault) : object_(object), fault_(*fault) {
    if (!object.is_object()) Complain("", "an object");
  }

  void Get(const char* key, double* value) {
    if (const Json* json = Find(key)) {
      if (json->is_number())
        *value = json->get<double>();
      else
        Complain(key, "a number");
    }
  }
  template <class Integer>
  void Get(const char* key, Integer* value) {
    if (const Json* json = Find(key)) {
      if (json->is_number_unsigned() &&
          json->get<uint64_t>() <= std::numeric_limits<Integer>::max())
        *value = static_cast<Integer>(json->get<uint64_t>());
      else
        Complain(key, "a whole number");
    }
  }
  void Get(const char* key, std::string* value) {
    if (const Json* json = Find(key)) {
      if (json->is_string())
        *value = json->get<std::string>();
      else
        Complain(key, "text");
    }
  }
  void Get(const char* key, std::array<uint64_t, 3>* values) {
    const Json* json = Find(key);
    if (json == nullptr) return;
    if (!json->is_array() || json->size() != 3) return Complain(key, "three numbers");
    for (size_t i = 0; i < 3; ++i) {
      if (!(*json)[i].is_number_unsigned()) return Complain(key, "three whole numbers");
      (*values)[i] = (*json)[i].get<uint64_t>();
    }
  }
  void Get(const char* key, RunInputs* inputs) {
    const Json* json = Find(key);
    if (json == nullptr) return;
    if (!json->is_object()) return Complain(key, "an object");
    for (const auto& [name, value] : json->items()) {
      if (!value.is_string()) return Complain(key, "texts");
      inputs->emplace_back(name, value.get<std::string>());
    }
  }
  // The objects of a list, none if it is missing.
  std::vector<const Json*> List(const char* key) {
    std::vector<const Json*> list;
    const Json* json = Find(key);
    if (json == nullptr) return list;
    if (!json->is_array()) {
      Complain(key, "a list");
      return list;
    }
    for (const Json& item : *json) list.push_back(&item);
    return list;
  }
  const Json* Find(const char* key) const {
    if (!object_.is_object()) return nullptr;
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }

 private:
  void Complain(const std::string& key, const char* expected) {
    if (fault_.empty()) fault_ = fmt::format("\"{}\": expected {}", key, expected);
  }

  const Json& object_;
  std::string& fault_;
};

FrameReport FrameFromJson(const Json& json, std::string* fault) {
  Fields fields(json, fault);
  FrameReport frame;
  fields.Get("frame", &frame.frame.value);
  fields.Get("lf_images", &frame.rays.image_count);
  fields.Get("rays_tested", &frame.rays.tested_count);
  fields.Get("rays_accepted", &frame.rays.accepted_count);
  fields.Get("elements_without_ray", &frame.empty_element_count);
  fields.Get("rays_per_element_min", &frame.min_count);
  fields.Get("rays_per_element_median", &frame.median_count);
  fields.Get("develop_s", &frame.develop_s);
  fields.Get("inputs", &frame.camera);
  if (fields.Find("interpolated_share") != nullptr)
    fields.Get("interpolated_share", &frame.interpolated_share.emplace());
  if (fields.Find("effective_lf_images") != nullptr) {
    FrameReport::Weighed& weighed = frame.weighed.emplace();
    fields.Get("effective_lf_images", &weighed.effective_count);
    fields.Get("hat_share", &weighed.hat_share);
    fields.Get("uncovered_share", &weighed.uncovered_share);
  }
  if (const Json* samples = fields.Find("samples")) {
    Fields sample_fields(*samples, fault);
    frame.samples.emplace();
    sample_fields.Get("asked", &frame.samples->asked);
    sample_fields.Get("share", &frame.samples->measured.share);
    sample_fields.Get("most_have", &frame.samples->measured.most_have);
  }
  if (frame.frame.value == 0 && fault->empty()) *fault = "\"frame\": expected a number from 1";
  return frame;
}

}  // namespace

Result<RenderReport> ParseReport(std::string_view text, const std::string& name) {
  const Json json = Json::parse(text, nullptr, false);
  std::string fault;
  std::string format;
  RenderReport report;
  if (json.is_discarded()) {
    fault = "it is no JSON, or only a part of it";
  } else {
    Fields fields(json, &fault);
    fields.Get("format", &format);
    if (fault.empty() && format != "lfreport 1") fault = "\"format\": expected \"lfreport 1\"";
    fields.Get("version", &report.version);
    fields.Get("inputs", &report.inputs);
    fields.Get("lf_images_selected", &report.selected_image_count);
    fields.Get("seconds", &report.total_s);
    fields.Get("load_cpu_s", &report.load_cpu_s);
    fields.Get("load_wall_s", &report.load_wall_s);
    fields.Get("collect_cpu_s", &report.collect_cpu_s);
    if (const Json* item = fields.Find("rebinning")) {
      Fields rebinning_fields(*item, &fault);
      RebinReport& rebinning = report.rebinning.emplace();
      rebinning_fields.Get("slabs", &rebinning.slab_count);
      rebinning_fields.Get("cells", &rebinning.cell_count);
      rebinning_fields.Get("lf_pixels_looked_at", &rebinning.looked_at_count);
      rebinning_fields.Get("cpu_s", &rebinning.cpu_s);
    }
    for (const Json* item : fields.List("skipped_lf_images")) {
      Fields skipped_fields(*item, &fault);
      SkippedImage& skipped = report.skipped.emplace_back();
      skipped_fields.Get("name", &skipped.name);
      skipped_fields.Get("reason", &skipped.reason);
    }
    for (const Json* item : fields.List("frames"))
      report.frames.push_back(FrameFromJson(*item, &fault));
  }
  if (!fault.empty())
    return InputError(
        fmt::format("{}: is no report that a render could go on from: {}; remove it to render anew",
                    name, fault));
  return report;
}

Result<RenderReport> ReadReport(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kLimitBytes));
  return ParseReport(text, path.string());
}

}  // namespace lf
