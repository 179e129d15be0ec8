// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_middlebury.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>

#include "lf/core/file.h"
#include "lf/core/parse_number.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/rotation.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostFileBytes = size_t{256} << 20;
constexpr size_t kNumberCount = 21;  // count of the numbers K, R and t in a line
constexpr double kMiddleburyRotationTolerance = 1e-4;
constexpr const char* kLineForm =
    "NAME k11 k12 k13 k21 k22 k23 k31 k32 k33 r11 r12 r13 r21 r22 r23 r31 r32 r33 t1 t2 t3";

// Removes the first word from `text` and returns it. Returns "" if no word is left.
std::string_view NextWord(std::string_view* text) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  text->remove_prefix(std::min(text->find_first_not_of(kBlanks), text->size()));
  const std::string_view word = text->substr(0, text->find_first_of(kBlanks));
  text->remove_prefix(word.size());
  return word;
}

// Returns a word in the form in which messages show it: at most 80 characters.
std::string ShownWord(std::string_view word) {
  constexpr size_t kLongest = 80;
  return word.size() <= kLongest ? std::string(word)
                                 : std::string(word.substr(0, kLongest)) + "...";
}

// Iterates over the lines of a text that are not blank.
class Lines {
 public:
  Lines(std::string_view text, const fs::path& path) : text_(text), path_(path) {}

  std::optional<std::string_view> Next() {
    while (!text_.empty()) {
      const std::string_view line = text_.substr(0, text_.find('\n'));
      text_.remove_prefix(std::min(line.size() + 1, text_.size()));
      ++number_;
      std::string_view rest = line;
      if (!NextWord(&rest).empty()) return line;
    }
    return std::nullopt;
  }
  // Returns the error "a_par.txt: line 3: MESSAGE", with the number of the current line.
  Error Fault(std::string_view message) const {
    return InputError(fmt::format("{}: line {}: {}", path_.string(), number_, message));
  }

 private:
  std::string_view text_;
  const fs::path& path_;
  size_t number_ = 0;
};

struct Line {
  std::string name;
  Mat3 k, r;
  Vec3 t;
};

Result<Line> ParseLine(std::string_view text, const Lines& lines) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Line line;
  line.name = NextWord(&text);
  if (line.name.find('\0') != std::string::npos)
    return lines.Fault("expected the name of an image, found a NUL character");
  std::array<double, kNumberCount> numbers;
  for (size_t i = 0; i < kNumberCount; ++i) {
    const std::string_view word = NextWord(&text);
    const std::optional<double> number = ParseNumber(word);
    if (!number)
      return lines.Fault(fmt::format(
          "number {} of {} is {}: expected {}", i + 1, kNumberCount,
          word.empty() ? "missing" : fmt::format("\"{}\"", ShownWord(word)), kLineForm));
    numbers[i] = *number;
  }
  const std::string_view surplus = NextWord(&text);
  if (!surplus.empty())
    return lines.Fault(fmt::format("the last number is followed by \"{}\": expected only {}",
                                   ShownWord(surplus), kLineForm));
  line.k = Eigen::Map<const Rows>(numbers.data());
  line.r = Eigen::Map<const Rows>(numbers.data() + 9);
  line.t = Eigen::Map<const Vec3>(numbers.data() + 18);
  return line;
}

// Returns the intrinsics of the matrix K, without the image size. The message of kInput does not
// name the file and the line; the caller adds them.
Result<Intrinsics> IntrinsicsOf(Mat3 k) {
  if (!(std::abs(k(2, 2)) > 1e-9))
    return InputError(fmt::format(
        "k33 is {}, too close to 0: expected 1, or the factor by which all of K was multiplied",
        k(2, 2)));
  k /= k(2, 2);
  if (k(1, 0) != 0 || k(2, 0) != 0 || k(2, 1) != 0)
    return InputError(fmt::format(
        "k21, k31 and k32 are {}, {} and {}: expected 0, because they lie below the diagonal of K",
        k(1, 0), k(2, 0), k(2, 1)));
  const auto is_focal = [](double x) { return x >= 0.001 && x <= 1e7; };
  if (!is_focal(k(0, 0)) || !is_focal(k(1, 1)))
    return InputError(fmt::format(
        "the focal lengths k11 and k22 are {} and {} pixels: expected 0.001 to 1e7 pixels", k(0, 0),
        k(1, 1)));
  if (!(k.cwiseAbs().maxCoeff() <= 1e7))
    return InputError(
        fmt::format("k12, k13 and k23 are {}, {} and {} pixels: expected -1e7 to 1e7 pixels",
                    k(0, 1), k(0, 2), k(1, 2)));
  Intrinsics intrinsics;
  intrinsics.fx_px = k(0, 0);
  intrinsics.fy_px = k(1, 1);
  intrinsics.cx_px = k(0, 2) + 0.5;  // in the file, pixel centres are at whole numbers
  intrinsics.cy_px = k(1, 2) + 0.5;
  intrinsics.skew_px = k(0, 1);
  return intrinsics;
}

