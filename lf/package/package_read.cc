#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>

#include "lf/database/seal.h"
#include "lf/package/package_file.h"
#include "lf/package/package_format.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// As the readers of calibrations and paths allow.
constexpr int64_t kMostSide_px = 65536;
constexpr int64_t kMostPixels = int64_t{1} << 30;
constexpr int64_t kMostFrames = 1'000'000;
constexpr int64_t kMostImages = int64_t{1} << 24;
constexpr double kMostNumber = 1e12;

bool IsWithin(double value, double low, double high) { return value >= low && value <= high; }

bool IsRotation(const Mat3& r) {
  return r.allFinite() && (r * r.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-6;
}

bool IsPose(const RigidTransform& pose) {
  return IsRotation(pose.rotation) && pose.translation.allFinite() &&
         pose.translation.cwiseAbs().maxCoeff() <= kMostNumber;
}

bool IsCamera(const Intrinsics& k) {
  return IsWithin(std::abs(k.fx_px), 1e-6, 1e9) && IsWithin(std::abs(k.fy_px), 1e-6, 1e9) &&
         std::abs(k.cx_px) <= 1e9 && std::abs(k.cy_px) <= 1e9 && std::abs(k.skew_px) <= 1e9 &&
         int64_t{k.width_px} * k.height_px <= kMostPixels;
}

bool IsDistortion(const Distortion& distortion) {
  if (distortion.model == DistortionModel::kFov &&
      !(distortion.parameters[0] > 0 && distortion.parameters[0] < kPi))
    return false;
  return std::all_of(distortion.parameters.begin(), distortion.parameters.end(),
                     [](double p) { return std::abs(p) <= 1e6; });
}

bool IsRenderCamera(const RenderCamera& camera) {
  const int blades = camera.aperture.blades;
  return IsCamera(camera.pinhole.intrinsics) && IsPose(camera.pinhole.cam_from_world) &&
         IsWithin(camera.aperture.radius_w, 0, kMostNumber) &&
         (blades == 0 || (blades >= 3 && blades <= 1000)) &&
         std::abs(camera.focus_plane.normal.norm() - 1) < 1e-6 && camera.unit_m > 0;
}

// Numbers of a text, separated by spaces; none if one is none.
std::optional<std::vector<double>> ParseNumbers(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    double number = 0;
    const auto [rest, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
    at = rest;
    if (at != end && *at++ != ' ') return std::nullopt;
  }
  return numbers;
}

class Reader {
 public:
  Reader(Database database, const fs::path& path) : database_(std::move(database)), path_(path) {}

  Result<Package> Read() {
    package_.name = path_.stem().string();
    LF_RETURN_IF_ERROR(ReadSettings());
    LF_RETURN_IF_ERROR(ReadIntrinsics());
    LF_RETURN_IF_ERROR(ReadImages());
    LF_RETURN_IF_ERROR(ReadFrames());
    return std::move(package_);
  }

 private:
  // Calls row(statement) for every row.
  template <class Row>
  Result<void> ForEachRow(const char* sql, const Row& row) {
    LF_ASSIGN_OR_RETURN(Statement select, database_.Prepare(sql));
    while (true) {
      LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
      if (!has_row) return {};
      LF_RETURN_IF_ERROR(row(select));
    }
  }

  Error Damaged(const std::string& what) const {
    return database_.Fault(fmt::format("is a damaged package: {}", what));
  }
  Error WrongSetting(const char* key, const char* expected) const {
    return Damaged(fmt::format("setting {} is '{}', expected {}", key, Setting(key), expected));
  }
  std::string Setting(const char* key) const {
    const auto found = settings_.find(key);
    return found == settings_.end() ? std::string() : found->second;
  }
  Result<std::vector<double>> Numbers(const char* key, size_t count_min, size_t count_max) const {
    auto numbers = ParseNumbers(Setting(key));
    if (!numbers || numbers->size() < count_min || numbers->size() > count_max)
      return WrongSetting(key, "numbers");
    return *std::move(numbers);
  }
  Result<double> Number(const char* key, double low, double high) const {
    LF_ASSIGN_OR_RETURN(const std::vector<double> numbers, Numbers(key, 1, 1));
    if (!IsWithin(numbers[0], low, high)) return WrongSetting(key, "a number in its range");
    return numbers[0];
  }
  // Up to 2^64 - 1.
  Result<uint64_t> Whole(const char* key) const {
    const std::string text = Setting(key);
    uint64_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc{} || rest != end) return WrongSetting(key, "a whole number");
    return number;
  }
  // The index of the word.
  Result<int> Word(const char* key, std::span<const char* const> words) const {
    for (size_t i = 0; i < words.size(); ++i)
      if (Setting(key) == words[i]) return static_cast<int>(i);
    return WrongSetting(key, "another word");
  }

  Result<void> ReadSettings();
  Result<void> ReadNumber();
  Result<void> ReadEncoding();
  Result<void> ReadChoices();
  Result<void> ReadIntrinsics();
  Result<void> ReadImages();
  Result<void> ReadImage(const Statement& row);
  Result<void> ReadFrames();
  fs::path Folder() const;

  Database database_;
  const fs::path& path_;
  std::map<std::string, std::string> settings_;
  Package package_;
};

