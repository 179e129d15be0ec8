// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_reality_csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/import/exports/comma_fields.h"
#include "lf/import/exports/import_limits.h"
#include "lf/import/exports/reality_lens.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// The columns of a file.
class CsvColumns {
 public:
  // Returns nullopt if the line is no header. A header begins with #name or name; what follows a
  // blank in the name of a column is a remark.
  static std::optional<CsvColumns> Of(std::string_view line) {
    CsvColumns columns;
    for (const std::string_view field : CommaFields(line))
      columns.names_.push_back(field.substr(0, field.find(' ')));
    std::string_view& first = columns.names_[0];
    if (first.starts_with('#')) first.remove_prefix(1);
    if (first != "name") return std::nullopt;
    return columns;
  }

  // Returns the index of the column with one of the names.
  std::optional<size_t> Find(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
      if (const auto found = std::find(names_.begin(), names_.end(), name); found != names_.end())
        return static_cast<size_t>(found - names_.begin());
    return std::nullopt;
  }

 private:
  std::vector<std::string_view> names_;
};

// One line of a file.
struct CsvRow {
  const CsvColumns& columns;
  std::vector<std::string_view> fields;
  size_t line_number = 0;
  const fs::path& file;

  // Returns the number in the column with one of the names.
  Result<double> Number(std::initializer_list<std::string_view> names, double most) const {
    const std::optional<size_t> column = columns.Find(names);
    if (!column)
      return InputError(fmt::format(
          "{}: has no column {}: export internal and external camera parameters, with a local or "
          "projected coordinate system (Registration, in the tab ALIGNMENT)",
          file.string(), fmt::join(names, " or ")));
    const std::string_view text = *column < fields.size() ? fields[*column] : "";
    const std::optional<double> number = ParseNumber(text);
    if (!number || !(std::abs(*number) <= most))
      return InputError(fmt::format("{}: line {}: {} is \"{}\": expected a number within +-{:g}",
                                    file.string(), line_number, *names.begin(), text.substr(0, 80),
                                    most));
    return *number;
  }

  Result<std::vector<double>> Numbers(std::initializer_list<std::string_view> names,
                                      double most) const {
    std::vector<double> numbers;
    for (const std::string_view name : names) {
      LF_ASSIGN_OR_RETURN(const double number, Number({name}, most));
      numbers.push_back(number);
    }
    return numbers;
  }
};

bool IsOpenCvForm(const CsvColumns& columns) { return columns.Find({"R00"}).has_value(); }

Result<Distortion> DistortionInRow(const CsvRow& row) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> c,
                      row.Numbers({"k1", "k2", "k3", "k4", "t1", "t2"}, kMostRealityCoefficient));
  return RealityDistortion({c[0], c[1], c[2], c[3], c[4], c[5]});
}

Result<ExportedImage> ImageOfAngles(const CsvRow& row) {
  ExportedImage image;
  Intrinsics& k = image.intrinsics;
  LF_ASSIGN_OR_RETURN(const double f, row.Number({"f"}, 1e6));
  k.fx_px = k.fy_px = f / kFilmWidth_mm;
  LF_ASSIGN_OR_RETURN(k.cx_px, row.Number({"px"}, 10));
  LF_ASSIGN_OR_RETURN(k.cy_px, row.Number({"py"}, 10));
  Vec3 centre;
  LF_ASSIGN_OR_RETURN(centre.x(), row.Number({"x"}, kLargest_w));
  LF_ASSIGN_OR_RETURN(centre.y(), row.Number({"y"}, kLargest_w));
  LF_ASSIGN_OR_RETURN(centre.z(), row.Number({"alt", "z"}, kLargest_w));
  LF_ASSIGN_OR_RETURN(const double yaw, row.Number({"heading", "yaw"}, 1e6));
  LF_ASSIGN_OR_RETURN(const double pitch, row.Number({"pitch"}, 1e6));
  LF_ASSIGN_OR_RETURN(const double roll, row.Number({"roll"}, 1e6));
  image.cam_from_world = PoseAt(RealityRotation(yaw, pitch, roll), centre);
  return image;
}

Result<ExportedImage> ImageOfMatrix(const CsvRow& row) {
  ExportedImage image;
  Intrinsics& k = image.intrinsics;
  LF_ASSIGN_OR_RETURN(k.fx_px, row.Number({"f_pix"}, 1e9));
  k.fy_px = k.fx_px;
  LF_ASSIGN_OR_RETURN(k.cx_px, row.Number({"px_pix"}, 1e9));
  LF_ASSIGN_OR_RETURN(k.cy_px, row.Number({"py_pix"}, 1e9));
  LF_ASSIGN_OR_RETURN(
      const std::vector<double> r,
      row.Numbers({"R00", "R01", "R02", "R10", "R11", "R12", "R20", "R21", "R22"}, 10));
  const Result<Mat3> rotation = RotationOfRows(r);
  if (!rotation)
    return InputError(fmt::format("{}: line {}: R00 to R22 {}", row.file.string(), row.line_number,
                                  rotation.error().message));
  LF_ASSIGN_OR_RETURN(const std::vector<double> t, row.Numbers({"tx", "ty", "tz"}, kLargest_w));
  image.cam_from_world = {*rotation, {t[0], t[1], t[2]}};
  return image;
}

void WarnIfDivision(const fs::path& file, const std::vector<ExportedImage>& images) {
  const auto has_k1_alone = [](const ExportedImage& image) {
    const DistortionParameters& p = image.intrinsics.distortion.parameters;
    return p[0] != 0 && std::all_of(p.begin() + 1, p.end(), [](double x) { return x == 0; });
  };
  if (!images.empty() && std::all_of(images.begin(), images.end(), has_k1_alone))
    LogWarning(
        "{}: the lenses have no coefficient but k1, which is read as that of Brown's model. If the "
        "distortion model of the project is Division, change it to Brown3 (Alignment > Settings), "
        "align again, and export again",
        file.string());
}

}  // namespace

Result<ExportedCameras> ParseRealityCsv(std::string_view text, const fs::path& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  ExportedCameras cameras;
  cameras.folder = FolderAbove(file);
  cameras.sizes_from = SizesFrom::kEachImage;
  std::optional<CsvColumns> columns;
  for (size_t line_number = 1; !text.empty(); ++line_number) {
    const std::string_view line = TakeLine(&text);
    if (!columns) {
      columns = CsvColumns::Of(line);
      continue;
    }
    if (TrimmedField(line).empty() || line.starts_with('#')) continue;
    const CsvRow row{*columns, CommaFields(line), line_number, file};
    LF_ASSIGN_OR_RETURN(ExportedImage image,
                        IsOpenCvForm(*columns) ? ImageOfMatrix(row) : ImageOfAngles(row));
    image.name = row.fields[0];
    LF_ASSIGN_OR_RETURN(image.intrinsics.distortion, DistortionInRow(row));
    cameras.images.push_back(std::move(image));
  }
  if (!columns)
    return InputError(fmt::format(
        "{}: has no line with the names of the columns, #name,x,y,alt,heading,pitch,roll,f,...: "
        "export internal and external camera parameters from RealityCapture or RealityScan",
        file.string()));
  cameras.counts_from_middle = cameras.in_larger_sides = !IsOpenCvForm(*columns);
  WarnIfDivision(file, cameras.images);
  return cameras;
}

Result<LightField> ReadRealityCsv(const fs::path& file, const ExportOptions& options) {
  return ReadExport(file, options, ParseRealityCsv);
}

}  // namespace lf