Result<size_t> ParseCount(std::optional<std::string_view> line, const Lines& lines) {
  constexpr const char* kExpected = "expected the number of images alone on the first line";
  if (!line) return lines.Fault(fmt::format("the file is empty: {}", kExpected));
  std::string_view rest = *line;
  const std::string_view word = NextWord(&rest);
  const std::optional<double> count = ParseNumber(word);
  if (!count || !NextWord(&rest).empty() || *count != std::floor(*count))
    return lines.Fault(fmt::format("\"{}\": {}", ShownWord(*line), kExpected));
  if (!(*count >= 1 && *count <= kMaxImageCount))
    return lines.Fault(
        fmt::format("the number of images is {}: expected 1 to {}", *count, kMaxImageCount));
  return static_cast<size_t>(*count);
}

// Returns width and height of an image file that may have been moved or renamed since it was
// calibrated.
Result<std::array<int, 2>> SizeWherever(const fs::path& image, const fs::path& folder,
                                        const std::optional<fs::path>& images_folder) {
  LightField one;
  one.folder = folder;
  one.image_names = {image.lexically_relative(folder).string()};
  one.cameras.resize(1);
  LF_RETURN_IF_ERROR(FindImageFiles(images_folder, &one));
  return ImageSizeInHeader(one.ImagePath(LfImageId{0}));
}

}  // namespace

Result<LightField> ParseMiddlebury(std::string_view text, const fs::path& path,
                                   const ImageSizeSource& image_size) {
  Lines lines(text, path);
  const std::optional<std::string_view> first_line = lines.Next();
  LF_ASSIGN_OR_RETURN(const size_t count, ParseCount(first_line, lines));

  LightField light_field;
  light_field.folder = path.parent_path();
  DistinctIntrinsics distinct;
  std::array<int, 2> size = {};
  while (const std::optional<std::string_view> text_line = lines.Next()) {
    if (light_field.size() == count)
      return lines.Fault(
          fmt::format("the file holds more lines of images than the {} that the first line states: "
                      "correct this number, or remove lines",
                      count));
    LF_ASSIGN_OR_RETURN(Line line, ParseLine(*text_line, lines));
    const auto fault = [&](const std::string& message) {
      return lines.Fault(fmt::format("{}: {}", ShownWord(line.name), message));
    };
    Result<Intrinsics> intrinsics = IntrinsicsOf(line.k);
    if (!intrinsics) return fault(intrinsics.error().message);
    const Result<Mat3> rotation = NearestRotation(line.r, kMiddleburyRotationTolerance);
    if (!rotation) return fault("R " + rotation.error().message);
    if (!(line.t.cwiseAbs().maxCoeff() <= kLargest_w))
      return fault(fmt::format("t is ({:g}, {:g}, {:g}): expected numbers within +-{:g}",
                               line.t.x(), line.t.y(), line.t.z(), kLargest_w));
    if (light_field.size() == 0) {
      LF_ASSIGN_OR_RETURN(size, image_size(light_field.folder / line.name));
    }
    intrinsics->width_px = size[0];
    intrinsics->height_px = size[1];
    LfCamera camera;
    camera.intrinsics_index = distinct.IndexOf(*intrinsics);
    camera.cam_from_world = {*rotation, line.t};
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(std::move(line.name));
  }
  if (light_field.size() != count)
    return InputError(
        fmt::format("{}: holds {} lines of images, but its first line states {}: correct this "
                    "number, or copy the file again if it is truncated",
                    path.string(), light_field.size(), count));
  light_field.intrinsics = distinct.Take();
  light_field.encoding.max_radiance = DefaultMaxRadiance(light_field.image_names);
  return light_field;
}

Result<LightField> ReadMiddlebury(const fs::path& path,
                                  const std::optional<fs::path>& images_folder) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kMostFileBytes));
  return ParseMiddlebury(text, path, [&](const fs::path& image) {
    return SizeWherever(image, path.parent_path(), images_folder);
  });
}

bool IsMiddleburyName(std::string_view file_name) { return file_name.ends_with("_par.txt"); }

std::vector<fs::path> MiddleburyFiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (IsMiddleburyName(it->path().filename().string())) files.push_back(it->path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace lf
