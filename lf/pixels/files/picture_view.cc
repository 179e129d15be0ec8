// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/picture_view.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <charconv>
#include <memory>
#include <mutex>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>

#include "lf/pixels/files/hdf5_array.h"
#include "lf/pixels/files/rows_on_disk.h"
#include "lf/pixels/files/view_array.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kStrided = "every-";
constexpr std::string_view kOfArray = "view+";

// Reads a number and the character behind it, which must be `end`; '\0': the text must end.
std::optional<int> NumberBefore(char end, std::string_view* text) {
  int number = 0;
  const auto [rest, error] = std::from_chars(text->data(), text->data() + text->size(), number);
  const auto count = static_cast<size_t>(rest - text->data());
  if (error != std::errc() || (*text)[0] == '-') return std::nullopt;
  if (end == '\0') return count == text->size() ? std::optional(number) : std::nullopt;
  if (count == text->size() || *rest != end) return std::nullopt;
  text->remove_prefix(count + 1);
  return number;
}

// A picture that is kept, and the state of its file when it was read.
class SharedPicture {
 public:
  // Returns the picture if it is kept, or why it cannot be decoded if that is.
  std::optional<Result<std::shared_ptr<const ImagePart>>> KeptOf(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    return kept_ && StateOf(file) == state_ ? kept_ : std::nullopt;
  }

  // Returns the decoded picture. Other threads that need it wait until it is decoded.
  Result<std::shared_ptr<const ImagePart>> Of(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    const State state = StateOf(file);
    if (kept_ && state == state_) return *kept_;
    kept_.reset();
    auto part = std::make_shared<ImagePart>();
    const auto all = [](const ImageFileInfo& info) -> Result<PixelRect> {
      return PixelRect{0, 0, info.width, info.height};
    };
    const Result<void> read = ReadImagePart(file, all, part.get());
    // A failure is kept as well: each of a thousand views would otherwise decode the picture up to
    // the damage.
    if (read)
      kept_ = std::shared_ptr<const ImagePart>(std::move(part));
    else if (read.error().kind == ErrorKind::kInput)
      kept_ = read.error();
    else
      return read.error();
    state_ = state;
    return *kept_;
  }

  void Forget() {
    const std::lock_guard lock(mutex_);
    kept_.reset();
  }

 private:
  using State = std::tuple<std::string, int64_t, int64_t, int64_t, uint64_t>;

  static State StateOf(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return {file.string(), 0, 0, -1, 0};
    return {file.string(), status.st_mtim.tv_sec, status.st_mtim.tv_nsec, status.st_size,
            status.st_ino};
  }

  std::mutex mutex_;
  State state_;
  std::optional<Result<std::shared_ptr<const ImagePart>>> kept_;
};

SharedPicture& Shared() {
  static SharedPicture picture;
  return picture;
}

// Returns the view with its size, and checks that it lies within the picture.
Result<PictureView> Sized(const PictureView& view, const ImageFileInfo& picture) {
  PictureView sized = view;
  if (picture.raw)
    return InputError(
        fmt::format("{}: is a camera raw file, which holds no views: convert it to PNG or TIFF",
                    view.file.string()));
  if (view.step_x != 1 || view.step_y != 1) {
    sized.width = (picture.width - view.x + view.step_x - 1) / view.step_x;
    sized.height = (picture.height - view.y + view.step_y - 1) / view.step_y;
  }
  const bool is_inside =
      view.x < picture.width && view.y < picture.height && sized.width >= 1 && sized.height >= 1 &&
      (view.step_x != 1 || view.step_y != 1 ||
       (sized.width <= picture.width - view.x && sized.height <= picture.height - view.y));
  if (is_inside) return sized;
  return InputError(fmt::format(
      "{}: this view does not lie within the picture of {} x {} pixels: is it another picture than "
      "when the calibration was written?",
      PathOfView(view).string(), picture.width, picture.height));
}

ImageFileInfo InfoOf(const PictureView& sized, const ImageFileInfo& picture) {
  ImageFileInfo info = picture;
  info.width = sized.width;
  info.height = sized.height;
  info.orientation = 1;
  return info;
}

// Copies the pixels `rect` of a view.
//   part_rect  part of the picture that `from` holds
template <class T>
void CopyPixels(const PictureView& view, const PixelRect& rect, const Image<T>& from,
                const PixelRect& part_rect, Image<T>* to) {
  const auto channels = static_cast<size_t>(from.channels());
  to->Resize(rect.width(), rect.height(), from.channels());
  const size_t step = static_cast<size_t>(view.step_x) * channels;
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    const T* in =
        from.row(view.y + y * view.step_y - part_rect.y_begin) +
        static_cast<size_t>(view.x + rect.x_begin * view.step_x - part_rect.x_begin) * channels;
    T* out = to->row(y - rect.y_begin);
    for (int x = rect.x_begin; x < rect.x_end; ++x, in += step)
      for (size_t c = 0; c < channels; ++c) *out++ = in[c];
  }
}

// Returns the rectangle of the picture that holds the pixels `rect` of a view.
PixelRect RectInPicture(const PictureView& view, const PixelRect& rect) {
  return {view.x + rect.x_begin * view.step_x, view.y + rect.y_begin * view.step_y,
          view.x + (rect.x_end - 1) * view.step_x + 1, view.y + (rect.y_end - 1) * view.step_y + 1};
}

}  // namespace

