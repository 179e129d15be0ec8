#include "lf/native/json_syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

namespace lf {
namespace {

using nlohmann::json;

// The characters of a stream, as the parser wants them.
class StreamIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = char;

  explicit StreamIterator(ByteStream* stream = nullptr) : stream_(stream) {}  // null: of the end
  char operator*() const { return stream_->Window().front(); }
  StreamIterator& operator++() {
    stream_->Skip(1);
    return *this;
  }
  // Compared with the end only.
  bool operator==(const StreamIterator&) const { return stream_->Window().empty(); }

 private:
  ByteStream* stream_;
};

}  // namespace

Error IsNotJson(const std::filesystem::path& file, std::string_view what) {
  what.remove_prefix(std::min(what.size(), what.find("] ") + 2));  // the library's name
  return InputError(fmt::format("{}: is not JSON: {}", file.string(), what));
}

Error JsonSyntaxError(ByteStream* stream) {
  std::optional<Error> error;
  try {
    const auto keep_nothing = [](int, json::parse_event_t, const json&) { return false; };
    const json nothing = json::parse(StreamIterator(stream), StreamIterator(), keep_nothing);
  } catch (const json::exception& exception) {
    error = IsNotJson(stream->path(), exception.what());
  }
  if (Result<void> status = stream->Status(); !status) return status.error();
  if (error) return *error;
  return InputError(fmt::format("{}: changed while it was read", stream->path().string()));
}

}  // namespace lf
