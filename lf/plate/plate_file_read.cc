#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "lf/core/check.h"
#include "lf/core/hash.h"
#include "lf/plate/plate_file.h"
#include "lf/plate/plate_format.h"

namespace lf {
namespace fs = std::filesystem;

using namespace plate_format;

// The bytes of a file, or of memory, from front to back.
class PlateReader::Source {
 public:
  static Result<std::unique_ptr<Source>> OfFile(const fs::path& path) {
    auto source = std::make_unique<Source>(path.string());
    // Not blocking: a named pipe would wait for its writer.
    source->fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat status {};
    if (source->fd_ < 0 || ::fstat(source->fd_, &status) != 0)
      return InputError(fmt::format("{}: cannot be read: {}", source->name_, std::strerror(errno)));
    if (!S_ISREG(status.st_mode))
      return InputError(fmt::format("{}: is not a file", source->name_));
    source->left_ = static_cast<uint64_t>(status.st_size);
    return source;
  }
  static std::unique_ptr<Source> OfBytes(std::string_view bytes, const std::string& name) {
    auto source = std::make_unique<Source>(name);
    source->memory_ = bytes;
    source->left_ = bytes.size();
    return source;
  }

  explicit Source(std::string name) : name_(std::move(name)) {}
  ~Source() {
    if (fd_ >= 0) ::close(fd_);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  const std::string& name() const { return name_; }
  uint64_t left() const { return left_; }

  Result<void> Read(void* to, size_t size) {
    if (size > left_)
      return InputError(
          fmt::format("{}: is truncated: {} bytes are missing at least; the plate cannot be used",
                      name_, size - left_));
    left_ -= size;
    if (fd_ < 0) {
      std::memcpy(to, memory_.data(), size);
      memory_.remove_prefix(size);
      return {};
    }
    for (size_t done = 0; done < size;) {
      const ssize_t n = ::read(fd_, static_cast<char*>(to) + done, size - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0)
        return InputError(fmt::format("{}: cannot be read: {}", name_,
                                      n == 0 ? "became shorter" : std::strerror(errno)));
      done += static_cast<size_t>(n);
    }
    return {};
  }

 private:
  std::string name_;
  int fd_ = -1;
  std::string_view memory_;
  uint64_t left_ = 0;
};

PlateReader::PlateReader(std::unique_ptr<Source> source) : source_(std::move(source)) {}
PlateReader::PlateReader(PlateReader&&) noexcept = default;
PlateReader& PlateReader::operator=(PlateReader&&) noexcept = default;
PlateReader::~PlateReader() = default;

namespace {

// "key: value" lines; none if they are of another form.
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
    if (key.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.") != std::string::npos)
      return std::nullopt;
    entries.emplace_back(std::move(key), line.substr(key_end + 2));
  }
  std::vector<std::string_view> keys;
  for (const auto& [key, value] : entries) keys.push_back(key);
  std::sort(keys.begin(), keys.end());
  if (std::adjacent_find(keys.begin(), keys.end()) != keys.end()) return std::nullopt;
  return entries;
}

}  // namespace

const std::string* FindEntry(const PlateEntries& entries, std::string_view key) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [key](const auto& entry) { return entry.first == key; });
  return found == entries.end() ? nullptr : &found->second;
}

Result<PlateReader> PlateReader::Open(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(std::unique_ptr<Source> source, Source::OfFile(path));
  PlateReader reader(std::move(source));
  LF_RETURN_IF_ERROR(reader.ReadHead());
  return reader;
}

Result<PlateReader> PlateReader::OpenBytes(std::string_view bytes, const std::string& name) {
  PlateReader reader(Source::OfBytes(bytes, name));
  LF_RETURN_IF_ERROR(reader.ReadHead());
  return reader;
}

Error PlateReader::Damaged(const std::string& reason) const {
  return InputError(
      fmt::format("{}: is damaged: {}; the plate cannot be used", source_->name(), reason));
}

Result<void> PlateReader::ReadHead() {
  Head head;
  if (source_->left() < sizeof(head))
    return InputError(fmt::format("{}: is no plate: {} bytes are less than its head of {}",
                                  source_->name(), source_->left(), sizeof(head)));
  LF_RETURN_IF_ERROR(source_->Read(&head, sizeof(head)));
  if (std::string_view(head.magic, sizeof(head.magic)) != kMagic)
    return InputError(
        fmt::format("{}: is no plate: it does not begin with \"LFPLATE\"", source_->name()));
  if (head.version != kVersion)
    return InputError(fmt::format("{}: is a plate of version {}, this program reads version {}",
                                  source_->name(), head.version, kVersion));
  if (head.text_bytes > kMaxTextBytes)
    return Damaged(fmt::format("{} bytes of text, {} are allowed", head.text_bytes, kMaxTextBytes));
  std::string front(sizeof(head) + head.text_bytes, '\0');
  std::memcpy(front.data(), &head, sizeof(head));
  LF_RETURN_IF_ERROR(source_->Read(front.data() + sizeof(head), head.text_bytes));
  uint64_t hash = 0;
  LF_RETURN_IF_ERROR(source_->Read(&hash, sizeof(hash)));
  if (hash != HashBytes(front)) return Damaged("the checksum of its head differs");

  // From here on it is what somebody wrote on purpose.
  if (head.width < 1 || head.width > kMaxSide || head.height < 1 || head.height > kMaxSide ||
      head.channels != SensorPlate::kChannels)
    return InputError(
        fmt::format("{}: {} x {} elements of {} channels; expected 3 channels and sides up to {}",
                    source_->name(), head.width, head.height, head.channels, kMaxSide));
  const uint64_t most_rows = 1 + kChunkWords / (uint64_t{head.width} * SensorPlate::kChannels);
  if (head.rows_per_chunk < 1 || head.rows_per_chunk > most_rows)
    return InputError(fmt::format("{}: chunks of {} rows; expected 1 to {}", source_->name(),
                                  head.rows_per_chunk, most_rows));
  // Before anybody allocates a plate of this size.
  const uint64_t least = uint64_t{(head.height - 1) / head.rows_per_chunk + 1} * sizeof(ChunkHead);
  if (head.wide_count > source_->left() / sizeof(WideWord) ||
      least + head.wide_count * sizeof(WideWord) > source_->left())
    return InputError(
        fmt::format("{}: is truncated: {} bytes follow its head, {} x {} elements and {} wide "
                    "words need more; the plate cannot be used",
                    source_->name(), source_->left(), head.width, head.height, head.wide_count));
  std::optional<PlateEntries> entries = ParseEntries(std::string_view(front).substr(sizeof(head)));
  if (!entries)
    return InputError(
        fmt::format("{}: its text is not made of lines \"key: value\"", source_->name()));
  entries_ = *std::move(entries);
  width_ = static_cast<int>(head.width);
  height_ = static_cast<int>(head.height);
  rows_per_chunk_ = static_cast<int>(head.rows_per_chunk);
  wide_count_ = head.wide_count;
  return {};
}

