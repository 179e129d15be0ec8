// SPDX-License-Identifier: Apache-2.0
#include "lf/film/plate/entry_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/core/version.h"

namespace lf::entry_file {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kKeyCharacters = "abcdefghijklmnopqrstuvwxyz0123456789_.";

// Parses "key: value" lines, each with a line feed. Returns none if a line is not of this form, or
// a key occurs twice or has characters other than kKeyCharacters.
std::optional<PlateEntries> ParseEntries(std::string_view text) {
  PlateEntries entries;
  while (!text.empty()) {
    const size_t line_end = text.find('\n');
    if (line_end == std::string_view::npos) return std::nullopt;
    const std::string_view line = text.substr(0, line_end);
    text.remove_prefix(line_end + 1);
    const size_t key_end = line.find(": ");
    if (key_end == 0 || key_end == std::string_view::npos) return std::nullopt;
    std::string key(line.substr(0, key_end));
    if (key.find_first_not_of(kKeyCharacters) != std::string::npos) return std::nullopt;
    entries.emplace_back(std::move(key), line.substr(key_end + 2));
  }
  std::vector<std::string_view> keys;
  for (const auto& [key, value] : entries) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  if (std::adjacent_find(keys.begin(), keys.end()) != keys.end()) return std::nullopt;
  return entries;
}

std::string TextOf(const PlateEntries& entries) {
  std::string text;
  for (const auto& [key, value] : entries) {
    LF_CHECK(!key.empty() && key.find_first_not_of(kKeyCharacters) == std::string::npos);
    LF_CHECK(std::none_of(value.begin(), value.end(),
                          [](char c) { return static_cast<unsigned char>(c) < 0x20; }));
    text += fmt::format("{}: {}\n", key, value);
  }
  LF_CHECK(text.size() <= PlateReader::kMaxTextBytes);
  return text;
}

}  // namespace

Result<std::unique_ptr<Source>> Source::OfFile(const fs::path& path, const Kind& kind) {
  auto source = std::make_unique<Source>(path.string(), kind);
  // Without O_NONBLOCK, opening a named pipe would wait for its writer.
  source->fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (source->fd_ < 0 || ::fstat(source->fd_, &status) != 0)
    return InputError(fmt::format("{}: cannot be read: {}", source->name_, std::strerror(errno)));
  if (!S_ISREG(status.st_mode))
    return InputError(fmt::format("{}: is a folder or a device, expected a file", source->name_));
  source->left_ = static_cast<uint64_t>(status.st_size);
  return source;
}

std::unique_ptr<Source> Source::OfBytes(std::string_view bytes, const std::string& name,
                                        const Kind& kind) {
  auto source = std::make_unique<Source>(name, kind);
  source->memory_ = bytes;
  source->left_ = bytes.size();
  return source;
}

Source::~Source() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> Source::Read(void* to, size_t size) {
  if (size > left_)
    return InputError(fmt::format("{}: is truncated: at least {} bytes are missing; {}", name_,
                                  size - left_, kind_.if_broken));
  left_ -= size;
  if (size == 0) return {};
  if (fd_ < 0) {
    std::memcpy(to, memory_.data(), size);
    memory_.remove_prefix(size);
    return {};
  }
  for (size_t done = 0; done < size;) {
    const ssize_t n = ::read(fd_, static_cast<char*>(to) + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0)
      return InputError(
          fmt::format("{}: cannot be read: {}", name_,
                      n == 0 ? "the file became shorter while it was read" : std::strerror(errno)));
    done += static_cast<size_t>(n);
  }
  return {};
}

Error Source::Damaged(const std::string& reason) const {
  return InputError(fmt::format("{}: is damaged: {}; {}", name_, reason, kind_.if_broken));
}

Result<Front> ReadFront(Source& source, size_t head_bytes) {
  const Kind& kind = source.kind();
  if (source.left() < head_bytes)
    return InputError(fmt::format("{}: is not a {}: it has {} bytes, expected at least {}",
                                  source.name(), kind.noun, source.left(), head_bytes));
  Front front = {std::string(head_bytes, '\0'), {}};
  LF_RETURN_IF_ERROR(source.Read(front.head.data(), head_bytes));
  HeadBegin begin;
  std::memcpy(&begin, front.head.data(), sizeof(begin));
  if (std::string_view(begin.magic, sizeof(begin.magic)) != kind.magic)
    return InputError(fmt::format("{}: is not a {}: it does not begin with \"{}\"", source.name(),
                                  kind.noun, kind.magic.substr(0, kind.magic.size() - 1)));
  if (begin.version != kind.version &&
      (kind.later_version == 0 || begin.version != kind.later_version))
    return InputError(fmt::format(
        "{}: is a {} of version {}{}, but this program reads version{}: use the program that "
        "wrote it, or render again",
        source.name(), kind.noun, begin.version,
        begin.version < kind.version ? fmt::format(", which {} read", kBuildsOfEarlierFiles) : "",
        kind.later_version == 0 ? fmt::format(" {}", kind.version)
                                : fmt::format("s {} and {}", kind.version, kind.later_version)));
  if (begin.text_bytes > PlateReader::kMaxTextBytes)
    return source.Damaged(fmt::format("its head states {} bytes of text, expected at most {}",
                                      begin.text_bytes, PlateReader::kMaxTextBytes));
  std::string text(begin.text_bytes, '\0');
  LF_RETURN_IF_ERROR(source.Read(text.data(), text.size()));
  uint64_t hash = 0;
  LF_RETURN_IF_ERROR(source.Read(&hash, sizeof(hash)));
  if (hash != HashBytes(front.head + text))
    return source.Damaged("the checksum of its head differs");
  // The checksum is right, so that any fault from here on was in the file when it was written.
  std::optional<PlateEntries> entries = ParseEntries(text);
  if (!entries)
    return InputError(fmt::format(
        "{}: the text in its head has lines that are not \"key: value\", or a key twice; {}",
        source.name(), kind.if_broken));
  front.entries = *std::move(entries);
  return front;
}

std::string FrontOf(const Kind& kind, std::string head, const PlateEntries& entries) {
  const std::string text = TextOf(entries);
  HeadBegin begin = {{}, kind.version, static_cast<uint32_t>(text.size())};
  LF_CHECK(kind.magic.size() == sizeof(begin.magic) && head.size() >= sizeof(begin));
  std::memcpy(begin.magic, kind.magic.data(), sizeof(begin.magic));
  std::memcpy(head.data(), &begin, sizeof(begin));
  std::string front = std::move(head) + text;
  const uint64_t hash = HashBytes(front);
  return front.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
}

OutputFile::OutputFile(const fs::path& path)
    : path_(path), file_(std::fopen(path.c_str(), "wbe"), &std::fclose) {
  if (!file_) error_ = errno;
}

void OutputFile::Write(const void* bytes, size_t size) {
  if (error_ == 0 && size > 0 && std::fwrite(bytes, 1, size, file_.get()) != size) error_ = errno;
}

Result<void> OutputFile::Close() {
  if (error_ == 0 && std::fflush(file_.get()) != 0) error_ = errno;
  if (error_ == 0) return {};
  return OutputError(
      fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(error_)));
}

}  // namespace lf::entry_file
