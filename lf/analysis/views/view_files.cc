// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/views/view_files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <regex>
#include <span>
#include <system_error>
#include <utility>

#include "lf/analysis/views/view_encoding.h"
#include "lf/core/file.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kViewsProgram = "lffocus";  // lf_written_by
constexpr const char* kList = "transforms.json";
// Lists the views while they are written, so that those of an interrupted call are known.
constexpr const char* kUnfinishedList = "transforms.json.unfinished";
constexpr uint32_t kMost8 = 255, kMost16 = 65535;

template <class T>
std::vector<std::byte> BytesOf(const std::vector<T>& values) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
  return {bytes.begin(), bytes.end()};
}

// Returns the values of a view as they are in a file of NumPy.
std::vector<std::byte> BytesOfView(const Image<float>& light, ViewValues values) {
  const auto& from = light.pixels();
  if (values == ViewValues::kLinear) return BytesOf(std::vector<float>(from.begin(), from.end()));
  if (values == ViewValues::kSrgb16) {
    std::vector<uint16_t> numbers;
    for (const float value : from)
      numbers.push_back(static_cast<uint16_t>(DisplayNumber(value, kMost16)));
    return BytesOf(numbers);
  }
  std::vector<uint8_t> numbers;
  for (const float value : from)
    numbers.push_back(static_cast<uint8_t>(DisplayNumber(value, kMost8)));
  return BytesOf(numbers);
}

// Writes light / gain; the gain of linear values is 1. If any pixel is NaN, the file has an alpha
// channel, which is 0 where pixels are NaN and 1 elsewhere.
Result<void> WriteViewImage(const fs::path& path, const Image<float>& light, ViewValues values,
                            double gain) {
  const auto& from = light.pixels();
  const bool has_alpha =
      std::any_of(from.begin(), from.end(), [](float value) { return std::isnan(value); });
  std::vector<std::string> channels = {"R", "G", "B"};
  if (has_alpha) channels.emplace_back("A");
  const bool is_linear = values == ViewValues::kLinear;
  Image<float> shown(light.width(), light.height(), static_cast<int>(channels.size()), 1);
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x) {
      const float* const rgb = &light.at(x, y, 0);
      float* const to = &shown.at(x, y, 0);
      for (int c = 0; c < 3; ++c)
        to[c] = is_linear            ? rgb[c]
                : std::isnan(rgb[c]) ? 0
                                     : static_cast<float>(SrgbFromLinear(rgb[c] / gain));
      if (has_alpha && std::isnan(rgb[0])) to[3] = 0;
    }
  return WriteImage(path, shown.view(), channels,
                    is_linear                      ? PixelType::kFloat
                    : values == ViewValues::kSrgb8 ? PixelType::kUint8
                                                   : PixelType::kUint16);
}

// Counts the pixels of views that show no LF image, and those whose light is clipped.
class PixelCounts {
 public:
  //   most  light above it is clipped
  void Add(const Image<float>& light, double most) {
    for (size_t i = 0; i < light.pixels().size(); i += 3) {
      const auto* const rgb = &light.pixels()[i];
      if (std::isnan(rgb[0])) ++unrecorded_;
      if (std::max({rgb[0], rgb[1], rgb[2]}) > most) ++clipped_;
      ++all_;
    }
  }
  double unrecorded_share() const { return unrecorded_ / all_; }
  double clipped_share() const { return clipped_ / all_; }

 private:
  double unrecorded_ = 0, clipped_ = 0, all_ = 0;
};

// Returns the views as a light field.
//   light  EncodingOfLight() of the LF images
LightField FieldOfViews(const LightField& light_field, const RadianceEncoding& light,
                        const ViewGrid& grid, ViewValues values, double gain) {
  LightField views;
  views.unit_m = light_field.unit_m;
  views.depth_range = light_field.depth_range;
  if (values == ViewValues::kLinear)
    views.encoding = light;
  else
    views.encoding.max_radiance = gain;
  views.encoding.alpha = AlphaMeaning::kMask;
  views.encoding.footprint = light_field.encoding.footprint;
  for (size_t view = 0; view < grid.size(); ++view) {
    const PinholeCamera camera = grid.Camera(view);
    const auto known =
        std::find(views.intrinsics.begin(), views.intrinsics.end(), camera.intrinsics);
    LfCamera made;
    made.cam_from_world = camera.cam_from_world;
    made.intrinsics_index = static_cast<uint32_t>(known - views.intrinsics.begin());
    made.gain = static_cast<float>(gain);
    if (known == views.intrinsics.end()) views.intrinsics.push_back(camera.intrinsics);
    views.cameras.push_back(made);
    views.image_names.push_back(ViewName(grid, view, light_field.unit_m, values));
  }
  return views;
}

