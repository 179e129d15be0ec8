#include "lf/imageio/open_raw.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <vector>

#include "lf/imageio/open_image_io.h"

namespace lf {
namespace {

// Numbers that OpenImageIO found in the file, none if they are not `count`.
std::vector<double> Floats(const OIIO::ImageSpec& spec, const char* key, size_t count) {
  const OIIO::ParamValue* found = spec.find_attribute(key);
  if (!found || found->type().basetype != OIIO::TypeDesc::FLOAT ||
      found->type().numelements() != count)
    return {};
  const float* values = static_cast<const float*>(found->data());
  return {values, values + count};
}

// As shot: factors of R, G, B and a second green.
std::optional<std::array<double, 3>> WhiteBalanceOf(const OIIO::ImageSpec& spec) {
  constexpr double kLargest = 1000;
  const std::vector<double> factors = Floats(spec, "raw:cam_mul", 4);
  if (factors.empty()) return std::nullopt;
  const std::array<double, 3> balance = {factors[0] / factors[1], 1, factors[2] / factors[1]};
  for (const double factor : balance)
    if (!(factor > 0 && factor <= kLargest)) return std::nullopt;
  return balance;
}

// Rows of R, G, B and a second green. LibRaw gives the identity where it knows nothing.
std::optional<Mat3> CameraToSrgbOf(const OIIO::ImageSpec& spec) {
  constexpr double kLargest = 1000;
  const std::vector<double> values = Floats(spec, "raw:rgb_cam", 12);
  if (values.empty()) return std::nullopt;
  Mat3 matrix;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) matrix(row, column) = values[4 * row + column];
  if (!(matrix.cwiseAbs().maxCoeff() <= kLargest) || matrix == Mat3::Identity())
    return std::nullopt;
  return matrix;
}

}  // namespace

Result<NamedBytes> NamedBytes::Create(std::string_view bytes) {
  NamedBytes named(::memfd_create("lf_raw", MFD_CLOEXEC));
  const auto failure = [] {
    return OutputError(
        fmt::format("no memory for the bytes of a camera raw file: {}", std::strerror(errno)));
  };
  if (named.file_ < 0) return failure();
  while (!bytes.empty()) {
    const ssize_t written = ::write(named.file_, bytes.data(), bytes.size());
    if (written <= 0) return failure();
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return named;
}

NamedBytes::~NamedBytes() {
  if (file_ >= 0) ::close(file_);
}

std::string NamedBytes::path() const { return fmt::format("/proc/self/fd/{}", file_); }

Result<OpenRaw> OpenRawFile(const std::string& path, const RawMosaic& mosaic,
                            const std::string& name) {
  ConfigureOpenImageIo();
  OpenRaw raw;
  raw.input = OIIO::ImageInput::create(PluginName(ImageFormat::kRaw));
  if (!raw.input)
    return InputError(fmt::format("{}: this OpenImageIO cannot read camera raw files: {}", name,
                                  OIIO::geterror()));
  // Without demosaicking, LibRaw hands over what it unpacked: none of its settings for brightness
  // and colour has a part in it. Turning has.
  OIIO::ImageSpec wishes;
  wishes.attribute("raw:Demosaic", "none");
  wishes.attribute("raw:user_flip", 0);
  if (!raw.input->open(path, raw.spec, wishes)) {
    static_cast<void>(raw.input->geterror());
    return InputError(
        fmt::format("{}: LibRaw cannot read this camera raw file: damaged, smaller than 22 pixels, "
                    "or of a kind that it does not know",
                    name));
  }
  const OIIO::ImageSpec& spec = raw.spec;
  if (spec.nchannels != 1 || spec.format != OIIO::TypeDesc::UINT16)
    return InputError(fmt::format("{}: LibRaw finds {} channels of {}, not a mosaic", name,
                                  spec.nchannels, spec.format.c_str()));
  raw.facts.black_level = mosaic.black_level;
  raw.facts.white_level = mosaic.white_level;
  raw.facts.white_balance = WhiteBalanceOf(spec);
  raw.facts.camera_to_srgb = CameraToSrgbOf(spec);
  // Where LibRaw cuts by tables of its own, the tags do not say where the pattern begins.
  if (spec.width == mosaic.width && spec.height == mosaic.height) raw.facts.bayer = mosaic.bayer;
  return raw;
}

}  // namespace lf
