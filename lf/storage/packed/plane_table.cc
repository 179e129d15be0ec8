// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/plane_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include "lf/light_field/model/lf_pixels.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {
namespace {

// Names of the kinds, in the order of the enumeration.
constexpr const char* kPlaneKindNames[kPlaneKindCount] = {"swept", "disparity", "trust"};

// Trust of one step.
constexpr int kTrustUnit = LfPixels::kTrusted / kTrustSteps;
static_assert(kTrustUnit * kTrustSteps == LfPixels::kTrusted);

// Decodes the pixels `rect` of a plane of stored numbers of type T; without `rect`, all of it.
template <class T>
Result<Image<T>> Decode(const StoredPlane& stored, const std::optional<PixelRect>& rect) {
  const auto damaged = [&](std::string_view what) {
    return InputError(fmt::format("{}: {}; copy or make it again", stored.place, what));
  };
  const Result<CodeInfo> info = ReadCodeInfo(stored.code);
  if (!info) return damaged(info.error().message);
  // The head is checked first, so that no more memory is allocated than the plane needs.
  constexpr int kBits = 8 * sizeof(T);
  if (info->width != stored.size.width || info->height != stored.size.height ||
      info->bits != kBits || info->layout != PixelLayout::kGrey ||
      info->profile != CodecProfile::kLossless)
    return damaged(fmt::format("is damaged: expected {} x {} lossless grey numbers of {} bits",
                               stored.size.width, stored.size.height, kBits));
  const PixelRect whole = {0, 0, info->width, info->height};
  if (rect && (rect->empty() || Intersection(*rect, whole) != *rect))
    return damaged("is smaller than its LF image");
  DecodedPart part;
  if (const Result<void> decoded = DecodeImage(stored.code, rect.value_or(whole), &part); !decoded)
    return damaged(decoded.error().message);
  auto& decoded = std::get<Image<T>>(part.pixels);
  if (!rect || part.rect == *rect) return std::move(decoded);
  Image<T> cut(rect->width(), rect->height());
  for (int y = 0; y < cut.height(); ++y)
    std::copy_n(
        decoded.row(y + rect->y_begin - part.rect.y_begin) + rect->x_begin - part.rect.x_begin,
        cut.width(), cut.row(y));
  return cut;
}

}  // namespace

std::string_view NameOf(PlaneKind kind) { return kPlaneKindNames[static_cast<size_t>(kind)]; }

SettingList SettingsOf(const DensifiedPlan& plan) {
  return {{kDensifiedKey, plan.settings},
          {"planes.least", fmt::format("{}", plan.plane_least)},
          {"planes.greatest", fmt::format("{}", plan.plane_greatest)},
          {"planes.divisor", fmt::format("{}", plan.plane_divisor)}};
}

Result<std::optional<DensifiedPlan>> ReadDensified(OpenedStore* store) {
  LF_ASSIGN_OR_RETURN(const bool is_densified, HasTable(&store->database, kVirtualTable));
  if (!is_densified) return std::optional<DensifiedPlan>();
  const Settings& settings = store->settings;
  DensifiedPlan plan;
  plan.settings = settings.Text(kDensifiedKey);
  if (plan.settings.empty()) return settings.Wrong(kDensifiedKey, "settings in words");
  LF_ASSIGN_OR_RETURN(plan.plane_least, settings.Number("planes.least", -kMostNumber, kMostNumber));
  LF_ASSIGN_OR_RETURN(plan.plane_greatest,
                      settings.Number("planes.greatest", plan.plane_least, kMostNumber));
  LF_ASSIGN_OR_RETURN(const uint64_t divisor, settings.Whole("planes.divisor"));
  if (divisor < 1 || divisor > kMostDivisor)
    return settings.Wrong("planes.divisor", fmt::format("a number from 1 to {}", kMostDivisor));
  plan.plane_divisor = static_cast<int>(divisor);
  return std::optional(std::move(plan));
}

