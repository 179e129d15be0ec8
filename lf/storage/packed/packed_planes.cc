// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/packed_planes.h"

#include <utility>

#include "lf/core/check.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/plane_table.h"

namespace lf {

PlaneSize PlaneSizeOf(int width_px, int height_px, int divisor) {
  LF_CHECK(divisor >= 1 && divisor <= kMostDivisor);
  return {(width_px + divisor - 1) / divisor, (height_px + divisor - 1) / divisor};
}

Result<std::optional<DensifiedPlan>> ReadDensifiedPlan(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  return ReadDensified(&store);
}

struct PackedPlaneReader::State {
  Database database;
  int divisor = 1;
};

PackedPlaneReader::PackedPlaneReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
PackedPlaneReader::PackedPlaneReader(PackedPlaneReader&&) noexcept = default;
PackedPlaneReader& PackedPlaneReader::operator=(PackedPlaneReader&&) noexcept = default;
PackedPlaneReader::~PackedPlaneReader() = default;

Result<PackedPlaneReader> PackedPlaneReader::Open(const std::filesystem::path& path) {
  LF_ASSIGN_OR_RETURN(OpenedStore store, OpenComplete(path));
  LF_ASSIGN_OR_RETURN(const auto densified, ReadDensified(&store));
  if (!densified)
    return store.database.Fault(
        "is not densified: it has no planes; give a packed store with virtual LF images");
  return PackedPlaneReader(
      std::unique_ptr<State>(new State{std::move(store.database), densified->plane_divisor}));
}

Result<bool> PackedPlaneReader::Has(LfImageId id, PlaneKind kind) {
  LF_ASSIGN_OR_RETURN(Statement select,
                      state_->database.Prepare("select 1 from planes where id = ? and kind = ?"));
  select.Bind(0, int64_t{id.value}).Bind(1, NameOf(kind));
  return select.Step();
}

Result<Image<uint16_t>> PackedPlaneReader::Read(LfImageId id, PlaneKind kind) {
  LF_ASSIGN_OR_RETURN(const StoredPlane plane,
                      ReadStoredPlane(&state_->database, id, kind, state_->divisor));
  return DecodePlane(plane);
}

Result<Image<uint8_t>> PackedPlaneReader::ReadTrust(LfImageId id, const PixelRect& rect) {
  LF_ASSIGN_OR_RETURN(const StoredPlane plane,
                      ReadStoredPlane(&state_->database, id, PlaneKind::kTrust, state_->divisor));
  return DecodeTrust(plane, rect);
}

}  // namespace lf
