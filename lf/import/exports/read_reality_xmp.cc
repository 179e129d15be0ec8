// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_reality_xmp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/import/exports/export_files.h"
#include "lf/import/exports/export_xml.h"
#include "lf/import/exports/import_limits.h"
#include "lf/import/exports/reality_lens.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostXmpBytes = size_t{16} << 20;  // of one file

// Returns the element with the camera; one that does not exist if there is none.
XmlElement DescriptionIn(const XmlElement& root) {
  const XmlElement rdf = root.name() == "rdf:RDF" ? root : root.Child("rdf:RDF");
  for (const XmlElement& description : rdf.Children("rdf:Description"))
    if (description.Property("xcr:Rotation") && description.Property("xcr:Position"))
      return description;
  return rdf.Child("xcr:none");
}

// Returns a property that is one number; `otherwise` if it is missing.
Result<double> NumberOf(const XmlElement& element, const char* name, double otherwise,
                        double most) {
  if (!element.Property(name)) return otherwise;
  LF_ASSIGN_OR_RETURN(const std::vector<double> numbers, element.NumbersOfProperty(name, 1, most));
  return numbers[0];
}

Result<Distortion> DistortionIn(const XmlElement& element) {
  const std::string_view model = element.Property("xcr:DistortionModel").value_or("none");
  constexpr const char* kCoefficients = "xcr:DistortionCoeficients";
  if (model == "none" || model == "perspective" || !element.Property(kCoefficients))
    return Distortion{};
  LF_ASSIGN_OR_RETURN(const std::vector<double> c,
                      element.NumbersOfProperty(kCoefficients, 6, kMostRealityCoefficient));
  if (model == "division" && c[0] == 0) return Distortion{};
  constexpr std::string_view kBrown[] = {"brown3", "brown4", "brown3t2", "brown4t2"};
  if (std::find(std::begin(kBrown), std::end(kBrown), model) == std::end(kBrown))
    return element.Fault(
        fmt::format("has the xcr:DistortionModel \"{}\", which is not read: choose Brown3 with or "
                    "without tangential terms in RealityCapture (Alignment > Settings), align "
                    "again, and export again",
                    model.substr(0, 80)));
  return RealityDistortion({c[0], c[1], c[2], c[3], c[4], c[5]});
}

Result<Intrinsics> IntrinsicsIn(const XmlElement& element) {
  Intrinsics k;
  LF_ASSIGN_OR_RETURN(const std::vector<double> f,
                      element.NumbersOfProperty("xcr:FocalLength35mm", 1, 1e6));
  k.fx_px = k.fy_px = f[0] / kFilmWidth_mm;
  LF_ASSIGN_OR_RETURN(k.cx_px, NumberOf(element, "xcr:PrincipalPointU", 0, 10));
  LF_ASSIGN_OR_RETURN(k.cy_px, NumberOf(element, "xcr:PrincipalPointV", 0, 10));
  LF_ASSIGN_OR_RETURN(const double skew, NumberOf(element, "xcr:Skew", 0, 1e6));
  LF_ASSIGN_OR_RETURN(const double aspect, NumberOf(element, "xcr:AspectRatio", 1, 1e6));
  if (skew != 0 || aspect != 1)
    return element.Fault(fmt::format(
        "has the xcr:Skew {} and the xcr:AspectRatio {}: expected 0 and 1, because the "
        "meaning of other values is not documented; export undistorted images and their "
        "XMP files instead (Registration, in the tab ALIGNMENT)",
        skew, aspect));
  LF_ASSIGN_OR_RETURN(k.distortion, DistortionIn(element));
  return k;
}

// Leaves the images of the component that has most of them. Poses that are relative to a component
// do not tell where this is.
std::vector<ExportedImage> ImagesOfOneComponent(std::vector<RealitySidecar> sidecars,
                                                const fs::path& folder) {
  std::map<std::string, size_t> counts;
  for (const RealitySidecar& sidecar : sidecars) ++counts[sidecar.component];
  const auto most = std::max_element(
      counts.begin(), counts.end(),
      [](const auto& one, const auto& other) { return one.second < other.second; });
  std::vector<ExportedImage> images;
  for (RealitySidecar& sidecar : sidecars)
    if (sidecar.component == most->first) images.push_back(std::move(sidecar.image));
  if (images.size() < sidecars.size())
    LogWarning(
        "{}: {} of {} cameras are left out: their XMP files belong to {} other components, whose "
        "places relative to this one are not stated",
        folder.string(), sidecars.size() - images.size(), sidecars.size(), counts.size() - 1);
  return images;
}

}  // namespace

Result<std::optional<RealitySidecar>> ParseRealityXmp(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const XmlFile xml, XmlFile::Parse(text, file));
  const XmlElement element = DescriptionIn(xml.Root());
  if (!element.exists()) return std::optional<RealitySidecar>();
  RealitySidecar sidecar;
  sidecar.image.name = file.stem().string();
  LF_ASSIGN_OR_RETURN(sidecar.image.intrinsics, IntrinsicsIn(element));
  LF_ASSIGN_OR_RETURN(const std::vector<double> rows,
                      element.NumbersOfProperty("xcr:Rotation", 9, 10));
  const Result<Mat3> rotation = RotationOfRows(rows);
  if (!rotation) return element.Fault("xcr:Rotation " + rotation.error().message);
  LF_ASSIGN_OR_RETURN(const std::vector<double> centre,
                      element.NumbersOfProperty("xcr:Position", 3, kLargest_w));
  sidecar.image.cam_from_world = PoseAt(*rotation, {centre[0], centre[1], centre[2]});
  const std::string_view coordinates = element.Property("xcr:Coordinates").value_or("absolute");
  if (coordinates != "absolute")
    sidecar.component = element.Property("xcr:ComponentId").value_or("");
  return std::optional(std::move(sidecar));
}

Result<LightField> ReadRealityXmp(const fs::path& file, const ExportOptions& options) {
  const fs::path folder = FolderAbove(file);
  LF_ASSIGN_OR_RETURN(const std::vector<fs::path> files, SortedFilesIn(folder, ".xmp"));
  std::vector<RealitySidecar> sidecars;
  for (const fs::path& one : files) {
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(one, kMostXmpBytes));
    LF_ASSIGN_OR_RETURN(std::optional<RealitySidecar> sidecar, ParseRealityXmp(text, one));
    if (sidecar) sidecars.push_back(*std::move(sidecar));
  }
  LogPosedCount(folder, sidecars.size(), files.size());
  ExportedCameras cameras;
  cameras.folder = folder;
  cameras.sizes_from = SizesFrom::kEachImage;
  cameras.counts_from_middle = cameras.in_larger_sides = true;
  cameras.images = ImagesOfOneComponent(std::move(sidecars), folder);
  return FinishExport(std::move(cameras), file, options);
}

}  // namespace lf