Result<StoredPlane> ReadStoredPlane(Database* database, LfImageId id, PlaneKind kind, int divisor) {
  StoredPlane plane;
  plane.place =
      fmt::format("{}: plane {} of LF image {}", database->name(), NameOf(kind), id.value);
  LF_ASSIGN_OR_RETURN(
      Statement select,
      database->Prepare("select plane, width, height from planes join lf_images using (id) "
                        "join intrinsics on intrinsics.id = lf_images.intrinsics "
                        "where planes.id = ? and planes.kind = ?"));
  select.Bind(0, int64_t{id.value}).Bind(1, NameOf(kind));
  LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
  if (!has_row)
    return database->Fault(
        fmt::format("lacks the plane {} of LF image {}; make it again", NameOf(kind), id.value));
  LF_ASSIGN_OR_RETURN(const std::string_view code, select.Blob(0));
  LF_ASSIGN_OR_RETURN(const int64_t width, select.Integer(1, 1, kMostSide_px));
  LF_ASSIGN_OR_RETURN(const int64_t height, select.Integer(2, 1, kMostSide_px));
  plane.code = code;
  plane.size = PlaneSizeOf(static_cast<int>(width), static_cast<int>(height),
                           kind == PlaneKind::kTrust ? 1 : divisor);
  return plane;
}

std::string EncodePlane(const Image<uint16_t>& plane) {
  return EncodeImage(plane, PixelLayout::kGrey, {.profile = CodecProfile::kLossless});
}

std::string EncodeTrust(const Image<uint8_t>& trust) {
  Image<uint8_t> steps(trust.width(), trust.height());
  std::transform(
      trust.pixels().begin(), trust.pixels().end(), steps.pixels().begin(),
      [](uint8_t value) { return static_cast<uint8_t>((value + kTrustUnit / 2) / kTrustUnit); });
  return EncodeImage(steps, PixelLayout::kGrey, {.profile = CodecProfile::kLossless});
}

Result<Image<uint16_t>> DecodePlane(const StoredPlane& stored) {
  return Decode<uint16_t>(stored, std::nullopt);
}

Result<Image<uint8_t>> DecodeTrust(const StoredPlane& stored, const PixelRect& rect) {
  LF_ASSIGN_OR_RETURN(Image<uint8_t> trust, Decode<uint8_t>(stored, rect));
  for (uint8_t& value : trust.pixels()) {
    if (value > kTrustSteps)
      return InputError(
          fmt::format("{}: is damaged: has the number {}, expected at most {}; copy or "
                      "make it again",
                      stored.place, value, kTrustSteps));
    value = static_cast<uint8_t>(value * kTrustUnit);
  }
  return trust;
}

Result<PlaneTable> PlaneTable::Open(const Settings& settings, const LightField& light_field,
                                    int divisor, Database* database) {
  LF_ASSIGN_OR_RETURN(Statement insert, database->Prepare("insert into planes values (?, ?, ?)"));
  PlaneTable table(database, divisor, std::move(insert));
  for (const LfCamera& camera : light_field.cameras) {
    const Intrinsics& k = light_field.intrinsics[camera.intrinsics_index];
    table.is_virtual_.push_back(camera.is_virtual);
    table.sizes_.push_back(PlaneSizeOf(k.width_px, k.height_px, camera.is_virtual ? 1 : divisor));
  }
  for (std::vector<bool>& has : table.has_) has.resize(light_field.size());
  LF_RETURN_IF_ERROR(ForEachRow(
      *database, "select id, kind from planes", [&](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(0));
        LF_ASSIGN_OR_RETURN(const std::string kind, row.Text(1));
        const auto* const name =
            std::find(std::begin(kPlaneKindNames), std::end(kPlaneKindNames), kind);
        const auto index = static_cast<size_t>(id);
        const bool is_trust = kind == NameOf(PlaneKind::kTrust);
        if (id < 0 || index >= light_field.size() || name == std::end(kPlaneKindNames) ||
            light_field.cameras[index].is_virtual != is_trust)
          return settings.Damaged(
              fmt::format("it has a plane {} of LF image {}, which cannot exist", kind, id));
        table.has_[name - std::begin(kPlaneKindNames)][index] = true;
        return {};
      }));
  return table;
}

bool PlaneTable::Has(LfImageId id, PlaneKind kind) const {
  return has_[static_cast<size_t>(kind)][id.value];
}

Result<void> PlaneTable::Insert(LfImageId id, PlaneKind kind, std::string_view code) {
  insert_.Bind(0, int64_t{id.value}).Bind(1, NameOf(kind)).BindBlob(2, code);
  LF_RETURN_IF_ERROR(insert_.Run());
  has_[static_cast<size_t>(kind)][id.value] = true;
  return {};
}

Result<void> PlaneTable::Drop(PlaneKind kind) {
  LF_RETURN_IF_ERROR(
      database_->Execute(fmt::format("delete from planes where kind = '{}'", NameOf(kind))));
  std::vector<bool>& has = has_[static_cast<size_t>(kind)];
  std::fill(has.begin(), has.end(), false);
  return {};
}

}  // namespace lf
