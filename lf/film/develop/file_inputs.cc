// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/file_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "lf/core/byte_stream.h"
#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/core/log.h"
#include "lf/film/develop/video.h"
#include "lf/pixels/files/picture_header.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// A box begins with its size, a big-endian number, and its type. Size 1: the size has 64 bits and
// stands behind the type. Size 0: the box ends with the file. The type "uuid" is followed by 16
// bytes that name the program.
constexpr size_t kHeadBytes = 8, kUuidBytes = 16;
constexpr std::string_view kUuid = "lfrendertools in";
static_assert(kUuid.size() == kUuidBytes);
constexpr uint64_t kMostTextBytes = uint64_t{1} << 20;
// Limit for files of others: a video of these programs has fewer than ten boxes.
constexpr int kMostBoxes = 1000;

uint64_t BigEndian(std::span<const char> bytes) {
  uint64_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

}  // namespace

std::string TextOfInputs(const FileInputs& inputs) {
  std::string text;
  for (const auto& [key, value] : inputs) text += fmt::format("{} {}\n", key, OneLine(value));
  return text;
}

FileInputs InputsOfText(std::string_view text) {
  FileInputs inputs;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const size_t blank = std::min(line.find(' '), line.size());
    inputs.emplace_back(line.substr(0, blank), line.substr(std::min(blank + 1, line.size())));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return inputs;
}

std::optional<FileInputs> ReadInputs(const fs::path& file) {
  std::optional<std::string> text;
  if (IsVideoName(file)) {
    std::error_code error;
    const uint64_t size_bytes = fs::file_size(file, error);
    std::ifstream stream(file, std::ios::binary);
    if (error || !stream) return std::nullopt;
    text = FindInputs(size_bytes, [&stream](uint64_t offset, std::span<char> to) {
      stream.seekg(static_cast<std::streamoff>(offset));
      return static_cast<bool>(stream.read(to.data(), static_cast<std::streamsize>(to.size())));
    });
  } else if (const Result<std::string> stated = ReadStatedText(file, kInputsText); stated) {
    text = *stated;
  }
  if (!text || text->empty()) return std::nullopt;
  return InputsOfText(*text);
}

Error CannotResume(const fs::path& file, std::string_view why) {
  return UsageError(
      fmt::format("{}: exists already, but {}, so that {{resume}} cannot continue; give another "
                  "name, or {{overwrite}} instead of {{resume}}",
                  file.string(), why));
}

Result<void> AppendInputs(const fs::path& video, std::string_view text) {
  LF_CHECK(text.size() <= kMostTextBytes);
  const uint64_t size = kHeadBytes + kUuidBytes + text.size();
  std::string box;
  for (int shift = 24; shift >= 0; shift -= 8) box += static_cast<char>(size >> shift & 0xff);
  box += "uuid";
  box += kUuid;
  box += text;
  std::ofstream stream(video, std::ios::binary | std::ios::app);
  if (stream.write(box.data(), static_cast<std::streamsize>(box.size())).flush()) return {};
  return OutputError(
      fmt::format("{}: cannot be written: {}", video.string(), std::strerror(errno)));
}

std::optional<std::string> FindInputs(uint64_t size_bytes,
                                      const std::function<bool(uint64_t, std::span<char>)>& read) {
  uint64_t offset = 0;
  for (int count = 0; count < kMostBoxes && size_bytes - offset >= kHeadBytes; ++count) {
    std::array<char, 2 * kHeadBytes> head{};
    if (!read(offset, std::span(head).first(kHeadBytes))) return std::nullopt;
    uint64_t box_bytes = BigEndian(std::span(head).first(4));
    const std::string_view type(head.data() + 4, 4);
    if (box_bytes == 1) {
      if (size_bytes - offset < head.size() || !read(offset, head)) return std::nullopt;
      box_bytes = BigEndian(std::span(head).last(kHeadBytes));
    }
    if (box_bytes < kHeadBytes || box_bytes > size_bytes - offset) return std::nullopt;
    constexpr uint64_t kBefore = kHeadBytes + kUuidBytes;
    if (type == "uuid" && box_bytes >= kBefore && box_bytes - kBefore <= kMostTextBytes) {
      std::string content(box_bytes - kHeadBytes, '\0');
      if (!read(offset + kHeadBytes, content)) return std::nullopt;
      if (content.starts_with(kUuid)) return content.substr(kUuidBytes);
    }
    offset += box_bytes;
  }
  return std::nullopt;
}

Result<std::string> HashOfFiles(std::span<const fs::path> files, ThreadPool& pool,
                                const std::function<bool()>& is_interrupted) {
  std::vector<uint64_t> hashes(files.size());
  std::vector<std::optional<Error>> errors(files.size());
  pool.ForEach(files.size(), [&](size_t i) {
    Result<ByteStream> stream = ByteStream::Open(files[i]);
    if (!stream) {
      errors[i] = stream.error();
      return;
    }
    Hasher hasher;
    while (!(is_interrupted && is_interrupted())) {
      const std::string_view block = stream->Window();
      if (block.empty()) break;
      hasher.Add(block);
      stream->Skip(block.size());
    }
    if (const Result<void> status = stream->Status(); !status) errors[i] = status.error();
    hashes[i] = hasher.Hash();
  });
  if (is_interrupted && is_interrupted()) return Error{ErrorKind::kInterrupted, "interrupted"};
  for (const std::optional<Error>& error : errors)
    if (error) return *error;
  Hasher all;
  for (const uint64_t hash : hashes) all.Add({reinterpret_cast<const char*>(&hash), sizeof hash});
  return fmt::format("{:016x}", all.Hash());
}

}  // namespace lf