std::optional<PictureView> PictureViewOf(const fs::path& image) {
  const std::string& path = image.native();
  const size_t mark = path.rfind('#');
  if (mark == std::string::npos || mark == 0) return std::nullopt;
  std::string_view text = std::string_view(path).substr(mark + 1);
  PictureView view;
  if (text.starts_with(kOfArray)) {
    text.remove_prefix(kOfArray.size());
    const std::optional<int> row = NumberBefore('+', &text);
    const std::optional<int> column = row ? NumberBefore('\0', &text) : std::nullopt;
    if (!column) return std::nullopt;
    view.file = path.substr(0, mark);
    view.is_of_array = true;
    view.x = *column;
    view.y = *row;
    return view;
  }
  const bool is_strided = text.starts_with(kStrided);
  if (is_strided) text.remove_prefix(kStrided.size());
  const std::optional<int> across = NumberBefore('x', &text);
  const std::optional<int> down = across ? NumberBefore('+', &text) : std::nullopt;
  const std::optional<int> x = down ? NumberBefore('+', &text) : std::nullopt;
  const std::optional<int> y = x ? NumberBefore('\0', &text) : std::nullopt;
  if (!y || *across < 1 || *down < 1) return std::nullopt;
  view.file = path.substr(0, mark);
  view.x = *x;
  view.y = *y;
  (is_strided ? view.step_x : view.width) = *across;
  (is_strided ? view.step_y : view.height) = *down;
  // A step of one pixel is no view, and would be read as a rectangle without a size.
  if (is_strided && view.step_x == 1 && view.step_y == 1) return std::nullopt;
  return view;
}

fs::path FileOfImage(const fs::path& image) {
  const std::optional<PictureView> view = PictureViewOf(image);
  return view ? view->file : image;
}

std::string ViewSuffix(const fs::path& image) {
  return PictureViewOf(image) ? image.native().substr(image.native().rfind('#')) : "";
}

fs::path PathOfView(const PictureView& view) {
  if (view.is_of_array)
    return fmt::format("{}#{}{}+{}", view.file.native(), kOfArray, view.y, view.x);
  const bool is_strided = view.step_x != 1 || view.step_y != 1;
  return fmt::format("{}#{}{}x{}+{}+{}", view.file.native(), is_strided ? kStrided : "",
                     is_strided ? view.step_x : view.width, is_strided ? view.step_y : view.height,
                     view.x, view.y);
}

Result<ImageFileInfo> ReadViewInfo(const PictureView& view) {
  if (view.is_of_array) {
    LF_ASSIGN_OR_RETURN(const ViewArray array, ReadViewArray(view.file));
    return array.info;
  }
  LF_ASSIGN_OR_RETURN(const ImageFileInfo picture, ReadImageInfo(view.file));
  LF_ASSIGN_OR_RETURN(const PictureView sized, Sized(view, picture));
  return InfoOf(sized, picture);
}

Result<void> ReadViewPart(const PictureView& view, const WantedPixels& wanted, ImagePart* part) {
  if (view.is_of_array) return ReadArrayPart(view.file, view.y, view.x, wanted, part);
  PixelRect rect;
  const auto rect_of = [&](const ImageFileInfo& picture) -> Result<PixelRect> {
    LF_ASSIGN_OR_RETURN(const PictureView sized, Sized(view, picture));
    const ImageFileInfo info = InfoOf(sized, picture);
    LF_ASSIGN_OR_RETURN(rect, wanted(info));
    rect = Intersection(rect, {0, 0, info.width, info.height});
    part->info = info;
    return RectInPicture(view, rect);
  };
  // Keeping the rows of a file that is not compressed would take memory for nothing.
  ImagePart on_disk;
  std::optional<Result<std::shared_ptr<const ImagePart>>> kept = Shared().KeptOf(view.file);
  bool is_on_disk = false;
  if (!kept) {
    LF_ASSIGN_OR_RETURN(is_on_disk, ReadRowsOnDisk(view.file, rect_of, &on_disk));
  }
  std::shared_ptr<const ImagePart> shared;
  if (!is_on_disk) {
    LF_ASSIGN_OR_RETURN(shared, kept ? *std::move(kept) : Shared().Of(view.file));
    if (const Result<PixelRect> checked = rect_of(shared->info); !checked) return checked.error();
  }
  const ImagePart& picture = is_on_disk ? on_disk : *shared;
  std::visit(
      [&]<class T>(const Image<T>& from) {
        if (!std::holds_alternative<Image<T>>(part->image)) part->image.emplace<Image<T>>();
        CopyPixels(view, rect, from, picture.rect, &std::get<Image<T>>(part->image));
      },
      picture.image);
  part->rect = rect;
  part->icc_profile = picture.icc_profile;
  return {};
}

size_t SharedPictureBytes(const PictureView& view) {
  if (view.is_of_array) {
    const Result<ViewArray> array = ReadViewArray(view.file);
    return array ? array->cache_bytes : 0;
  }
  const Result<ImageFileInfo> info = ReadImageInfo(view.file);
  const Result<bool> is_on_disk = HasRowsOnDisk(view.file);
  if (!info || !is_on_disk || *is_on_disk) return 0;
  std::error_code error;
  const uint64_t file_bytes = fs::file_size(view.file, error);
  return static_cast<size_t>(info->width) * static_cast<size_t>(info->height) *
             static_cast<size_t>(info->channels) * static_cast<size_t>(info->bits / 8) +
         (error ? 0 : file_bytes);
}

void ForgetSharedPicture() {
  Shared().Forget();
  CloseHdf5File();
}

}  // namespace lf