Result<void> Reader::ReadSettings() {
  LF_RETURN_IF_ERROR(
      ForEachRow("select key, value from settings", [this](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const std::string key, row.Text(0));
        LF_ASSIGN_OR_RETURN(settings_[key], row.Text(1));
        return {};
      }));
  LightField& light_field = package_.light_field;
  light_field.folder = Folder();
  LF_ASSIGN_OR_RETURN(light_field.unit_m, Number("unit_m", 1e-9, 1e9));
  if (!Setting("depth_range").empty()) {
    LF_ASSIGN_OR_RETURN(const std::vector<double> range, Numbers("depth_range", 2, 2));
    light_field.depth_range = DepthRange{range[0], range[1]};
  }
  LF_ASSIGN_OR_RETURN(const uint64_t whole_count, Whole("light_field.images"));
  package_.whole = {whole_count, Setting("light_field.names"), Setting("light_field.calibration")};
  LF_ASSIGN_OR_RETURN(const double end, Number("places", 1, kMostImages));
  package_.places.end = static_cast<uint32_t>(end);
  LF_RETURN_IF_ERROR(ReadNumber());
  LF_ASSIGN_OR_RETURN(package_.path.fps, Number("fps", 1e-3, 1e6));
  LF_ASSIGN_OR_RETURN(package_.path.unit_m, Number("path_unit_m", 1e-9, 1e9));
  LF_RETURN_IF_ERROR(ReadEncoding());
  return ReadChoices();
}

// "3 of 8"
Result<void> Reader::ReadNumber() {
  constexpr std::string_view kOf = " of ";
  const std::string text = Setting("package");
  const size_t of = std::min(text.find(kOf), text.size());
  const auto number = ParseNumbers(text.substr(0, of));
  const auto count = ParseNumbers(text.substr(std::min(text.size(), of + kOf.size())));
  const auto is_count = [](double x) { return IsWithin(x, 1, kMostFrames) && x == std::floor(x); };
  const auto is_one = [&](const auto& list) {
    return list && list->size() == 1 && is_count(list->front());
  };
  if (!is_one(number) || !is_one(count)) return WrongSetting("package", "like 3 of 8");
  package_.number = static_cast<size_t>(number->front());
  package_.count = static_cast<size_t>(count->front());
  return {};
}