// Returns true for names that ViewName() makes.
bool IsViewName(const std::string& name) {
  static const std::regex pattern(R"(out_\d{2,}_\d{2,}_-?\d+\.\d{6}_-?\d+\.\d{6}\.(png|exr))");
  return std::regex_match(name, pattern);
}

// Returns the views in the folder that one of its lists names, if WriteViewFolder() wrote the list
// and nobody changed it since.
std::vector<fs::path> ListedViews(const fs::path& folder, const char* list) {
  std::error_code error;
  if (!fs::exists(folder / list, error)) return {};
  const Result<bool> is_ours = IsAsWritten(folder / list, kViewsProgram);
  if (!is_ours || !*is_ours) return {};
  const Result<LightField> views = ReadTransformsJson(folder / list);
  if (!views) return {};
  std::vector<fs::path> files;
  for (const std::string& name : views->image_names) {
    const fs::path file = folder / fs::path(name).filename();
    if (IsViewName(file.filename().string()) && fs::exists(file, error)) files.push_back(file);
  }
  return files;
}

std::string NumpyHeader(const ViewGrid& grid, ViewValues values) {
  const char* const type = values == ViewValues::kSrgb8    ? "|u1"
                           : values == ViewValues::kSrgb16 ? "<u2"
                                                           : "<f4";
  std::string text =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}, {}, {}, 3), }}", type,
                  grid.rows(), grid.columns(), grid.height_px(), grid.width_px());
  // The values begin at a multiple of 64 bytes.
  constexpr size_t kBefore = 10, kAlignment = 64;
  const size_t length = (kBefore + text.size() + kAlignment) / kAlignment * kAlignment - kBefore;
  text.resize(length - 1, ' ');
  std::string header = "\x93NUMPY";
  header += {'\x01', '\x00', static_cast<char>(length & 0xff), static_cast<char>(length >> 8)};
  return header + text + "\n";
}

// A file whose parts are written in any order.
class PartsFile {
 public:
  explicit PartsFile(const fs::path& path)
      : path_(path), fd_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {}
  ~PartsFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  PartsFile(const PartsFile&) = delete;
  PartsFile& operator=(const PartsFile&) = delete;

  Result<void> Write(std::span<const std::byte> bytes, size_t offset) const {
    while (fd_ >= 0 && !bytes.empty()) {
      const ssize_t n = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) break;
      bytes = bytes.subspan(static_cast<size_t>(n));
      offset += static_cast<size_t>(n);
    }
    if (bytes.empty() && fd_ >= 0) return {};
    return OutputError(
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  }

 private:
  const fs::path path_;
  int fd_;
};

}  // namespace

uint32_t DisplayNumber(float linear, uint32_t most) {
  if (!(linear > 0)) return 0;
  const double shown = std::min(1.0, SrgbFromLinear(linear));
  return static_cast<uint32_t>(std::lround(shown * most));
}

std::string ViewName(const ViewGrid& grid, size_t view, double unit_m, ViewValues values) {
  const Vec2 at_mm = grid.Position_w(view) * unit_m * 1000;
  // A position of 0 has no sign.
  const auto shown = [](double mm) { return std::abs(mm) < 5e-7 ? 0.0 : mm; };
  return fmt::format("out_{:02}_{:02}_{:.6f}_{:.6f}.{}", grid.row_of(view), grid.column_of(view),
                     shown(at_mm.y()), shown(at_mm.x()),
                     values == ViewValues::kLinear ? "exr" : "png");
}

std::vector<fs::path> FilesOfViews(const ViewGrid& grid, const fs::path& folder, double unit_m,
                                   ViewValues values) {
  std::vector<fs::path> files = {folder / kList, folder / kUnfinishedList};
  for (size_t view = 0; view < grid.size(); ++view)
    files.push_back(folder / ViewName(grid, view, unit_m, values));
  return files;
}

