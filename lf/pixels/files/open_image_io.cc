#include "lf/pixels/files/open_image_io.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

namespace lf {

void ConfigureOpenImageIo() {
  static const bool done = [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("exr_threads", -1);  // -1: OpenEXR works in the calling thread
    return true;
  }();
  static_cast<void>(done);
}

Result<void> CheckRemarks(const std::string& remarks, const std::string& name) {
  const size_t begin = remarks.find_first_not_of('\n');
  if (begin == std::string::npos) return {};
  return InputError(fmt::format("{}: truncated or damaged: {}", name,
                                remarks.substr(begin, remarks.find('\n', begin) - begin)));
}

const char* PluginName(ImageFormat format) {
  switch (format) {
    case ImageFormat::kPng:
      return "png";
    case ImageFormat::kJpeg:
      return "jpeg";
    case ImageFormat::kTiff:
      return "tiff";
    case ImageFormat::kExr:
      return "openexr";
    case ImageFormat::kRaw:
      break;  // read by LibRaw
  }
  LF_CHECK(false);
}

}  // namespace lf