Result<void> PlateReader::AddTo(SensorPlate* plate) {
  LF_CHECK(plate->width() == width_ && plate->height() == height_);
  const int chunk_count = (height_ - 1) / rows_per_chunk_ + 1;
  for (int chunk = 0; chunk < chunk_count; ++chunk)
    LF_RETURN_IF_ERROR(AddChunk(static_cast<uint32_t>(chunk), plate));
  LF_RETURN_IF_ERROR(AddWide(plate));
  if (source_->left() != 0) return Damaged(fmt::format("{} bytes follow its end", source_->left()));
  return {};
}

Result<void> PlateReader::AddChunk(uint32_t chunk, SensorPlate* plate) {
  const int y_begin = static_cast<int>(chunk) * rows_per_chunk_;
  const int y_end = std::min(height_, y_begin + rows_per_chunk_);
  const size_t row_words = static_cast<size_t>(width_) * SensorPlate::kChannels;
  std::vector<uint64_t> words(static_cast<size_t>(y_end - y_begin) * row_words);
  const size_t size = words.size() * sizeof(uint64_t);
  ChunkHead head;
  LF_RETURN_IF_ERROR(source_->Read(&head, sizeof(head)));
  if (head.stored_bytes > ZSTD_compressBound(size) || head.reserved != 0)
    return Damaged(fmt::format("rows {}-{}: {} stored bytes, at most {} were expected", y_begin,
                               y_end - 1, head.stored_bytes, ZSTD_compressBound(size)));
  std::string stored(head.stored_bytes, '\0');
  LF_RETURN_IF_ERROR(source_->Read(stored.data(), stored.size()));
  if (HashBytes(stored, chunk) != head.hash)
    return Damaged(fmt::format("the checksum of rows {}-{} differs", y_begin, y_end - 1));
  std::vector<char> planes(size);
  if (ZSTD_decompress(planes.data(), size, stored.data(), stored.size()) != size)
    return Damaged(fmt::format("rows {}-{} cannot be unpacked", y_begin, y_end - 1));
  FromPlanes(planes.data(), words);
  for (size_t i = 0; i < words.size(); ++i) {
    const ElementSum rays = {words[i] & SensorPlate::kSumMask, words[i] >> SensorPlate::kSumBits};
    if (rays.sum > 65535 * rays.count)
      return Damaged(fmt::format("row {}: a sum of {} is more than {} rays can have",
                                 y_begin + static_cast<int>(i / row_words), rays.sum, rays.count));
    if (rays.count == 0) continue;
    const auto x = static_cast<int>(i % row_words / SensorPlate::kChannels);
    plate->Add(x, y_begin + static_cast<int>(i / row_words),
               static_cast<int>(i % SensorPlate::kChannels), rays);
  }
  return {};
}

Result<void> PlateReader::AddWide(SensorPlate* plate) {
  const uint64_t row_words = static_cast<uint64_t>(width_) * SensorPlate::kChannels;
  const uint64_t word_count = row_words * static_cast<uint64_t>(height_);
  Hasher hasher;
  uint64_t next_index = 0;
  for (uint64_t done = 0; done < wide_count_;) {
    std::vector<WideWord> block(std::min<uint64_t>(kWideBlock, wide_count_ - done));
    LF_RETURN_IF_ERROR(source_->Read(block.data(), block.size() * sizeof(WideWord)));
    hasher.Add({reinterpret_cast<const char*>(block.data()), block.size() * sizeof(WideWord)});
    for (const WideWord& word : block) {
      // A count beyond any run keeps sums of such plates from wrapping.
      if (word.index < next_index || word.index >= word_count ||
          word.count <= SensorPlate::kMaxCount || word.count > uint64_t{1} << 44 ||
          word.sum > 65535 * word.count)
        return Damaged(fmt::format("wide word {} (sum {}, count {}) is none", word.index, word.sum,
                                   word.count));
      next_index = word.index + 1;
      plate->Add(static_cast<int>(word.index % row_words / SensorPlate::kChannels),
                 static_cast<int>(word.index / row_words),
                 static_cast<int>(word.index % SensorPlate::kChannels), {word.sum, word.count});
    }
    done += block.size();
  }
  uint64_t hash = 0;
  LF_RETURN_IF_ERROR(source_->Read(&hash, sizeof(hash)));
  if (hash != hasher.Hash()) return Damaged("the checksum of its wide words differs");
  return {};
}

}  // namespace lf