Result<void> Reader::ReadEncoding() {
  RadianceEncoding& encoding = package_.light_field.encoding;
  const std::optional<BayerPattern> bayer = BayerPatternOf(Setting("bayer"));
  if (!bayer && !Setting("bayer").empty()) return WrongSetting("bayer", "such as RGGB");
  encoding.bayer = bayer.value_or(BayerPattern::kNone);
  LF_ASSIGN_OR_RETURN(const int transfer, Word("transfer", kTransferNames));
  encoding.transfer = static_cast<Transfer>(transfer);
  const bool has_response = encoding.transfer == Transfer::kResponse;
  LF_ASSIGN_OR_RETURN(encoding.response,
                      Numbers("response", has_response ? 2 : 0, has_response ? 65536 : 0));
  LF_ASSIGN_OR_RETURN(encoding.black_level, Number("black_level", -kMostNumber, kMostNumber));
  if (!Setting("white_level").empty()) {
    LF_ASSIGN_OR_RETURN(encoding.white_level,
                        Number("white_level", encoding.black_level, kMostNumber));
  }
  LF_ASSIGN_OR_RETURN(encoding.max_radiance, Number("max_radiance", 1e-9, kMostNumber));
  LF_ASSIGN_OR_RETURN(encoding.pedestal, Number("pedestal", 0, 65535));
  LF_ASSIGN_OR_RETURN(const std::vector<double> balance, Numbers("white_balance", 3, 3));
  std::copy(balance.begin(), balance.end(), encoding.white_balance.begin());
  LF_ASSIGN_OR_RETURN(const std::vector<double> matrix, Numbers("camera_to_srgb", 9, 9));
  encoding.camera_to_srgb =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix.data());
  return {};
}

Result<void> Reader::ReadChoices() {
  PackageChoices& choices = package_.choices;
  const std::optional<ImageOrder> order = ImageOrderOf(Setting("order"));
  if (!order) return WrongSetting("order", "shuffle, round-robin or area");
  choices.order = *order;
  LF_ASSIGN_OR_RETURN(choices.seed, Whole("seed"));
  if (!Setting("max_images").empty()) {
    LF_ASSIGN_OR_RETURN(choices.max_image_count, Whole("max_images"));
  }
  if (!Setting("max_angle_rad").empty()) {
    LF_ASSIGN_OR_RETURN(choices.max_angle_rad, Number("max_angle_rad", 0, kPi));
  }
  constexpr const char* kAnswers[] = {"no", "yes"};
  LF_ASSIGN_OR_RETURN(const int has_neighbours, Word("lens_neighbours", kAnswers));
  choices.has_neighbours = has_neighbours == 1;
  return {};
}

// Where the LF images were when the package was made; else the same place from here.
fs::path Reader::Folder() const {
  const fs::path folder = Setting("folder");
  std::error_code error;
  if (fs::is_directory(folder, error)) return folder;
  const fs::path from_here =
      (fs::absolute(path_).parent_path() / Setting("folder_from_package")).lexically_normal();
  return fs::is_directory(from_here, error) ? from_here : folder;
}

Result<void> Reader::ReadIntrinsics() {
  return ForEachRow(
      "select width, height, fx, fy, cx, cy, skew, distortion, parameters from intrinsics "
      "order by id",
      [this](const Statement& row) -> Result<void> {
        Intrinsics k;
        LF_ASSIGN_OR_RETURN(const int64_t width, row.Integer(0, 1, kMostSide_px));
        LF_ASSIGN_OR_RETURN(const int64_t height, row.Integer(1, 1, kMostSide_px));
        k.width_px = static_cast<int>(width);
        k.height_px = static_cast<int>(height);
        LF_ASSIGN_OR_RETURN(k.fx_px, row.Real(2));
        LF_ASSIGN_OR_RETURN(k.fy_px, row.Real(3));
        LF_ASSIGN_OR_RETURN(k.cx_px, row.Real(4));
        LF_ASSIGN_OR_RETURN(k.cy_px, row.Real(5));
        LF_ASSIGN_OR_RETURN(k.skew_px, row.Real(6));
        LF_ASSIGN_OR_RETURN(const std::string model, row.Text(7));
        LF_ASSIGN_OR_RETURN(const std::string parameters, row.Text(8));
        const auto* const name = std::find(std::begin(kModelNames), std::end(kModelNames), model);
        const auto numbers = ParseNumbers(parameters);
        if (name == std::end(kModelNames) || !numbers ||
            numbers->size() != k.distortion.parameters.size())
          return Damaged(fmt::format("a lens distortion is {} {}", model, parameters));
        k.distortion.model = static_cast<DistortionModel>(name - std::begin(kModelNames));
        std::copy(numbers->begin(), numbers->end(), k.distortion.parameters.begin());
        if (!IsCamera(k) || !IsDistortion(k.distortion))
          return Damaged("intrinsics that no camera has");
        package_.light_field.intrinsics.push_back(k);
        return {};
      });
}

