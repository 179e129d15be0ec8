// SPDX-License-Identifier: Apache-2.0
#include "tools/render_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace lf {
namespace {

constexpr const char* kAdvice =
    "the report names them; once they are mended, or left out of the calibration (lfimport "
    "--exclude missing), render again without --resume, which would keep the finished frames";

// Returns the number of LF images that were to be read, recorded and virtual ones, because both may
// be missing. `Report` is a RenderReport or a PackageReport.
template <class Report>
size_t ReadCount(const Report& report) {
  return report.selected_image_count + report.selected_virtual_count;
}

// Returns how many LF images packages lack, such as "2 of 20 in package-0000, 1 of 18 in
// package-0003".
std::string PackagesText(const RenderReport& report) {
  constexpr size_t kMostNamed = 20;
  std::string text;
  size_t count = 0;
  for (const PackageReport& package : report.packages) {
    if (package.skipped_image_count == 0) continue;
    if (++count > kMostNamed) continue;
    text += fmt::format("{}{} of {} in {}", text.empty() ? "" : ", ", package.skipped_image_count,
                        ReadCount(package), package.name);
  }
  if (count > kMostNamed) text += fmt::format(", and some in {} others", count - kMostNamed);
  return text;
}

}  // namespace

MissingImages MissingOf(const RenderReport& report, const std::string& advice) {
  MissingImages missing{report.skipped.size(), ReadCount(report), "", advice};
  if (missing.count == 0) return missing;
  const SkippedImage& first = report.skipped.front();
  if (report.packages.size() > 1)
    missing.what = fmt::format("{} LF images were left out, missing or broken: {}; the first: {}",
                               missing.count, PackagesText(report), first.reason);
  else
    missing.what = fmt::format("{} of {} LF images were left out, missing or broken; the first: {}",
                               missing.count, missing.asked, first.reason);
  return missing;
}

bool Accepts(const MissingLimit& limit, const RenderReport& report) {
  if (report.packages.empty() || !limit.is_share())
    return limit.Allows(report.skipped.size(), ReadCount(report));
  return std::all_of(report.packages.begin(), report.packages.end(),
                     [&](const PackageReport& package) {
                       return limit.Allows(package.skipped_image_count, ReadCount(package));
                     });
}

Result<void> EndOfRender(const RenderReport& report, const MissingLimit& limit,
                         const Result<void>& required) {
  const Result<void> end =
      EndWithMissing(MissingOf(report, kAdvice), limit, Accepts(limit, report));
  if (!end && !required && required.error().kind == end.error().kind)
    return Error{end.error().kind,
                 fmt::format("{}; and {}", end.error().message, required.error().message)};
  return end ? required : end;
}

}  // namespace lf
