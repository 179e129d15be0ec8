// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/lf_image_store.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <utility>

#include "lf/core/file.h"

namespace lf {

namespace {

// Returns load(), or an error if that throws.
template <class Load>
auto WithoutThrowing(const std::string& name, const Load& load) -> decltype(load()) {
  try {
    return load();
  } catch (const std::bad_alloc&) {
    return OutputError(fmt::format(
        "{}: too little memory to load it: lower {{memory}}, or use a machine with more", name));
  } catch (const std::exception& exception) {
    return Error{KindOfReadFailure(exception), fmt::format("{}: {}", name, exception.what())};
  }
}

}  // namespace

Result<LfPixels> LoadWithoutThrowing(const LfImageStore& store, LfImageId id, const PixelRect& rect,
                                     const std::string& name, LfPixels pixels,
                                     const RowsLoaded& rows_loaded) {
  return WithoutThrowing(name, [&]() -> Result<LfPixels> {
    LF_RETURN_IF_ERROR(rows_loaded ? store.LoadByRows(id, rect, &pixels, rows_loaded)
                                   : store.Load(id, rect, &pixels));
    return std::move(pixels);
  });
}

Result<int> LoadReducedWithoutThrowing(const LfImageStore& store, LfImageId id, int divisor,
                                       const Intrinsics& k, const std::string& name,
                                       LfPixels* pixels) {
  return WithoutThrowing(name, [&] { return store.LoadReduced(id, divisor, k, pixels); });
}

void MachineFailure::Note(const Error& error) {
  if (error.kind != ErrorKind::kOutput) return;
  const std::lock_guard lock(mutex_);
  if (!first_) first_ = error;
}

Result<void> MachineFailure::Check() const {
  const std::lock_guard lock(mutex_);
  if (first_) return *first_;
  return {};
}

}  // namespace lf