// In the order of the whole light field, as WritePackage() was given them.
Result<void> Reader::ReadImages() {
  LF_RETURN_IF_ERROR(ForEachRow(
      "select place, id, name, mask, intrinsics, gain, pose, file_bytes, x_begin, y_begin, x_end, "
      "y_end, frames, rays from lf_images order by id",
      [this](const Statement& row) { return ReadImage(row); }));
  LightField& light_field = package_.light_field;
  if (std::all_of(light_field.mask_names.begin(), light_field.mask_names.end(),
                  [](const std::string& name) { return name.empty(); }))
    light_field.mask_names.clear();
  std::vector<uint32_t> places = package_.places.of_images;
  std::sort(places.begin(), places.end());
  if (std::adjacent_find(places.begin(), places.end()) != places.end())
    return Damaged("two LF images have one place");
  return {};
}

Result<void> Reader::ReadImage(const Statement& row) {
  LightField& light_field = package_.light_field;
  LF_ASSIGN_OR_RETURN(const int64_t place, row.Integer(0, 0, package_.places.end - 1));
  LfCamera camera;
  PackageImage image;
  LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(1, 0, kMostImages));
  LF_ASSIGN_OR_RETURN(std::string name, row.Text(2));
  LF_ASSIGN_OR_RETURN(std::string mask, row.Text(3));
  const auto last = static_cast<int64_t>(light_field.intrinsics.size()) - 1;
  LF_ASSIGN_OR_RETURN(const int64_t intrinsics, row.Integer(4, 0, last));
  LF_ASSIGN_OR_RETURN(const double gain, row.Real(5));
  LF_ASSIGN_OR_RETURN(const std::string_view pose, row.Blob(6));
  LF_ASSIGN_OR_RETURN(const int64_t file_bytes, row.Integer(7, 0, INT64_MAX));
  int64_t sides[4];
  for (int i = 0; i < 4; ++i) {
    LF_ASSIGN_OR_RETURN(sides[i], row.Integer(8 + i, 0, kMostSide_px));
  }
  LF_ASSIGN_OR_RETURN(const int64_t frames, row.Integer(12, 0, kMostFrames));
  LF_ASSIGN_OR_RETURN(const int64_t rays, row.Integer(13, 0, INT64_MAX));
  const std::vector<double> numbers = NumbersOf<double>(pose);
  if (numbers.size() != kPoseNumbers)
    return Damaged(fmt::format("the pose of LF image {} has {} bytes", name, pose.size()));
  camera.cam_from_world = PoseOfNumbers(std::span<const double>(numbers).first<kPoseNumbers>());
  if (!IsPose(camera.cam_from_world))
    return Damaged(fmt::format("the pose of LF image {} is none", name));
  if (name.empty() || !IsWithin(gain, 1e-6, 1e6))
    return Damaged(fmt::format("LF image '{}' has the gain {}", name, gain));
  camera.intrinsics_index = static_cast<uint32_t>(intrinsics);
  camera.gain = static_cast<float>(gain);
  image.id = static_cast<uint32_t>(id);
  image.file_bytes = static_cast<uint64_t>(file_bytes);
  image.rect = {static_cast<int>(sides[0]), static_cast<int>(sides[1]), static_cast<int>(sides[2]),
                static_cast<int>(sides[3])};
  image.frame_count = static_cast<uint32_t>(frames);
  image.ray_count = static_cast<uint64_t>(rays);
  light_field.cameras.push_back(camera);
  light_field.image_names.push_back(std::move(name));
  light_field.mask_names.push_back(std::move(mask));
  package_.places.of_images.push_back(static_cast<uint32_t>(place));
  package_.images.push_back(image);
  return {};
}

