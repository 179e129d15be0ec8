// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/files/exr_parts.h"

#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/file.h"

namespace lf {
namespace {

constexpr int kThreadsOfParts = 0;  // OpenEXR starts no threads

// The file that OpenEXR writes. It remembers a failure, because OpenEXR writes the last bytes in a
// destructor, which hides errors.
class FileStream : public Imf::OStream {
 public:
  explicit FileStream(const std::filesystem::path& path)
      : OStream(path.c_str()), file_(std::fopen(path.c_str(), "wb")) {
    if (file_ == nullptr) reason_ = std::strerror(errno);
  }
  FileStream(const FileStream&) = delete;
  FileStream& operator=(const FileStream&) = delete;
  ~FileStream() override {
    if (file_ != nullptr) std::fclose(file_);
  }

  void write(const char from[], int count) override {
    const auto size = static_cast<size_t>(count);
    if (!reason_.empty() || std::fwrite(from, 1, size, file_) != size) Fail();
  }
  uint64_t tellp() override { return static_cast<uint64_t>(::ftello(file_)); }
  void seekp(uint64_t offset) override {
    if (!reason_.empty() || ::fseeko(file_, static_cast<off_t>(offset), SEEK_SET) != 0) Fail();
  }

  // Closes the file. Returns why it could not be written; "" if it is complete.
  std::string Close() {
    if (file_ != nullptr && std::fclose(file_) != 0 && reason_.empty())
      reason_ = std::strerror(errno);
    file_ = nullptr;
    return reason_;
  }
  bool is_open() const { return file_ != nullptr; }

 private:
  void Fail() {
    if (reason_.empty()) reason_ = std::strerror(errno);
    throw std::runtime_error(reason_);
  }

  std::FILE* file_;
  std::string reason_;
};

Error CannotRead(const ExrPart& part, const std::exception& error) {
  return Error{KindOfReadFailure(error),
               fmt::format("{}: cannot be read: {}", part.from.string(), error.what())};
}

Result<Imf::Header> HeaderOfPart(const ExrPart& part) {
  try {
    const Imf::InputFile file(part.from.c_str(), kThreadsOfParts);
    Imf::Header header = file.header();
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    return header;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return CannotRead(part, error);
  }
}

Result<std::vector<Imf::Header>> HeadersOf(std::span<const ExrPart> parts) {
  std::vector<Imf::Header> headers;
  for (const ExrPart& part : parts) {
    LF_ASSIGN_OR_RETURN(const Imf::Header header, HeaderOfPart(part));
    headers.push_back(header);
    if (header.dataWindow() != headers.front().dataWindow())
      return InputError(fmt::format("{}: has another size than {}", part.from.string(),
                                    parts.front().from.string()));
  }
  return headers;
}

// Copies the parts into the stream. OpenEXR's exceptions leave this function.
Result<void> CopyParts(FileStream* stream, std::span<const ExrPart> parts,
                       const std::vector<Imf::Header>& headers,
                       const std::function<bool()>& is_interrupted) {
  Imf::MultiPartOutputFile file(*stream, headers.data(), static_cast<int>(headers.size()), false,
                                kThreadsOfParts);
  for (size_t i = 0; i < parts.size(); ++i) {
    if (is_interrupted && is_interrupted())
      return Error{ErrorKind::kInterrupted, fmt::format("{}: interrupted", stream->fileName())};
    std::optional<Imf::InputFile> input;
    try {
      input.emplace(parts[i].from.c_str(), kThreadsOfParts);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      return CannotRead(parts[i], error);
    }
    Imf::OutputPart(file, static_cast<int>(i)).copyPixels(*input);
  }
  return {};
}

Result<void> WriteParts(const std::filesystem::path& path, std::span<const ExrPart> parts,
                        const std::vector<Imf::Header>& headers,
                        const std::function<bool()>& is_interrupted) {
  const auto cannot = [&path](const std::string& reason) {
    return OutputError(fmt::format("{}: cannot be written: {}", path.string(), reason));
  };
  FileStream stream(path);
  if (!stream.is_open()) return cannot(stream.Close());
  try {
    LF_RETURN_IF_ERROR(CopyParts(&stream, parts, headers, is_interrupted));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return cannot(error.what());
  }
  if (const std::string reason = stream.Close(); !reason.empty()) return cannot(reason);
  return {};
}

}  // namespace

Result<void> JoinExr(const std::filesystem::path& path, std::span<const ExrPart> parts,
                     const std::function<bool()>& is_interrupted,
                     const std::vector<std::pair<std::string, std::string>>& texts) {
  LF_CHECK(!parts.empty());
  LF_ASSIGN_OR_RETURN(std::vector<Imf::Header> headers, HeadersOf(parts));
  for (const auto& [name, text] : texts) headers.front().insert(name, Imf::StringAttribute(text));
  return WriteAtomically(path, [&](const std::filesystem::path& temporary) -> Result<void> {
    return WriteParts(temporary, parts, headers, is_interrupted);
  });
}

Result<std::vector<double>> NumbersOfParts(const std::filesystem::path& path,
                                           const std::string& attribute) {
  std::vector<double> numbers;
  try {
    const Imf::MultiPartInputFile file(path.c_str(), kThreadsOfParts);
    for (int i = 0; i < file.parts(); ++i) {
      const auto* const number = file.header(i).findTypedAttribute<Imf::DoubleAttribute>(attribute);
      if (number == nullptr)
        return InputError(
            fmt::format("{}: part {} has no number \"{}\"", path.string(), i + 1, attribute));
      numbers.push_back(number->value());
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return InputError(fmt::format("{}: cannot be read: {}", path.string(), error.what()));
  }
  return numbers;
}

}  // namespace lf
