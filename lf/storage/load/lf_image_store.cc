#include "lf/storage/load/lf_image_store.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <utility>

#include "lf/core/file.h"

namespace lf {

Result<LfPixels> LoadWithoutThrowing(const LfImageStore& store, LfImageId id, const PixelRect& rect,
                                     const std::string& name, LfPixels pixels) {
  try {
    LF_RETURN_IF_ERROR(store.Load(id, rect, &pixels));
    return pixels;
  } catch (const std::bad_alloc&) {
    return OutputError(fmt::format(
        "{}: too little memory to load it: lower --memory, or use a machine with more", name));
  } catch (const std::exception& exception) {
    return Error{KindOfReadFailure(exception), fmt::format("{}: {}", name, exception.what())};
  }
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
