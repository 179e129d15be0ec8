// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/compress_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lf/core/quantities.h"
#include "lf/core/spelling.h"

namespace lf {
namespace {

using Json = nlohmann::ordered_json;

double Ratio(uint64_t bytes, uint64_t of) {
  return of == 0 ? 0 : static_cast<double>(bytes) / static_cast<double>(of);
}

std::string Decibels(double db) {
  return std::isinf(db) ? std::string("exact") : fmt::format("{:.1f} dB", db);
}

// Returns the PSNR that belongs to a mean squared error of a frame.
double PsnrOf(double error) { return CodeError{error, 1}.PsnrDb(); }

double MegabytesPerSecond(uint64_t bytes, double seconds) {
  return seconds > 0 ? static_cast<double>(bytes) / 1e6 / seconds : 0;
}

// Returns the PSNR of an error of `errors`, against display white; at most kMostTested_db.
double TestedDb(const GuardErrors& errors, double squared) {
  constexpr double kMostTested_db = 150;
  const double mean = squared / static_cast<double>(errors.count);
  return mean > 0 ? std::min(kMostTested_db, -10 * std::log10(mean)) : kMostTested_db;
}

double JointShare(const GuardErrors& errors) {
  return Ratio(errors.joint_block_count, errors.block_count);
}

}  // namespace

std::string ProgressDetail(const CompressProgress& now) {
  if (now.phase == CompressPhase::kChoosing) return "choosing";
  if (now.phase == CompressPhase::kVerifying) return "verifying";
  if (now.phase == CompressPhase::kPreparing) return "looking at mosaics";
  return now.code_bytes == 0 ? std::string("coding")
                             : fmt::format("{:.1f} : 1", Ratio(now.pixel_bytes, now.code_bytes));
}

std::string CompressText(const CompressReport& report, const CompressOptions& options,
                         const std::string& next) {
  std::string text = fmt::format(
      "{}: {} LF images{}, {}B in all; {}\n", options.store.string(),
      report.image_count - report.skipped.size(),
      report.skipped.empty() ? std::string() : fmt::format(" of {}", report.image_count),
      ShortNumber(static_cast<double>(report.store_bytes)), report.codec);
  if (report.left_out_count > 0)
    text += fmt::format(
        "{} LF images are left out, because the packages do not need them: a film that needs them "
        "cannot be rendered from this store\n",
        report.left_out_count);
  if (report.sample)
    text += fmt::format(
        "chosen    by {} LF images: groups take {:.2f} of the bytes of single images{}\n",
        report.sample->image_count, Ratio(report.sample->in_groups, report.sample->alone),
        report.sample->file_count == 0
            ? std::string()
            : fmt::format(" and of the {} files that are smaller", report.sample->file_count));
  if (report.was_there) text += "existed already: nothing was written\n";
  if (report.resumed_count > 0)
    text += fmt::format(
        "{} LF images were encoded before; the figures below are those of the other {}\n",
        report.resumed_count, report.coded_count);
  if (report.coded_count > 0 && report.is_copy) {
    text += fmt::format("copied    {} encoded images, {}B; {}\n", report.coded_count,
                        ShortNumber(static_cast<double>(report.code_bytes)),
                        ShortDuration(report.total_s));
  } else if (report.coded_count > 0) {
    text += fmt::format("pixels    {}B, encoded {}B: {:.2f} : 1\n",
                        ShortNumber(static_cast<double>(report.pixel_bytes)),
                        ShortNumber(static_cast<double>(report.code_bytes)),
                        Ratio(report.pixel_bytes, report.code_bytes));
    text += fmt::format("files     {}B: {:.2f} : 1\n",
                        ShortNumber(static_cast<double>(report.source_bytes)),
                        Ratio(report.source_bytes, report.code_bytes));
    if (report.predicted_count > 0)
      text += fmt::format("predicted {} of {} LF images from others of their groups\n",
                          report.predicted_count, report.coded_count);
    if (report.file_count > 0)
      text += fmt::format("kept      {} of {} LF images as their files, which are {}\n",
                          report.file_count, report.coded_count,
                          options.files == KeepFiles::kAll ? "not encoded again"
                                                           : "smaller than their encoded images");
    text += fmt::format("quality   {}", Decibels(report.error.PsnrDb()));
    if (report.error.squared > 0)
      text += fmt::format("; worst {} ({})", Decibels(report.worst_psnr_db), report.worst_name);
    if (report.frames)
      text += fmt::format("\nframes    {} predicted; worst {} (frame {})",
                          Decibels(PsnrOf(report.frames->mean)),
                          Decibels(PsnrOf(report.frames->worst)), report.frames->worst_frame.value);
    text += fmt::format("\nspeed     {:.0f} MB/s of pixels, {:.0f} MB/s for each CPU second; {}\n",
                        MegabytesPerSecond(report.pixel_bytes, report.total_s),
                        MegabytesPerSecond(report.pixel_bytes, report.encode_cpu_s),
                        ShortDuration(report.total_s));
  }
  if (report.demosaicked && report.demosaicked->count > 0)
    text += fmt::format(
        "demosaic  {:.1f} dB at tested pixels, {:.1f} dB without neighbours; {:.0f} % of the "
        "blocks "
        "take colours from neighbours\n",
        TestedDb(*report.demosaicked, report.demosaicked->kept),
        TestedDb(*report.demosaicked, report.demosaicked->single),
        100 * JointShare(*report.demosaicked));
  if (report.verified_count)
    text += fmt::format("verified  {} encoded images were read back: all are right\n",
                        *report.verified_count);
  if (report.code_bytes > report.source_bytes && report.source_bytes > 0 && !report.demosaicked)
    text +=
        "note: the image files are smaller than their encoded images, because they are "
        "compressed already: use the files instead of the store\n";
  if (report.rounded_count > 0)
    text += fmt::format("note: {} LF images hold floats that were rounded to half floats\n",
                        report.rounded_count);
  for (const CompressReport::Skipped& skipped : report.skipped)
    text += fmt::format("skipped   {}: {}\n", skipped.name, Spelled(skipped.reason));
  return text + next;
}

std::string MissingText(const CompressReport& report, const CompressOptions& options) {
  if (report.skipped.empty()) return "";
  return fmt::format(
      "{}: {} of {} LF images are not in the store, because they are missing or broken; the first: "
      "{}: {}",
      options.store.string(), report.skipped.size(), report.image_count,
      report.skipped.front().name, report.skipped.front().reason);
}

std::string CompressJson(const CompressReport& report, const CompressOptions& options) {
  const auto decibels = [](double db) { return std::isinf(db) ? Json("exact") : Json(db); };
  Json json;
  json["store"] = options.store.string();
  json["codec"] = report.codec;
  json["threshold"] = report.threshold;
  json["lf_images"] = report.image_count;
  json["lf_images_left_out"] = report.left_out_count;
  json["was_there"] = report.was_there;
  json["resumed"] = report.resumed_count;
  json["coded"] = report.coded_count;
  json["files_kept"] = report.file_count;
  json["predicted"] = report.predicted_count;
  if (report.sample)
    json["sample"] = {{"lf_images", report.sample->image_count},
                      {"bytes_in_groups", report.sample->in_groups},
                      {"bytes_alone", report.sample->alone},
                      {"smaller_files", report.sample->file_count}};
  json["source_bytes"] = report.source_bytes;
  json["pixel_bytes"] = report.pixel_bytes;
  json["code_bytes"] = report.code_bytes;
  json["store_bytes"] = report.store_bytes;
  json["copied"] = report.is_copy;
  if (report.coded_count > 0 && !report.is_copy) {
    json["ratio"] = Ratio(report.pixel_bytes, report.code_bytes);
    json["psnr_db"] = decibels(report.error.PsnrDb());
    json["worst_psnr_db"] = decibels(report.worst_psnr_db);
    json["worst"] = report.worst_name;
  }
  if (report.demosaicked && report.demosaicked->count > 0)
    json["demosaic"] = {{"single_db", TestedDb(*report.demosaicked, report.demosaicked->single)},
                        {"joint_db", TestedDb(*report.demosaicked, report.demosaicked->joint)},
                        {"kept_db", TestedDb(*report.demosaicked, report.demosaicked->kept)},
                        {"joint_share", JointShare(*report.demosaicked)}};
  if (report.frames)
    json["frames"] = {{"psnr_db", decibels(PsnrOf(report.frames->mean))},
                      {"worst_psnr_db", decibels(PsnrOf(report.frames->worst))},
                      {"worst", report.frames->worst_frame.value}};
  json["encode_cpu_s"] = report.encode_cpu_s;
  json["total_s"] = report.total_s;
  json["rounded_to_half"] = report.rounded_count;
  if (report.verified_count) json["verified"] = *report.verified_count;
  json["lf_images_skipped"] = report.skipped.size();
  json["skipped"] = Json::array();
  for (const CompressReport::Skipped& skipped : report.skipped)
    json["skipped"].push_back({{"name", skipped.name}, {"reason", Spelled(skipped.reason)}});
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lf