std::vector<fs::path> OtherViews(const ViewGrid& grid, const fs::path& folder, double unit_m,
                                 ViewValues values) {
  std::vector<fs::path> kept = FilesOfViews(grid, folder, unit_m, values);
  std::sort(kept.begin(), kept.end());
  std::vector<fs::path> others;
  for (const char* const list : {kList, kUnfinishedList})
    for (const fs::path& file : ListedViews(folder, list))
      if (!std::binary_search(kept.begin(), kept.end(), file) &&
          std::find(others.begin(), others.end(), file) == others.end())
        others.push_back(file);
  return others;
}

Result<WrittenViews> WriteViewFolder(const LightField& light_field, const ViewGrid& grid,
                                     const fs::path& folder, ViewValues values, bool clips,
                                     const MakeAllViews& make) {
  WrittenViews written;
  const RadianceEncoding encoding = EncodingOfLight(light_field.encoding);
  constexpr double kWhite = 1;
  if (values != ViewValues::kLinear && !clips && encoding.max_radiance > kWhite) {
    double brightest = kWhite;
    LF_RETURN_IF_ERROR(make([&](size_t, const Image<float>& light) -> Result<void> {
      for (const float value : light.pixels())
        if (value > brightest) brightest = value;
      return {};
    }));
    // Brighter light than LF images can have comes from interpolation that overshoots.
    written.gain = static_cast<float>(std::min(brightest, encoding.max_radiance));
  }
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  const auto remove = [](const fs::path& file) -> Result<void> {
    std::error_code error;
    fs::remove(file, error);
    if (!error) return {};
    return OutputError(fmt::format("{}: cannot be removed: {}", file.string(), error.message()));
  };
  const LightField views = FieldOfViews(light_field, encoding, grid, values, written.gain);
  // Called when the first view is there: if `make` fails before, the folder stays as it is.
  const auto begin = [&]() -> Result<void> {
    for (const fs::path& file : OtherViews(grid, folder, light_field.unit_m, values))
      LF_RETURN_IF_ERROR(remove(file));
    LF_RETURN_IF_ERROR(WriteTransformsJson(views, folder / kUnfinishedList, kViewsProgram));
    // Until the views are complete, the folder is no light field: an older list would mix old and
    // new views.
    return remove(folder / kList);
  };
  PixelCounts counts;
  bool is_begun = false;
  LF_ASSIGN_OR_RETURN(
      written.views, make([&](size_t view, const Image<float>& light) -> Result<void> {
        if (!is_begun) LF_RETURN_IF_ERROR(begin());
        is_begun = true;
        counts.Add(light, values == ViewValues::kLinear ? encoding.max_radiance : written.gain);
        return WriteViewImage(folder / ViewName(grid, view, light_field.unit_m, values), light,
                              values, written.gain);
      }));
  LF_RETURN_IF_ERROR(WriteTransformsJson(views, folder / kList, kViewsProgram));
  LF_RETURN_IF_ERROR(remove(folder / kUnfinishedList));
  written.unrecorded_share = counts.unrecorded_share();
  written.clipped_share = counts.clipped_share();
  return written;
}

Result<WrittenViews> WriteViewArray(const ViewGrid& grid, const fs::path& file, ViewValues values,
                                    const MakeAllViews& make) {
  WrittenViews views;
  PixelCounts counts;
  const double most = values == ViewValues::kLinear ? INFINITY : 1;
  const Result<void> written =
      WriteAtomically(file, [&](const fs::path& temporary) -> Result<void> {
        const PartsFile parts(temporary);
        const std::string header = NumpyHeader(grid, values);
        LF_RETURN_IF_ERROR(parts.Write(std::as_bytes(std::span(header)), 0));
        LF_ASSIGN_OR_RETURN(views.views, make([&](size_t view, const Image<float>& light) {
                              counts.Add(light, most);
                              const std::vector<std::byte> bytes = BytesOfView(light, values);
                              return parts.Write(bytes, header.size() + view * bytes.size());
                            }));
        return {};
      });
  if (!written) return written.error();
  views.unrecorded_share = counts.unrecorded_share();
  views.clipped_share = counts.clipped_share();
  return views;
}

}  // namespace lf