Result<void> Reader::ReadFrames() {
  CameraPath& film = package_.path;
  LF_RETURN_IF_ERROR(ForEachRow(
      "select frame, camera, is_rendered, lf_images, rays, camera_distance from frames "
      "order by frame",
      [&](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const int64_t number, row.Integer(0, 1, kMostFrames));
        if (number != static_cast<int64_t>(film.frame_count()) + 1)
          return Damaged(fmt::format("frame {} is missing", film.frame_count() + 1));
        LF_ASSIGN_OR_RETURN(const std::string_view bytes, row.Blob(1));
        const std::vector<double> numbers = NumbersOf<double>(bytes);
        if (numbers.size() != kCameraNumbers)
          return Damaged(fmt::format("the camera of frame {} has {} bytes", number, bytes.size()));
        const bool are_finite = std::all_of(numbers.begin(), numbers.end(),
                                            [](double x) { return std::abs(x) <= kMostNumber; }) &&
                                IsWithin(numbers[5], 1, kMostSide_px) &&
                                IsWithin(numbers[6], 1, kMostSide_px);
        const RenderCamera camera =
            are_finite ? CameraOfNumbers(std::span<const double>(numbers).first<kCameraNumbers>())
                       : RenderCamera();
        const Intrinsics& plate = camera.pinhole.intrinsics;
        const bool has_size =
            film.cameras.empty() ||
            (plate.width_px == film.cameras.front().pinhole.intrinsics.width_px &&
             plate.height_px == film.cameras.front().pinhole.intrinsics.height_px);
        if (!are_finite || !IsRenderCamera(camera) || !has_size)
          return Damaged(fmt::format("the camera of frame {} is none", number));
        film.cameras.push_back(camera);
        LF_ASSIGN_OR_RETURN(const int64_t is_rendered, row.Integer(2, 0, 1));
        LF_ASSIGN_OR_RETURN(const int64_t images, row.Integer(3, 0, kMostImages));
        LF_ASSIGN_OR_RETURN(const int64_t rays, row.Integer(4, 0, INT64_MAX));
        LF_ASSIGN_OR_RETURN(const double distance, row.Real(5));
        if (is_rendered == 0) return {};
        PackageFrame frame;
        frame.id = FrameId{static_cast<uint32_t>(number)};
        frame.image_count = static_cast<uint64_t>(images);
        frame.ray_count = static_cast<uint64_t>(rays);
        if (distance >= 0) frame.camera_distance_w = distance;
        package_.frames.push_back(frame);
        return {};
      }));
  if (package_.frames.empty()) return Damaged("it has no frame to render");
  return {};
}

}  // namespace

Result<Package> ReadPackage(const fs::path& path, const ReadPackageOptions& options) {
  LF_ASSIGN_OR_RETURN(Database database, Database::Open(path, kPackageFormat));
  if (options.check_seal) LF_RETURN_IF_ERROR(CheckSeal(path, kPackageFormat.name));
  return Reader(std::move(database), path).Read();
}

Result<std::vector<FrameRect>> ReadFrameRects(const fs::path& path, uint32_t place) {
  LF_ASSIGN_OR_RETURN(Database database, Database::Open(path, kPackageFormat));
  LF_ASSIGN_OR_RETURN(Statement select,
                      database.Prepare("select rectangles from rectangles where place = ?"));
  select.Bind(0, int64_t{place});
  LF_ASSIGN_OR_RETURN(const bool has_row, select.Step());
  std::vector<FrameRect> rects;
  if (!has_row) return rects;
  LF_ASSIGN_OR_RETURN(const std::string_view bytes, select.Blob(0));
  const std::vector<int32_t> numbers = NumbersOf<int32_t>(bytes);
  for (size_t i = 0; i + kRectNumbers <= numbers.size(); i += kRectNumbers)
    rects.push_back({FrameId{static_cast<uint32_t>(numbers[i])},
                     {numbers[i + 1], numbers[i + 2], numbers[i + 3], numbers[i + 4]}});
  return rects;
}

}  // namespace lf
